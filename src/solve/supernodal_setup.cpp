#include <algorithm>
#include <iterator>
#include <numeric>

#include "solve/supernodal_step_solver.hpp"

// Setup of the step solver: distributes the elimination over the ranks, and sends the values of the
// operator to the ranks that factor them.
namespace trocar::solve {
namespace {

// Speed of a present-day core, for comparing the cost of a factorisation with that of sweeps. No
// times are measured, because decisions must not depend on the load of the machine.
constexpr double product_rate = 5e10;  ///< [flop/s]
constexpr double read_rate = 2e10;     ///< [B/s]
constexpr double least_worth = 20.0;   ///< in sweeps: small factors do not reach these rates

template <class T>
MPI_Datatype type_of();
template <>
MPI_Datatype type_of<int>()
{
  return MPI_INT;
}
template <>
MPI_Datatype type_of<double>()
{
  return MPI_DOUBLE;
}

template <class T>
void send(const std::vector<T>& values, int rank, MPI_Comm comm)
{
  TROCAR_MPI(MPI_Send(values.data(), static_cast<int>(values.size()), type_of<T>(), rank, 0, comm));
}

template <class T>
void receive(std::vector<T>& values, int rank, MPI_Comm comm)
{
  MPI_Status status;
  int count = 0;
  TROCAR_MPI(MPI_Probe(rank, 0, comm, &status));
  TROCAR_MPI(MPI_Get_count(&status, type_of<T>(), &count));
  values.resize(static_cast<std::size_t>(count));
  TROCAR_MPI(MPI_Recv(values.data(), count, type_of<T>(), rank, 0, comm, MPI_STATUS_IGNORE));
}

/// The lists of a domain that rank 0 sends to the domain's rank.
std::array<std::vector<int>*, 4> parts_of(Domain& domain)
{
  return {&domain.dof, &domain.pattern.start, &domain.pattern.row, &domain.order};
}

}  // namespace

SupernodalStepSolver::SupernodalStepSolver(const StepSolverParts& parts, int most_shared)
    : space_(&parts.space), fixed_(&parts.fixed), ledger_(&parts.ledger), reuse_(parts.reuse)
{
  WholePattern whole = gather_pattern(parts);
  whole.most_shared = most_shared;
  Dissection dissection;
  base::on_root(space_->comm(), [&] { dissection = dissect(whole); });
  const Domain domain = hand_out(dissection);
  base::on_all(space_->comm(), [&] {
    if (domain.pattern.size() > domain.open)
      factor_.emplace(domain.pattern, domain.order, domain.open);
  });
  weigh(parts.turns);
}

WholePattern SupernodalStepSolver::gather_pattern(const StepSolverParts& parts)
{
  const fem::BlockPattern& pattern = parts.pattern;
  std::vector<int> row, column = pattern.column();
  for (int i = 0; i < space_->owned(); ++i)
    row.insert(row.end(),
               static_cast<std::size_t>(pattern.row_start()[static_cast<std::size_t>(i) + 1] -
                                        pattern.row_start()[static_cast<std::size_t>(i)]),
               space_->first() + i);
  const base::Comm& comm = space_->comm();
  const auto starts_of = [&](int mine, std::vector<int>& count) {
    count.resize(static_cast<std::size_t>(comm.size()));
    TROCAR_MPI(MPI_Allgather(&mine, 1, MPI_INT, count.data(), 1, MPI_INT, comm.get()));
    std::vector<int> start{0};
    std::partial_sum(count.begin(), count.end(), std::back_inserter(start));
    return start;
  };
  WholePattern whole;
  std::vector<int> count;
  whole.first_of_rank = starts_of(space_->owned(), count);
  value_start_ = starts_of(9 * static_cast<int>(row.size()), value_count_);
  const std::vector<int> start = starts_of(static_cast<int>(row.size()), count);
  for (const auto& [mine, all] : {std::pair{&row, &whole.row}, std::pair{&column, &whole.column}}) {
    if (comm.root()) all->resize(static_cast<std::size_t>(start.back()));
    TROCAR_MPI(MPI_Gatherv(mine->data(), static_cast<int>(mine->size()), MPI_INT, all->data(),
                           count.data(), start.data(), MPI_INT, 0, comm.get()));
  }
  for (int node = 0; node < space_->global(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      whole.free.push_back((fixed_->axes_of_number(node) >> axis & 1U) == 0);
  for (int node : parts.ordered_last) whole.ordered_last.push_back(space_->number_of_file(node));
  std::sort(whole.ordered_last.begin(), whole.ordered_last.end());
  return whole;
}

/// Sends every rank its domain, and returns this rank's.
Domain SupernodalStepSolver::hand_out(Dissection& dissection)
{
  const base::Comm& comm = space_->comm();
  Domain domain;
  std::vector<int> open{0}, ordered_last{dissection.ordered_last};
  if (comm.root()) {
    for (int rank = 1; rank < comm.size(); ++rank) {
      Domain& other = dissection.domain[static_cast<std::size_t>(rank)];
      for (std::vector<int>* part : parts_of(other)) send(*part, rank, comm.get());
      send(std::vector<int>{other.open}, rank, comm.get());
    }
    domain = std::move(dissection.domain.front());
    sources_ = std::move(dissection.source);
    interface_entries_ = std::move(dissection.interface_entries);
  } else {
    for (std::vector<int>* part : parts_of(domain)) receive(*part, 0, comm.get());
    receive(open, 0, comm.get());
    domain.open = open.front();
  }
  interface_ = std::move(dissection.interface);
  comm.broadcast(interface_);
  comm.broadcast(ordered_last);
  ordered_last_ = ordered_last.front();
  for (std::size_t k = 0; k < interface_.size(); ++k)
    interface_index_[interface_[k]] = static_cast<int>(k);
  index_.assign(static_cast<std::size_t>(space_->owned_dofs()), -1);
  const auto closed = domain.dof.size() - static_cast<std::size_t>(domain.open);
  for (std::size_t k = 0; k < closed; ++k)
    index_[static_cast<std::size_t>(domain.dof[k] - 3 * space_->first())] = static_cast<int>(k);
  for (std::size_t k = closed; k < domain.dof.size(); ++k)
    open_.push_back(interface_index_.at(domain.dof[k]));
  return domain;
}

/// Estimates the memory of all ranks, and the cost of a factorisation in sweeps. That cost is the
/// largest of all ranks.
void SupernodalStepSolver::weigh(bool turns)
{
  const double n = static_cast<double>(interface_.size());
  double bytes = factor_ ? factor_->bytes() : 0.0;
  double flops = factor_ ? factor_->flops() : 0.0;
  const double open = static_cast<double>(open_.size());
  double memory = factor_ ? factor_->all_bytes() + (turns ? 0.5 * bytes : 0.0) : 0.0;
  memory += 24.0 * open * open;  // open block, its factor, and a copy to send
  if (space_->comm().root()) {
    bytes += 8.0 * n * n;
    flops += n * n * n / 3.0;
    memory += 16.0 * n * n;  // interface block, and the received share of a domain
    if (space_->comm().size() > 1) memory += 8.0 * static_cast<double>(value_start_.back());
    for (const std::vector<long long>& source : sources_)  // sources, and the values to send
      memory += 16.0 * static_cast<double>(source.size());
  }
  const double worth = bytes > 0.0 ? flops / product_rate / (2.0 * bytes / read_rate) : 0.0;
  bytes_ = space_->comm().sum(bytes);
  memory_ = space_->comm().sum(memory);
  sweeps_per_factor_ = space_->comm().max(std::max(least_worth, worth));
}

void SupernodalStepSolver::set_operator(const fem::BlockMatrix& values)
{
  const base::Comm& comm = space_->comm();
  const std::vector<double> all = gather_values(values);
  core::MatX interface = interface_of(all);
  const core::VecX sums = interface.cwiseAbs().rowwise().sum();
  const std::vector<double> entries = entries_for_me(all, sums);
  base::on_all(comm, [&] {
    if (factor_) factor_->factorise(entries);
  });
  if (!interface_.empty()) {
    gather_open_blocks(sums, interface);
    base::on_root(comm, [&] { interface_block_.factorise(std::move(interface)); });
  }
  forget_columns();
  R_.clear();
  ++ledger_->factorisations;
}

/// The values of all ranks' blocks on rank 0; nothing elsewhere.
std::vector<double> SupernodalStepSolver::gather_values(const fem::BlockMatrix& values) const
{
  const base::Comm& comm = space_->comm();
  if (comm.size() == 1) return values.values();
  std::vector<double> all(comm.root() ? static_cast<std::size_t>(value_start_.back()) : 0);
  TROCAR_MPI(MPI_Gatherv(values.values().data(), static_cast<int>(values.values().size()),
                         MPI_DOUBLE, all.data(), value_count_.data(), value_start_.data(),
                         MPI_DOUBLE, 0, comm.get()));
  return all;
}

/// The entries of A between interface dofs, as a dense matrix on rank 0; empty elsewhere.
core::MatX SupernodalStepSolver::interface_of(const std::vector<double>& values) const
{
  if (!space_->comm().root()) return {};
  const auto n = static_cast<Eigen::Index>(interface_.size());
  core::MatX interface = core::MatX::Zero(n, n);
  for (const Dissection::InterfaceEntry& entry : interface_entries_)
    interface(entry.row, entry.column) = interface(entry.column, entry.row) = values[entry.source];
  return interface;
}

/// The values of this rank's domain entries, which rank 0 sends. `sums`: row sums of |A| on the
/// interface, on rank 0.
std::vector<double> SupernodalStepSolver::entries_for_me(const std::vector<double>& values,
                                                         const core::VecX& sums) const
{
  const base::Comm& comm = space_->comm();
  std::vector<double> entries;
  if (!comm.root()) {
    receive(entries, 0, comm.get());
    return entries;
  }
  for (int rank = comm.size() - 1; rank >= 0; --rank) {  // rank 0 comes last and keeps its own
    const std::vector<long long>& source = sources_[static_cast<std::size_t>(rank)];
    entries.resize(source.size());
    for (std::size_t k = 0; k < source.size(); ++k) {
      if (source[k] >= 0)
        entries[k] = values[static_cast<std::size_t>(source[k])];
      else
        entries[k] = source[k] == Source::nothing
                         ? 0.0
                         : sums[static_cast<Eigen::Index>(Source::row_sum(0) - source[k])];
    }
    if (rank > 0) send(entries, rank, comm.get());
  }
  return entries;
}

/// Makes the Schur complement on rank 0: adds the shares of the domains to the interface block, in
/// rank order, and subtracts the `sums` that were put on the diagonals of open dofs.
void SupernodalStepSolver::gather_open_blocks(const core::VecX& sums, core::MatX& interface) const
{
  const base::Comm& comm = space_->comm();
  std::vector<double> mine;
  std::vector<int> places;  // interface dof of every open place, in factor order
  if (factor_ && !open_.empty()) {
    const core::MatX left = factor_->open_block();
    mine.assign(left.data(), left.data() + left.size());
    places.resize(open_.size());
    for (std::size_t k = 0; k < open_.size(); ++k)
      places[static_cast<std::size_t>(factor_->position(factor_->closed() + static_cast<int>(k)) -
                                      factor_->closed())] = open_[k];
  }
  if (!comm.root()) {
    send(places, 0, comm.get());
    send(mine, 0, comm.get());
    return;
  }
  for (int rank = 0; rank < comm.size(); ++rank) {
    if (rank > 0) {
      receive(places, rank, comm.get());
      receive(mine, rank, comm.get());
    }
    const auto n = static_cast<Eigen::Index>(places.size());
    interface(places, places) += Eigen::Map<const core::MatX>(mine.data(), n, n);
    for (int place : places) interface(place, place) -= sums[place];
  }
}

std::string SupernodalStepSolver::describe() const
{
  return "supernodal cholesky (cholmod, factor " +
         std::to_string(static_cast<long long>(bytes_ / 1e6)) + " MB" +
         (ordered_last_ > 0 ? ", " + std::to_string(ordered_last_) + " nodes ordered last" : "") +
         (interface_.empty() ? ")"
                             : ", ranks share " + std::to_string(interface_.size()) + " dofs)");
}

}  // namespace trocar::solve
