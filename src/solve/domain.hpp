#pragma once

#include <vector>

#include "solve/supernodal_factor.hpp"

namespace trocar::solve {

constexpr int most_interface = 6000;   ///< dofs that ranks may share before others solve better
constexpr int last_interface = 30000;  ///< and beyond which they do not fit

/// The blocks of the whole matrix (upper triangle, node numbers), which dofs are free, and who owns
/// the nodes.
struct WholePattern
{
  std::vector<int> row, column;    ///< by block
  std::vector<bool> free;          ///< by dof, 3 node + axis
  std::vector<int> first_of_rank;  ///< first node of every rank, and the number of nodes
  std::vector<int> ordered_last;   ///< nodes to be eliminated last
  int most_shared =
      most_interface;  ///< dofs of the interface beyond which nothing but it is wanted

  int ranks() const { return static_cast<int>(first_of_rank.size()) - 1; }
  int nodes() const { return first_of_rank.back(); }
  int owner(int node) const;
};

/// One rank's part of an elimination: the dofs inside its domain, which no other domain touches,
/// and after them the dofs of the interface that they touch.
struct Domain
{
  std::vector<int> dof;  ///< whole dof by dof of the domain
  int open = 0;          ///< how many of them belong to the interface
  SymmetricPattern pattern;
  std::vector<int> order;  ///< dof of the domain at each place
};

/// Where an entry of a domain's matrix comes from: a place in the blocks' values, or one of these.
struct Source
{
  static constexpr long long nothing = -1;
  /// Row sum of the interface: it keeps an open block positive definite, and is taken off again.
  static long long row_sum(int interface_dof) { return -2 - interface_dof; }
};

/// The elimination of the whole matrix shared out to the ranks. With one rank there is no
/// interface.
struct Dissection
{
  std::vector<Domain> domain;                  ///< by rank
  std::vector<std::vector<long long>> source;  ///< by rank and entry of the domain's pattern
  std::vector<int> interface;                  ///< whole dofs of the interface, ascending
  struct InterfaceEntry
  {
    int row, column;  ///< of the interface
    std::size_t source;
  };
  std::vector<InterfaceEntry> interface_entries;
  int ordered_last = 0;  ///< nodes that were put last
  double flops = 0.0;    ///< of all factors
};

/// Shares the elimination out. The interface holds the nodes with a neighbour of a higher rank.
/// Pinned nodes join it, or with one rank are put last, unless that makes it larger than
/// `most_shared` or costs the factors more than a tenth. When it is larger without them, there are
/// no domains.
Dissection dissect(const WholePattern& whole);

}  // namespace trocar::solve
