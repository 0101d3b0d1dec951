#include "solve/supernodal_step_solver.hpp"

#include "core/stopwatch.hpp"

namespace trocar::solve {
namespace {

// A core of today, to weigh a factorisation against sweeps without a clock: what is decided must
// not depend on what else the machine does.
constexpr double product_rate = 5e10;  ///< [flop/s]
constexpr double read_rate = 2e10;     ///< [B/s]
constexpr double least_worth = 20.0;   ///< in sweeps: small factors run far below the rates

}  // namespace

SupernodalStepSolver::SupernodalStepSolver(const StepSolverParts& parts)
    : space_(&parts.space), fixed_(&parts.fixed), ledger_(&parts.ledger), reuse_(parts.reuse)
{
  number_free_dofs();
  const Blocks blocks = gather_blocks(parts.pattern);
  base::on_root(space_->comm(), [&] {
    analyse(blocks, parts.pinned);
    bytes_ = factor_->bytes();
    sweeps_per_factor_ = std::max(
        least_worth, factor_->flops() / product_rate / (2.0 * factor_->bytes() / read_rate));
  });
  bytes_ = space_->comm().max(bytes_);
  sweeps_per_factor_ = space_->comm().max(sweeps_per_factor_);
}

void SupernodalStepSolver::set_operator(const fem::BlockMatrix& values)
{
  const std::vector<double>& mine = values.values();
  std::vector<double> all;
  const base::Comm& comm = space_->comm();
  if (comm.size() > 1) {
    if (comm.root()) all.resize(static_cast<std::size_t>(value_start_.back()));
    TROCAR_MPI(MPI_Gatherv(mine.data(), static_cast<int>(mine.size()), MPI_DOUBLE, all.data(),
                           value_count_.data(), value_start_.data(), MPI_DOUBLE, 0, comm.get()));
  }
  base::on_root(comm, [&] {
    const std::vector<double>& from = comm.size() > 1 ? all : mine;
    std::vector<double> entries(source_.size());
    for (std::size_t k = 0; k < source_.size(); ++k) entries[k] = from[source_[k]];
    factor_->factorise(entries);
  });
  forget_columns();
  R_.clear();
  ++ledger_->factorisations;
}

bool SupernodalStepSolver::turn(const std::vector<core::Mat3>& R)
{
  R_ = R;
  // Columns of single nodes turn with them; those of wide vectors do not.
  if (!slot_of_wide_.empty()) forget_columns();
  return true;
}

void SupernodalStepSolver::forget_columns()
{
  if (columns_)
    columns_->clear();
  else if (factor_)
    columns_.emplace(*factor_);
  first_slot_of_node_.clear();
  slot_of_wide_.clear();
  slots_ = 0;
}

core::VecX SupernodalStepSolver::gather_free(const OwnedField& field) const
{
  const base::Comm& comm = space_->comm();
  core::VecX all(comm.root() ? 3 * space_->global() : 0);
  OwnedField back = field;
  if (!R_.empty())
    for (int local = 0; local < space_->owned(); ++local)
      back.node(local) = turned(space_->file_node(local)).transpose() * field.node(local);
  TROCAR_MPI(MPI_Gatherv(back.value.data(), static_cast<int>(back.value.size()), MPI_DOUBLE,
                         all.data(), dof_count_.data(), dof_start_.data(), MPI_DOUBLE, 0,
                         comm.get()));
  if (!comm.root()) return {};
  core::VecX y(free_count_);
  for (std::size_t dof = 0; dof < free_.size(); ++dof)
    if (free_[dof] >= 0) y[factor_->position(free_[dof])] = all[static_cast<Eigen::Index>(dof)];
  return y;
}

OwnedField SupernodalStepSolver::scatter_free(const core::VecX& y) const
{
  const base::Comm& comm = space_->comm();
  core::VecX all;
  if (comm.root()) {
    all = core::VecX::Zero(3 * space_->global());
    for (std::size_t dof = 0; dof < free_.size(); ++dof)
      if (free_[dof] >= 0) all[static_cast<Eigen::Index>(dof)] = y[factor_->position(free_[dof])];
  }
  OwnedField field = space_->zero();
  TROCAR_MPI(MPI_Scatterv(all.data(), dof_count_.data(), dof_start_.data(), MPI_DOUBLE,
                          field.value.data(), static_cast<int>(field.value.size()), MPI_DOUBLE, 0,
                          comm.get()));
  if (!R_.empty())
    for (int local = 0; local < space_->owned(); ++local)
      field.node(local) = (turned(space_->file_node(local)) * field.node(local)).eval();
  return field;
}

HalfSolution SupernodalStepSolver::begin(const OwnedField& b)
{
  if (!reuse_) forget_columns();
  HalfSolution half{gather_free(b)};
  if (factor_) R_.empty() ? factor_->forward(half.value) : factor_->forward_single(half.value);
  ++ledger_->half_sweeps;
  return half;
}

/// Slots of the probes; columns that are not there yet are made.
std::vector<int> SupernodalStepSolver::slots_of(const Probes& probes, ComplianceReport& report)
{
  std::vector<int> slots, fresh;
  for (int node : probes.nodes) {
    const auto [entry, is_fresh] = first_slot_of_node_.emplace(node, slots_);
    for (int axis = 0; axis < 3; ++axis) {
      slots.push_back(entry->second + axis);
      const int dof = free_[static_cast<std::size_t>(3 * space_->number_of_file(node) + axis)];
      if (dof >= 0) ++(is_fresh ? report.built : report.reused);
      if (!is_fresh) continue;
      ++slots_;
      fresh.push_back(dof >= 0 && factor_ ? factor_->position(dof) : -1);
    }
  }
  if (columns_ && !fresh.empty()) columns_->add_units(fresh);
  for (const WideProbe* wide : probes.wide) {
    const auto [entry, is_fresh] = slot_of_wide_.emplace(wide->id, slots_);
    slots.push_back(entry->second);
    ++(is_fresh ? report.built : report.reused);
    if (!is_fresh) continue;
    ++slots_;
    const core::VecX vector = gather_free(wide->vector);
    if (columns_) columns_->add_dense(vector);
  }
  return slots;
}

/// The three rows of every probed node turned with it.
void SupernodalStepSolver::turn_rows(const Probes& probes, core::MatX& rows) const
{
  if (R_.empty()) return;
  for (std::size_t k = 0; k < probes.nodes.size(); ++k) {
    auto three = rows.middleRows<3>(3 * static_cast<Eigen::Index>(k));
    three = (turned(probes.nodes[k]) * three).eval();
  }
}

core::VecX SupernodalStepSolver::turned_back(const Probes& probes, const core::VecX& f) const
{
  core::VecX back = f;
  if (R_.empty()) return back;
  for (std::size_t k = 0; k < probes.nodes.size(); ++k) {
    const auto at = 3 * static_cast<Eigen::Index>(k);
    back.segment<3>(at) = turned(probes.nodes[k]).transpose() * f.segment<3>(at);
  }
  return back;
}

core::MatX SupernodalStepSolver::block(const Probes& probes, ComplianceReport& report)
{
  const core::Stopwatch watch;
  report = {};
  report.probes = probes.size();
  const std::vector<int> slots = slots_of(probes, report);
  core::MatX C(probes.size(), probes.size());
  if (columns_) {
    C = columns_->block(slots);
    turn_rows(probes, C);
    C.transposeInPlace();
    turn_rows(probes, C);
  }
  TROCAR_MPI(MPI_Bcast(C.data(), static_cast<int>(C.size()), MPI_DOUBLE, 0, space_->comm().get()));
  ledger_->columns_built += report.built;
  ledger_->columns_reused += report.reused;
  report.seconds = watch.seconds();
  return C;
}

core::VecX SupernodalStepSolver::at(const Probes& probes, const HalfSolution& half)
{
  ComplianceReport report;
  const std::vector<int> slots = slots_of(probes, report);
  ledger_->columns_built += report.built;
  core::VecX read(probes.size());
  if (columns_) {
    core::MatX all = columns_->at(half.value)(slots);
    turn_rows(probes, all);
    read = all;
  }
  TROCAR_MPI(
      MPI_Bcast(read.data(), static_cast<int>(read.size()), MPI_DOUBLE, 0, space_->comm().get()));
  return read;
}

OwnedField SupernodalStepSolver::finish(const HalfSolution& half, const Probes& probes,
                                        const core::VecX& f)
{
  core::VecX y = half.value;
  if (probes.size() > 0) {
    ComplianceReport report;
    const std::vector<int> slots = slots_of(probes, report);
    ledger_->columns_built += report.built;
    if (columns_) {
      core::VecX by_slot = core::VecX::Zero(slots_);
      by_slot(slots) = turned_back(probes, f);
      columns_->push(by_slot, y);
    }
  }
  if (factor_) R_.empty() ? factor_->backward(y) : factor_->backward_single(y);
  ++ledger_->half_sweeps;
  return scatter_free(y);
}

std::string SupernodalStepSolver::describe() const
{
  return "supernodal cholesky (cholmod, factor " +
         std::to_string(static_cast<long long>(bytes_ / 1e6)) + " MB" +
         (pinned_ > 0 ? ", " + std::to_string(pinned_) + " nodes pinned" : "") +
         (space_->comm().size() > 1 ? ", on rank 0)" : ")");
}

}  // namespace trocar::solve
