#include "solve/supernodal_factor.hpp"

#include <cholmod.h>

#include <algorithm>

#include "base/blas.hpp"
#include "core/failure.hpp"

namespace trocar::solve {

/// CHOLMOD's objects. The destructor frees them in the order that CHOLMOD requires.
struct SupernodalFactor::Handles
{
  Handles() { cholmod_start(&common); }
  ~Handles()
  {
    cholmod_free_factor(&L, &common);
    cholmod_free_sparse(&A, &common);
    cholmod_finish(&common);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;

  const int* integers(const void* array) const { return static_cast<const int*>(array); }

  cholmod_common common;
  cholmod_sparse* A = nullptr;
  cholmod_factor* L = nullptr;
};

SupernodalFactor::SupernodalFactor(const SymmetricPattern& pattern, const std::vector<int>& order,
                                   int open)
    : handles_(std::make_unique<Handles>()), closed_(pattern.size() - open)
{
  cholmod_common& common = handles_->common;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  common.postorder = true;
  common.print = 0;
  const auto n = static_cast<std::size_t>(pattern.size());
  handles_->A =
      cholmod_allocate_sparse(n, n, pattern.row.size(), true, true, 1, CHOLMOD_REAL, &common);
  if (!handles_->A) throw core::solver_error("no memory for the tissue matrix");
  std::copy(pattern.start.begin(), pattern.start.end(), static_cast<int*>(handles_->A->p));
  std::copy(pattern.row.begin(), pattern.row.end(), static_cast<int*>(handles_->A->i));
  std::vector<int> given = order;
  handles_->L = cholmod_analyze_p(handles_->A, given.data(), nullptr, 0, &common);
  if (!handles_->L)
    throw core::solver_error(common.status == CHOLMOD_TOO_LARGE
                                 ? "a supernodal factor would have more than 2^31 entries"
                                 : "the analysis of the tissue matrix failed (CHOLMOD status " +
                                       std::to_string(common.status) + ")");
  position_.resize(n);
  const int* permutation = handles_->integers(handles_->L->Perm);
  for (std::size_t k = 0; k < n; ++k)
    position_[static_cast<std::size_t>(permutation[k])] = static_cast<int>(k);
  for (std::size_t k = n - static_cast<std::size_t>(open); k < n; ++k)
    if (position(order[k]) < closed_)
      throw core::Failure(core::ExitCode::internal, "the open places are not the last ones");
  const int* super = handles_->integers(handles_->L->super);
  while (supernodes_ < static_cast<int>(handles_->L->nsuper) && super[supernodes_] < closed_)
    ++supernodes_;
  at_.assign(n, -1);
  for (int s = 0; s < supernodes(); ++s) {
    const Supernode node = supernode(s);
    std::fill_n(at_.begin() + node.first, node.columns, s);
  }
  for (int s = 0; s < supernodes(); ++s) {
    const Supernode node = supernode(s);
    parent_.push_back(node.below() > 0 ? supernode_at(node.row[node.columns]) : -1);
  }
}

SupernodalFactor::~SupernodalFactor() = default;
SupernodalFactor::SupernodalFactor(SupernodalFactor&&) noexcept = default;
SupernodalFactor& SupernodalFactor::operator=(SupernodalFactor&&) noexcept = default;

void SupernodalFactor::factorise(const std::vector<double>& values)
{
  cholmod_common& common = handles_->common;
  single_.clear();
  std::copy(values.begin(), values.end(), static_cast<double*>(handles_->A->x));
  const bool done = cholmod_factorize(handles_->A, handles_->L, &common) != 0;
  if (common.status == CHOLMOD_OUT_OF_MEMORY)
    throw core::solver_error("no memory for the factor of the tissue (" +
                             std::to_string(static_cast<long long>(bytes() / 1e6)) +
                             " MB): use -compliance_provider ksp with an iterative solver");
  if (!done || common.status == CHOLMOD_NOT_POSDEF || handles_->L->minor < handles_->L->n)
    throw core::solver_error(
        "the tissue's operator is not positive definite: a body without supports (-fix), or "
        "elements that are nearly flat");
}

double SupernodalFactor::bytes() const
{
  return 8.0 * static_cast<double>(handles_->L->xsize);
}

double SupernodalFactor::all_bytes() const
{
  const cholmod_factor& L = *handles_->L;
  const double index = sizeof(int);
  const double structure = index * static_cast<double>(L.ssize + 2 * L.n + at_.size() + L.n);
  // Twice the matrix: CHOLMOD makes a lower-triangle copy of the given upper triangle.
  const double matrix = 2.0 * (8.0 + index) * static_cast<double>(handles_->A->nzmax);
  return bytes() + 8.0 * static_cast<double>(L.maxcsize) + matrix + structure;
}

double SupernodalFactor::flops() const
{
  return handles_->common.fl;
}

SupernodalFactor::Supernode SupernodalFactor::supernode(int s) const
{
  // A supernode with closed and open columns is cut where the open columns begin.
  Supernode node = whole_supernode(s);
  node.columns = std::min(node.columns, closed_ - node.first);
  return node;
}

core::MatX SupernodalFactor::open_block() const
{
  core::MatX L = core::MatX::Zero(size() - closed_, size() - closed_);
  for (int s = 0; s < static_cast<int>(handles_->L->nsuper); ++s) {
    const Supernode node = whole_supernode(s);
    for (int j = std::max(0, closed_ - node.first); j < node.columns; ++j)
      for (int i = j; i < node.rows; ++i)
        L(node.row[i] - closed_, node.first + j - closed_) = node.block()(i, j);
  }
  return base::gram(L.transpose());
}

SupernodalFactor::Supernode SupernodalFactor::whole_supernode(int s) const
{
  const cholmod_factor& L = *handles_->L;
  const int* super = handles_->integers(L.super);
  const int* row_start = handles_->integers(L.pi);
  const int* value_start = handles_->integers(L.px);
  const double* values = static_cast<const double*>(L.x);
  return {super[s],
          super[s + 1] - super[s],
          row_start[s + 1] - row_start[s],
          handles_->integers(L.s) + row_start[s],
          values ? values + value_start[s] : nullptr,
          static_cast<std::size_t>(value_start[s])};
}

namespace {

template <class Real>
using Values = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
template <class Real>
using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

template <class Real>
void sweep_forward(const SupernodalFactor& factor, const Real* values, Column<Real>& b)
{
  Column<Real> update;
  for (int s = 0; s < factor.supernodes(); ++s) {
    const SupernodalFactor::Supernode node = factor.supernode(s);
    const Eigen::Map<const Values<Real>> L(values + node.at, node.rows, node.columns);
    auto own = b.segment(node.first, node.columns);
    L.topRows(node.columns).template triangularView<Eigen::Lower>().solveInPlace(own);
    if (node.below() == 0) continue;
    update.noalias() = L.bottomRows(node.below()) * own;
    const int* row = node.row + node.columns;
    for (int i = 0; i < node.below(); ++i) b[row[i]] -= update[i];
  }
}

template <class Real>
void sweep_backward(const SupernodalFactor& factor, const Real* values, Column<Real>& y)
{
  Column<Real> above;
  for (int s = factor.supernodes() - 1; s >= 0; --s) {
    const SupernodalFactor::Supernode node = factor.supernode(s);
    const Eigen::Map<const Values<Real>> L(values + node.at, node.rows, node.columns);
    auto own = y.segment(node.first, node.columns);
    if (node.below() > 0) {
      above.resize(node.below());
      const int* row = node.row + node.columns;
      for (int i = 0; i < node.below(); ++i) above[i] = y[row[i]];
      own.noalias() -= L.bottomRows(node.below()).transpose() * above;
    }
    L.topRows(node.columns).template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
}

}  // namespace

void SupernodalFactor::forward(core::VecX& b) const
{
  sweep_forward(*this, static_cast<const double*>(handles_->L->x), b);
}

void SupernodalFactor::backward(core::VecX& y) const
{
  sweep_backward(*this, static_cast<const double*>(handles_->L->x), y);
}

void SupernodalFactor::copy_single()
{
  if (!single_.empty()) return;
  const auto* values = static_cast<const double*>(handles_->L->x);
  single_.assign(values, values + handles_->L->xsize);
}

void SupernodalFactor::forward_single(core::VecX& b)
{
  copy_single();
  Column<float> single = b.cast<float>();
  sweep_forward(*this, single_.data(), single);
  b = single.cast<double>();
}

void SupernodalFactor::backward_single(core::VecX& y)
{
  copy_single();
  Column<float> single = y.cast<float>();
  sweep_backward(*this, single_.data(), single);
  y = single.cast<double>();
}

}  // namespace trocar::solve
