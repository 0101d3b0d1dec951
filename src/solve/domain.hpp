#pragma once

#include <vector>

#include "solve/supernodal_factor.hpp"

namespace trocar::solve {

/// Largest interface for provider `automatic` [dofs]. For a larger one MUMPS is the better solver.
constexpr int most_interface = 6000;
/// Largest interface for provider `supernodal` [dofs]. The dense block of a larger one does not
/// fit.
constexpr int last_interface = 30000;

/// Pattern of the whole matrix: its blocks (upper triangle, global node numbers), the free dofs and
/// the owners of the nodes. Complete on rank 0 only. Global dof = 3 × global node + axis.
struct WholePattern
{
  std::vector<int> row, column;    ///< node numbers of every block
  std::vector<bool> free;          ///< by global dof; false: prescribed displacement
  std::vector<int> first_of_rank;  ///< first node of every rank, then the number of nodes
  std::vector<int> ordered_last;   ///< nodes to be eliminated last
  /// Largest interface [dofs]. For a larger one `dissect` gives the interface and empty domains.
  int most_shared = most_interface;

  int ranks() const { return static_cast<int>(first_of_rank.size()) - 1; }
  int nodes() const { return first_of_rank.back(); }
  int owner(int node) const;
};

/// One rank's part of the elimination: first the dofs inside the domain, which no other domain
/// touches, then the open dofs, which are the interface dofs that touch the domain.
struct Domain
{
  std::vector<int> dof;  ///< global dof of every dof of the domain
  int open = 0;          ///< number of open dofs, which are the last ones
  SymmetricPattern pattern;
  std::vector<int> order;  ///< dof of the domain at each place of the elimination order
};

/// Source of the value of a domain's matrix entry. A number >= 0 is an index into the values of the
/// whole matrix's blocks. Negative numbers have the meanings below.
struct Source
{
  static constexpr long long nothing = -1;  ///< the value zero
  /// Diagonal entry of an open dof: the sum of |A_ij| over its row of the interface. This entry
  /// keeps the domain's matrix positive definite; it is subtracted after the elimination.
  static long long row_sum(int interface_dof) { return -2 - interface_dof; }
};

/// The elimination of the whole matrix, distributed over the ranks. With one rank there is no
/// interface.
struct Dissection
{
  std::vector<Domain> domain;                  ///< by rank
  std::vector<std::vector<long long>> source;  ///< by rank and entry of the domain's pattern
  std::vector<int> interface;                  ///< global dofs of the interface, ascending
  /// Entry of the matrix between two interface dofs.
  struct InterfaceEntry
  {
    int row, column;     ///< numbers of the interface dofs
    std::size_t source;  ///< index into the values of the whole matrix's blocks
  };
  std::vector<InterfaceEntry> interface_entries;
  int ordered_last = 0;  ///< number of nodes that are ordered last
  double flops = 0.0;    ///< of all factors together; 0: not estimated
};

/// Distributes the elimination. The interface holds all nodes with a neighbour of a higher rank.
/// The nodes `ordered_last` join the interface, or with one rank are eliminated last. They are
/// ignored if they make the interface larger than `most_shared` or add more than 10 % to the flops.
/// If the interface is larger than `most_shared` without them, the domains stay empty.
Dissection dissect(const WholePattern& whole);

}  // namespace trocar::solve
