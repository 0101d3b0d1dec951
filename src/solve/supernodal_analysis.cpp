#include <metis.h>

#include <algorithm>
#include <numeric>

#include "solve/supernodal_step_solver.hpp"

// How the matrix of the free dofs is gathered, ordered and laid out on rank 0.
namespace trocar::solve {
namespace {

constexpr double most_extra_flops = 1.1;  ///< what pinning may cost the factor

using Graph = std::vector<std::vector<int>>;  ///< neighbours of every node

/// One entry of the upper triangle in free dofs, and where its value stands in the blocks.
struct Entry
{
  int column, row;
  std::size_t source;
};

/// The pattern of entries in any order, and their sources in its order.
SymmetricPattern lay_out(std::vector<Entry> entries, int size, std::vector<std::size_t>& source)
{
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.column != b.column ? a.column < b.column : a.row < b.row;
  });
  SymmetricPattern pattern;
  pattern.start.assign(static_cast<std::size_t>(size) + 1, 0);
  for (const Entry& entry : entries) {
    ++pattern.start[static_cast<std::size_t>(entry.column) + 1];
    pattern.row.push_back(entry.row);
    source.push_back(entry.source);
  }
  std::partial_sum(pattern.start.begin(), pattern.start.end(), pattern.start.begin());
  return pattern;
}

/// Nested dissection of a graph given as neighbour lists: the vertex at each place.
std::vector<int> dissection(const Graph& neighbours)
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
  std::vector<Entry> entries;
  Graph neighbours(static_cast<std::size_t>(space_->global()));
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
  const SymmetricPattern pattern = lay_out(std::move(entries), free_count_, source_);
  factor_.emplace(pattern, dof_order(neighbours, {}));
  if (pinned.empty()) return;
  SupernodalFactor with(pattern, dof_order(neighbours, pinned));
  if (with.flops() > most_extra_flops * factor_->flops()) return;
  factor_.emplace(std::move(with));
  pinned_ = static_cast<int>(pinned.size());
}

/// Free dofs in the order of elimination: nested dissection of the graph of the nodes, those pinned
/// taken out of it and put last.
std::vector<int> SupernodalStepSolver::dof_order(const Graph& neighbours,
                                                 const std::vector<int>& pinned) const
{
  std::vector<bool> last(neighbours.size(), false);
  for (int node : pinned) last[static_cast<std::size_t>(space_->number_of_file(node))] = true;
  Graph rest = neighbours;
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

}  // namespace trocar::solve
