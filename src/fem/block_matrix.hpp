#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "fem/dirichlet.hpp"
#include "fem/space.hpp"

namespace trocar::fem {

/// A 3x3 block, column-major: the first eight entries fill one SIMD register, the ninth is extra.
struct SplitBlock
{
  Eigen::Array<double, 8, 1> head;
  double last;

  core::Mat3 matrix() const
  {
    core::Mat3 block;
    block.reshaped().head<8>() = head.matrix();
    block(2, 2) = last;
    return block;
  }
};

/// Number of pairs (a, b), a <= b, of n nodes: the blocks of a symmetric matrix. Pairs are ordered
/// (0, 0), (0, 1), …, (0, n − 1), (1, 1), (1, 2), ….
constexpr std::size_t pair_count(std::size_t n)
{
  return n * (n + 1) / 2;
}
template <std::size_t N>
constexpr std::array<std::array<int, 2>, pair_count(N)> pairs_of()
{
  std::array<std::array<int, 2>, pair_count(N)> pairs{};
  std::size_t p = 0;
  for (std::size_t a = 0; a < N; ++a)
    for (std::size_t b = a; b < N; ++b) pairs[p++] = {static_cast<int>(a), static_cast<int>(b)};
  return pairs;
}
template <int N>
inline constexpr auto block_pairs = pairs_of<static_cast<std::size_t>(N)>();

/// The 3x3 blocks of a symmetric element matrix of N nodes, by pair (a, b). Where the slot of the
/// pair says so (`BlockPattern::slots`), the block is stored transposed, as that of (b, a).
template <int N>
using ElementBlocks = std::array<SplitBlock, pair_count(static_cast<std::size_t>(N))>;

/// Sets of local nodes in which all nodes are coupled, besides the nodes of each tet. Elements that
/// share their dilatation need such sets.
struct Cliques
{
  std::vector<std::size_t> start{0};
  std::vector<int> node;

  std::size_t size() const { return start.size() - 1; }
  std::span<const int> nodes(std::size_t k) const
  {
    return {node.data() + start[k], start[k + 1] - start[k]};
  }
};

/// Sparsity pattern of the operator, and the places of the element blocks in it. The pattern is
/// block CSR of the rows owned here, upper triangle only (column >= row, global node numbers).
/// Every pair of nodes of a local tet or clique has a slot. Built once per mesh.
class BlockPattern
{
 public:
  explicit BlockPattern(const Space& space, const Cliques& cliques = {});

  const std::vector<int>& row_start() const { return row_start_; }  ///< (owned nodes + 1)
  const std::vector<int>& column() const { return column_; }
  /// Local node number of every entry of `column`.
  const std::vector<int>& local_column() const { return local_column_; }
  std::size_t block_count() const { return column_.size(); }

  /// Slots of the pairs of a local tet. A slot is twice the index of the pair's block, plus 1 when
  /// the block is stored transposed; -1 when another rank owns the row.
  std::span<const int> slots(std::size_t local_tet) const
  {
    return {&tet_slots_[pairs_per_tet_ * local_tet], pairs_per_tet_};
  }
  std::span<const int> clique_slots(std::size_t clique) const
  {
    return {clique_slots_.data() + clique_start_[clique],
            clique_start_[clique + 1] - clique_start_[clique]};
  }

 private:
  void find_slots(const Space& space, std::span<const int> nodes, std::vector<int>& slots) const;

  std::vector<int> row_start_, column_, local_column_;
  std::size_t pairs_per_tet_;
  std::vector<int> tet_slots_, clique_slots_;
  std::vector<std::size_t> clique_start_{0};
};

/// Values of a matrix on a BlockPattern. Blocks are column-major, as PETSc's SBAIJ format takes
/// them. Borrows the pattern.
class BlockMatrix
{
 public:
  explicit BlockMatrix(const BlockPattern& pattern)
      : pattern_(&pattern), values_(9 * pattern.block_count(), 0.0)
  {
  }

  void set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }

  /// Adds the blocks of a tet at the slots of its pairs.
  template <std::size_t P>
  void add(std::span<const int> slots, const std::array<SplitBlock, P>& blocks)
  {
    for (std::size_t p = 0; p < P; ++p) {
      if (slots[p] < 0) continue;
      double* target = &values_[9 * static_cast<std::size_t>(slots[p] >> 1)];
      Eigen::Map<Eigen::Array<double, 8, 1>>(target) += blocks[p].head;
      target[8] += blocks[p].last;
    }
  }

  /// Adds scale b bᵀ at the slots of a clique's pairs; b (3 x nodes of the clique) holds a vector
  /// per node.
  void add_rank_one(std::span<const int> slots, const Eigen::Matrix3Xd& b, double scale);

  /// Zeroes the rows and columns of fixed dofs, except for their diagonal entries. So the scale of
  /// the matrix does not depend on the supports.
  void fix(const Space& space, const Dirichlet& fixed);

  /// A x. Collective.
  OwnedField times(const Space& space, const OwnedField& x) const;

  const BlockPattern& pattern() const { return *pattern_; }
  const std::vector<double>& values() const { return values_; }

 private:
  const BlockPattern* pattern_;
  std::vector<double> values_;
};

}  // namespace trocar::fem
