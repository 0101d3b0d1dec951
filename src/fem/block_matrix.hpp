#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "fem/dirichlet.hpp"
#include "fem/space.hpp"

namespace trocar::fem {

/// A 3x3 block, column-major: eight entries for one register, and the last.
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

/// Element matrix as the ten 3x3 blocks (a, b), a <= b, of a symmetric tet matrix, in the order
/// 00 01 02 03 11 12 13 22 23 33; transposed where the slots of the tet say so.
using ElementBlocks = std::array<SplitBlock, 10>;

/// The pairs (a, b) of ElementBlocks.
inline constexpr std::array<std::array<int, 2>, 10> block_pairs{
    {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 1}, {1, 2}, {1, 3}, {2, 2}, {2, 3}, {3, 3}}};

/// Where the element blocks go: upper block CSR of the rows owned here (column >= row, global
/// node numbers), and for every local tet the slots of its ten blocks. Built once per mesh.
class BlockPattern
{
 public:
  explicit BlockPattern(const Space& space);

  const std::vector<int>& row_start() const { return row_start_; }  ///< owned() + 1
  const std::vector<int>& column() const { return column_; }
  /// Local node of every column.
  const std::vector<int>& local_column() const { return local_column_; }
  std::size_t block_count() const { return column_.size(); }

  struct Slots
  {
    std::array<int, 10> at;    ///< index of the block, -1 when its row is owned elsewhere
    std::uint16_t transposed;  ///< bit p: block p is stored transposed
  };
  const Slots& slots(std::size_t local_tet) const { return slots_[local_tet]; }

 private:
  std::vector<int> row_start_, column_, local_column_;
  std::vector<Slots> slots_;
};

/// Values on a BlockPattern. Blocks are column-major, as PETSc's SBAIJ wants them.
class BlockMatrix
{
 public:
  explicit BlockMatrix(const BlockPattern& pattern)
      : pattern_(&pattern), values_(9 * pattern.block_count(), 0.0)
  {
  }

  void set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }

  void add(std::size_t local_tet, const ElementBlocks& blocks)
  {
    const BlockPattern::Slots& slots = pattern_->slots(local_tet);
    for (std::size_t p = 0; p < 10; ++p) {
      if (slots.at[p] < 0) continue;
      double* target = &values_[9 * static_cast<std::size_t>(slots.at[p])];
      Eigen::Map<Eigen::Array<double, 8, 1>>(target) += blocks[p].head;
      target[8] += blocks[p].last;
    }
  }

  /// Zeroes rows and columns of fixed dofs; keeps their diagonal entry, so that the scale of the
  /// matrix does not depend on the supports.
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
