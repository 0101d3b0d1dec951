#include "solve/isolated_compliance.hpp"

#include <algorithm>

#include "core/stopwatch.hpp"

namespace trocar::solve {
namespace {

constexpr std::size_t block_columns = 64;  ///< columns per solve, bounds the work space

}  // namespace

KspCompliance::KspCompliance(LinearSystem& system, const fem::Dirichlet& fixed, ColumnSolver solver,
                             core::Ledger& ledger)
    : system_(&system), fixed_(&fixed), solver_(solver), ledger_(&ledger)
{
}

void KspCompliance::forget()
{
  columns_.clear();
  first_slot_of_node_.clear();
  slot_of_wide_.clear();
  wides_.clear();
  C_.resize(0, 0);
  version_ = system_->version();
}

core::MatX KspCompliance::block(const Probes& probes, ComplianceReport& report)
{
  const core::Stopwatch watch;
  if (version_ != system_->version()) forget();
  std::vector<int> missing;
  const std::vector<int> slots = slots_of(probes, missing);
  for (std::size_t at = 0; at < missing.size(); at += block_columns) {
    const auto begin = missing.begin() + static_cast<std::ptrdiff_t>(at);
    const auto count = std::min(block_columns, missing.size() - at);
    build({begin, begin + static_cast<std::ptrdiff_t>(count)});
  }
  report.probes = probes.size();
  report.built = static_cast<int>(missing.size());
  report.reused = 0;
  for (int slot : slots)
    if (!columns_[static_cast<std::size_t>(slot)].fixed) ++report.reused;
  report.reused -= report.built;
  ledger_->columns_built += report.built;
  ledger_->columns_reused += report.reused;
  core::MatX C = C_(slots, slots);
  report.seconds = watch.seconds();
  return C;
}

std::vector<int> KspCompliance::slots_of(const Probes& probes, std::vector<int>& missing)
{
  std::vector<int> slots;
  const auto add_column = [&](const Column& column) {
    if (!column.fixed) missing.push_back(static_cast<int>(columns_.size()));
    columns_.push_back(column);
  };
  for (int node : probes.nodes) {
    const auto [entry, fresh] =
        first_slot_of_node_.emplace(node, static_cast<int>(columns_.size()));
    for (int axis = 0; axis < 3; ++axis) {
      if (fresh) add_column({node, axis, nullptr, fixed_->fixed(node, axis)});
      slots.push_back(entry->second + axis);
    }
  }
  for (const DistributedFunctional* wide : probes.wide) {
    const auto [entry, fresh] = slot_of_wide_.emplace(wide->id, static_cast<int>(columns_.size()));
    slots.push_back(entry->second);
    if (!fresh && wides_.at(wide->id).version == wide->version) continue;
    OwnedField vector = wide->vector;
    fixed_->clear(vector);
    wides_.insert_or_assign(wide->id, Wide{wide->version, std::move(vector)});
    if (fresh)
      add_column({-1, 0, wide, false});
    else {
      columns_[static_cast<std::size_t>(entry->second)].wide = wide;
      missing.push_back(entry->second);
    }
  }
  const auto size = static_cast<Eigen::Index>(columns_.size());
  C_.conservativeResizeLike(core::MatX::Zero(size, size));
  return slots;
}

core::MatX KspCompliance::right_hand_sides(const std::vector<int>& slots) const
{
  const fem::Space& space = system_->space();
  core::MatX rhs = core::MatX::Zero(space.owned_dofs(), static_cast<Eigen::Index>(slots.size()));
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const Column& column = columns_[static_cast<std::size_t>(slots[k])];
    const auto c = static_cast<Eigen::Index>(k);
    if (column.wide) {
      rhs.col(c) = wides_.at(column.wide->id).vector.value;
    } else {
      const int local = space.owned_local(column.node);
      if (local >= 0) rhs(3 * local + column.axis, c) = 1.0;
    }
  }
  return rhs;
}

core::MatX KspCompliance::read_at_probes(const core::MatX& columns) const
{
  const fem::Space& space = system_->space();
  core::MatX read = core::MatX::Zero(static_cast<Eigen::Index>(columns_.size()), columns.cols());
  for (const auto& [node, slot] : first_slot_of_node_) {
    const int local = space.owned_local(node);
    if (local >= 0) read.middleRows<3>(slot) = columns.middleRows<3>(3 * local);
  }
  for (const auto& [id, slot] : slot_of_wide_)
    read.row(slot) = wides_.at(id).vector.value.transpose() * columns;
  TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, read.data(), static_cast<int>(read.size()), MPI_DOUBLE,
                           MPI_SUM, space.comm().get()));
  return read;
}

void KspCompliance::build(const std::vector<int>& missing)
{
  const core::MatX rhs = right_hand_sides(missing);
  core::MatX solved(rhs.rows(), rhs.cols());
  if (solver_ == ColumnSolver::blocked) {
    solved = system_->solve_block(rhs);
  } else {
    for (Eigen::Index k = 0; k < rhs.cols(); ++k)
      solved.col(k) = system_->solve({rhs.col(k)}).value;
  }
  const core::MatX read = read_at_probes(solved);
  for (std::size_t k = 0; k < missing.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    C_.col(missing[k]) = read.col(c);
    C_.row(missing[k]) = read.col(c).transpose();
  }
  // Rounding leaves the block of the new columns slightly unsymmetric.
  const core::MatX block = C_(missing, missing);
  C_(missing, missing) = 0.5 * (block + block.transpose());
}

}  // namespace trocar::solve
