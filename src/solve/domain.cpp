#include "solve/domain.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/failure.hpp"

namespace trocar::solve {
namespace {

constexpr double most_extra_flops = 1.1;  ///< limit: flops with nodes ordered last / flops without
constexpr int in_interface = -1;

using Graph = std::vector<std::vector<int>>;  ///< neighbours of every node

std::size_t at(int i)
{
  return static_cast<std::size_t>(i);
}

/// Upper-triangle entry of a domain's matrix, in dofs of the domain, and the source of its value.
struct Entry
{
  int column, row;
  long long source;
};

/// Stable counting sort of the entries by their row or column, which is less than `size`.
std::vector<Entry> sorted_by(int Entry::*number, const std::vector<Entry>& entries, int size)
{
  std::vector<std::size_t> place(at(size) + 1, 0);
  for (const Entry& entry : entries) ++place[at(entry.*number) + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<Entry> sorted(entries.size());
  for (const Entry& entry : entries) sorted[place[at(entry.*number)]++] = entry;
  return sorted;
}

/// Sorts the entries into a pattern. `source` gets their sources in the order of the pattern.
SymmetricPattern lay_out(std::vector<Entry> entries, int size, std::vector<long long>& source)
{
  for (auto number : {&Entry::row, &Entry::column}) entries = sorted_by(number, entries, size);
  SymmetricPattern pattern;
  pattern.start.assign(at(size) + 1, 0);
  for (const Entry& entry : entries) {
    ++pattern.start[at(entry.column) + 1];
    pattern.row.push_back(entry.row);
    source.push_back(entry.source);
  }
  std::partial_sum(pattern.start.begin(), pattern.start.end(), pattern.start.begin());
  return pattern;
}

/// Elimination order by METIS's nested dissection: the vertex of the graph at each place.
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

Graph graph_of(const WholePattern& whole)
{
  const auto any_free = [&](int node) {
    return whole.free[at(3 * node)] || whole.free[at(3 * node + 1)] || whole.free[at(3 * node + 2)];
  };
  Graph neighbours(at(whole.nodes()));
  for (std::size_t k = 0; k < whole.row.size(); ++k) {
    const int i = whole.row[k], j = whole.column[k];
    if (i == j || !any_free(i) || !any_free(j)) continue;
    neighbours[at(i)].push_back(j);
    neighbours[at(j)].push_back(i);
  }
  return neighbours;
}

/// For every node the rank in whose domain it lies, or `in_interface`.
std::vector<int> homes(const WholePattern& whole, const Graph& neighbours)
{
  std::vector<int> home(at(whole.nodes()));
  for (int node = 0; node < whole.nodes(); ++node) {
    const int mine = whole.owner(node);
    const bool border = std::any_of(neighbours[at(node)].begin(), neighbours[at(node)].end(),
                                    [&](int other) { return whole.owner(other) > mine; });
    home[at(node)] = border ? in_interface : mine;
  }
  if (whole.ranks() > 1)
    for (int node : whole.ordered_last) home[at(node)] = in_interface;
  return home;
}

/// Makes a dissection: numbers the dofs of domains and interface, and collects matrix entries.
struct Builder
{
  const WholePattern& whole;
  const Graph neighbours;
  Dissection result;
  std::vector<int> home;   ///< by node: rank of its domain, or in_interface
  std::vector<int> index;  ///< by global dof: number in domain or interface, or -1
  std::vector<std::vector<int>> open_index;  ///< by rank, interface dof: domain's dof, or -1
  std::vector<std::vector<Entry>> entries;   ///< by rank: those of its domain

  explicit Builder(const WholePattern& w)
      : whole(w), neighbours(graph_of(w)), index(w.free.size(), -1), entries(at(w.ranks()))
  {
    result.domain.resize(at(whole.ranks()));
    result.source.resize(at(whole.ranks()));
    home = homes(whole, neighbours);
    result.ordered_last = static_cast<int>(whole.ordered_last.size());
    number();
    if (static_cast<int>(result.interface.size()) > whole.most_shared) {
      for (Domain& domain : result.domain) domain = {};
      return;
    }
    collect();
    for (int rank = 0; rank < whole.ranks(); ++rank) finish(rank);
  }

  /// Flops of all factors, to compare dissections with and without nodes ordered last.
  void weigh()
  {
    result.flops = std::pow(static_cast<double>(result.interface.size()), 3) / 3.0;
    for (const Domain& domain : result.domain)
      if (domain.pattern.size() > domain.open)
        result.flops += SupernodalFactor(domain.pattern, domain.order, domain.open).flops();
  }

  int rank_of(int node) const { return home[at(node)]; }

  void number()
  {
    for (int node = 0; node < whole.nodes(); ++node)
      for (int dof = 3 * node; dof < 3 * node + 3; ++dof) {
        if (!whole.free[at(dof)]) continue;
        std::vector<int>& list =
            rank_of(node) == in_interface ? result.interface : result.domain[at(rank_of(node))].dof;
        index[at(dof)] = static_cast<int>(list.size());
        list.push_back(dof);
      }
    open_index.assign(at(whole.ranks()), std::vector<int>(result.interface.size(), -1));
    for (int rank = 0; rank < whole.ranks(); ++rank) open_up(rank);
  }

  /// Appends the interface dofs that a domain touches to the domain, as its open dofs.
  void open_up(int rank)
  {
    Domain& domain = result.domain[at(rank)];
    std::vector<int> touched;
    for (int node = 0; node < whole.nodes(); ++node)
      if (rank_of(node) == rank)
        for (int other : neighbours[at(node)])
          if (rank_of(other) == in_interface) touched.push_back(other);
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (int node : touched)
      for (int dof = 3 * node; dof < 3 * node + 3; ++dof) {
        if (!whole.free[at(dof)]) continue;
        open_index[at(rank)][at(index[at(dof)])] = static_cast<int>(domain.dof.size());
        domain.dof.push_back(dof);
        ++domain.open;
      }
  }

  /// Gives every entry of the blocks to a domain or to the interface.
  void collect()
  {
    for (std::size_t k = 0; k < whole.row.size(); ++k)
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a <= (whole.row[k] == whole.column[k] ? b : 2); ++a)
          add(3 * whole.row[k] + a, 3 * whole.column[k] + b, 9 * k + at(a + 3 * b));
  }

  void add(int r, int c, std::size_t source)
  {
    if (!whole.free[at(r)] || !whole.free[at(c)]) return;
    const int from = rank_of(r / 3), to = rank_of(c / 3);
    if (from == in_interface && to == in_interface) {
      result.interface_entries.push_back({index[at(r)], index[at(c)], source});
      return;
    }
    const int rank = std::max(from, to);
    const auto local = [&](int dof, int owner) {
      return owner == in_interface ? open_index[at(rank)][at(index[at(dof)])] : index[at(dof)];
    };
    const int i = local(r, from), j = local(c, to);
    entries[at(rank)].push_back({std::max(i, j), std::min(i, j), static_cast<long long>(source)});
  }

  void finish(int rank)
  {
    Domain& domain = result.domain[at(rank)];
    const int size = static_cast<int>(domain.dof.size()), closed = size - domain.open;
    for (int j = closed; j < size; ++j) {  // couples all open dofs with each other
      for (int i = closed; i < j; ++i) entries[at(rank)].push_back({j, i, Source::nothing});
      entries[at(rank)].push_back({j, j, Source::row_sum(index[at(domain.dof[at(j)])])});
    }
    if (domain.open > 0) tie_loose_ends(rank, closed);
    domain.pattern = lay_out(std::move(entries[at(rank)]), size, result.source[at(rank)]);
    domain.order = order(rank, whole.ranks() > 1 ? std::vector<int>{} : whole.ordered_last);
  }

  /// A connected part of the domain may touch no open dof. Couples every such part with the first
  /// open dof by a zero entry, so that the open dofs stay last in the elimination tree.
  void tie_loose_ends(int rank, int first_open)
  {
    std::vector<bool> seen(home.size(), false);
    for (int start = 0; start < whole.nodes(); ++start) {
      if (rank_of(start) != rank || seen[at(start)]) continue;
      bool tied = false;
      int free_dof = -1;
      std::vector<int> stack{start};
      seen[at(start)] = true;
      while (!stack.empty()) {
        const int node = stack.back();
        stack.pop_back();
        for (int dof = 3 * node; dof < 3 * node + 3; ++dof)
          if (whole.free[at(dof)]) free_dof = index[at(dof)];
        for (int other : neighbours[at(node)]) {
          tied = tied || rank_of(other) == in_interface;
          if (rank_of(other) != rank || seen[at(other)]) continue;
          seen[at(other)] = true;
          stack.push_back(other);
        }
      }
      if (!tied && free_dof >= 0)
        entries[at(rank)].push_back({first_open, free_dof, Source::nothing});
    }
  }

  /// Elimination order of a domain: nodes by nested dissection, then the nodes in `last`, then the
  /// open dofs. Dissecting nodes is as good as dissecting dofs, with a ninth of the edges.
  std::vector<int> order(int rank, const std::vector<int>& last) const
  {
    const Domain& domain = result.domain[at(rank)];
    std::vector<int> place(home.size(), -1), nodes;  // vertex by node, and node by vertex
    std::vector<bool> is_last(home.size(), false);
    for (int node : last) is_last[at(node)] = true;
    for (int node = 0; node < whole.nodes(); ++node)
      if (rank_of(node) == rank) {
        place[at(node)] = static_cast<int>(nodes.size());
        nodes.push_back(node);
      }
    Graph graph(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
      for (int other : neighbours[at(nodes[k])])
        if (place[at(other)] >= 0 && !is_last[at(other)] && !is_last[at(nodes[k])])
          graph[k].push_back(place[at(other)]);
    std::vector<int> order;
    const auto add_node = [&](int node) {
      for (int dof = 3 * node; dof < 3 * node + 3; ++dof)
        if (whole.free[at(dof)]) order.push_back(index[at(dof)]);
    };
    for (int k : dissection(graph))
      if (!is_last[at(nodes[at(k)])]) add_node(nodes[at(k)]);
    for (int node : last) add_node(node);
    for (int dof = static_cast<int>(order.size()); dof < static_cast<int>(domain.dof.size()); ++dof)
      order.push_back(dof);
    return order;
  }
};

}  // namespace

int WholePattern::owner(int node) const
{
  const auto after = std::upper_bound(first_of_rank.begin(), first_of_rank.end(), node);
  return static_cast<int>(after - first_of_rank.begin()) - 1;
}

Dissection dissect(const WholePattern& whole)
{
  if (whole.ordered_last.empty()) return Builder(whole).result;
  WholePattern without = whole;
  without.ordered_last.clear();
  Builder plain(without), ordered_last(whole);
  plain.weigh();
  ordered_last.weigh();
  const bool worth = ordered_last.result.flops <= most_extra_flops * plain.result.flops;
  const bool fits = static_cast<int>(ordered_last.result.interface.size()) <= whole.most_shared;
  return std::move(worth && fits ? ordered_last.result : plain.result);
}

}  // namespace trocar::solve
