#include "solve/supernodal_step_solver.hpp"

#include <metis.h>

#include <algorithm>
#include <numeric>

#include "core/stopwatch.hpp"

namespace trocar::solve {
namespace {

constexpr double most_extra_flops = 1.1;  ///< what pinning may cost the factor

/// Nested dissection of a graph given as neighbour lists: the vertex at each place.
std::vector<int> dissection(const std::vector<std::vector<int>>& neighbours)
{
  const auto n = neighbours.size();
  std::vector<idx_t> start{0}, edge;
  for (const auto& list : neighbours) {
    edge.insert(edge.end(), list.begin(), list.end());
    start.push_back(static_cast<idx_t>(edge.size()));
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  if (edge.empty()) return order;
  auto count = static_cast<idx_t>(n);
  std::vector<idx_t> permutation(n), inverse(n);
  const int status = METIS_NodeND(&count, start.data(), edge.data(), nullptr, nullptr,
                                  permutation.data(), inverse.data());
  if (status != METIS_OK)
    throw core::Failure(core::ExitCode::internal,
                        "METIS could not order the matrix (" + std::to_string(status) + ")");
  return {permutation.begin(), permutation.end()};
}

}  // namespace

SupernodalStepSolver::SupernodalStepSolver(const StepSolverParts& parts)
    : space_(&parts.space), fixed_(&parts.fixed), ledger_(&parts.ledger), reuse_(parts.reuse)
{
  number_free_dofs();
  const Blocks blocks = gather_blocks(parts.pattern);
  base::on_root(space_->comm(), [&] {
    analyse(blocks, parts.pinned);
    bytes_ = factor_->bytes();
  });
  bytes_ = space_->comm().max(bytes_);
}

void SupernodalStepSolver::number_free_dofs()
{
  const auto dofs = static_cast<std::size_t>(3 * space_->global());
  free_.assign(dofs, -1);
  // File order, so that the factor does not depend on the number of ranks.
  for (int node = 0; node < space_->global(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (!fixed_->fixed(node, axis))
        free_[static_cast<std::size_t>(3 * space_->number_of_file(node) + axis)] = free_count_++;
}

SupernodalStepSolver::Blocks SupernodalStepSolver::gather_blocks(const fem::BlockPattern& pattern)
{
  std::vector<int> row, column = pattern.column();
  for (int i = 0; i < space_->owned(); ++i)
    row.insert(row.end(),
               static_cast<std::size_t>(pattern.row_start()[static_cast<std::size_t>(i) + 1] -
                                        pattern.row_start()[static_cast<std::size_t>(i)]),
               space_->first() + i);
  const base::Comm& comm = space_->comm();
  const auto counts_of = [&](int mine, std::vector<int>& count, std::vector<int>& start) {
    count.resize(static_cast<std::size_t>(comm.size()));
    TROCAR_MPI(MPI_Allgather(&mine, 1, MPI_INT, count.data(), 1, MPI_INT, comm.get()));
    start.assign(1, 0);
    std::partial_sum(count.begin(), count.end(), std::back_inserter(start));
  };
  std::vector<int> block_count, block_start;
  counts_of(static_cast<int>(row.size()), block_count, block_start);
  counts_of(9 * static_cast<int>(row.size()), value_count_, value_start_);
  counts_of(space_->owned_dofs(), dof_count_, dof_start_);
  Blocks all;
  const auto total = comm.root() ? static_cast<std::size_t>(block_start.back()) : 0;
  all.row.resize(total);
  all.column.resize(total);
  for (const auto& [mine, whole] : {std::pair{&row, &all.row}, std::pair{&column, &all.column}})
    TROCAR_MPI(MPI_Gatherv(mine->data(), static_cast<int>(mine->size()), MPI_INT, whole->data(),
                           block_count.data(), block_start.data(), MPI_INT, 0, comm.get()));
  return all;
}

/// Orders the graph of the nodes, which has nine times fewer edges than that of the dofs and gives
/// the same fill, and lays the free entries of the blocks out by columns.
void SupernodalStepSolver::analyse(const Blocks& blocks, const std::vector<int>& pinned)
{
  struct Entry
  {
    int column, row;
    std::size_t source;
  };
  std::vector<Entry> entries;
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(space_->global()));
  const auto dof = [&](int node, int axis) {
    return free_[static_cast<std::size_t>(3 * node + axis)];
  };
  for (std::size_t k = 0; k < blocks.row.size(); ++k) {
    const int i = blocks.row[k], j = blocks.column[k];
    bool couples = false;
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a <= (i == j ? b : 2); ++a) {
        const int r = dof(i, a), c = dof(j, b);
        if (r < 0 || c < 0) continue;
        couples = true;
        entries.push_back(
            {std::max(r, c), std::min(r, c), 9 * k + static_cast<std::size_t>(a + 3 * b)});
      }
    if (couples && i != j) {
      neighbours[static_cast<std::size_t>(i)].push_back(j);
      neighbours[static_cast<std::size_t>(j)].push_back(i);
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.column != b.column ? a.column < b.column : a.row < b.row;
  });
  SymmetricPattern pattern;
  pattern.start.assign(static_cast<std::size_t>(free_count_) + 1, 0);
  for (const Entry& entry : entries) {
    ++pattern.start[static_cast<std::size_t>(entry.column) + 1];
    pattern.row.push_back(entry.row);
    source_.push_back(entry.source);
  }
  std::partial_sum(pattern.start.begin(), pattern.start.end(), pattern.start.begin());
  factor_.emplace(pattern, dof_order(neighbours, {}));
  if (pinned.empty()) return;
  SupernodalFactor with(std::move(pattern), dof_order(neighbours, pinned));
  if (with.flops() > most_extra_flops * factor_->flops()) return;
  factor_.emplace(std::move(with));
  pinned_ = static_cast<int>(pinned.size());
}

/// Free dofs in the order of elimination: nested dissection of the graph of the nodes, those pinned
/// taken out of it and put last.
std::vector<int> SupernodalStepSolver::dof_order(const std::vector<std::vector<int>>& neighbours,
                                                 const std::vector<int>& pinned) const
{
  std::vector<bool> last(neighbours.size(), false);
  for (int node : pinned) last[static_cast<std::size_t>(space_->number_of_file(node))] = true;
  std::vector<std::vector<int>> rest = neighbours;
  for (std::size_t i = 0; i < rest.size(); ++i)
    std::erase_if(rest[i], [&](int j) { return last[i] || last[static_cast<std::size_t>(j)]; });
  std::vector<int> order;
  const auto add = [&](int node) {
    for (int axis = 0; axis < 3; ++axis) {
      const int dof = free_[static_cast<std::size_t>(3 * node + axis)];
      if (dof >= 0) order.push_back(dof);
    }
  };
  for (int node : dissection(rest))
    if (!last[static_cast<std::size_t>(node)]) add(node);
  for (int node : pinned) add(space_->number_of_file(node));
  return order;
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
  ++ledger_->factorisations;
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
  TROCAR_MPI(MPI_Gatherv(field.value.data(), static_cast<int>(field.value.size()), MPI_DOUBLE,
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
  return field;
}

HalfSolution SupernodalStepSolver::begin(const OwnedField& b)
{
  if (!reuse_) forget_columns();
  HalfSolution half{gather_free(b)};
  if (space_->comm().root()) factor_->forward(half.value);
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

core::MatX SupernodalStepSolver::block(const Probes& probes, ComplianceReport& report)
{
  const core::Stopwatch watch;
  report = {};
  report.probes = probes.size();
  const std::vector<int> slots = slots_of(probes, report);
  core::MatX C(probes.size(), probes.size());
  if (columns_) C = columns_->block(slots);
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
  if (columns_) read = columns_->at(half.value)(slots);
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
      by_slot(slots) = f;
      columns_->push(by_slot, y);
    }
  }
  if (factor_) factor_->backward(y);
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
