#pragma once

#include <vector>

#include "base/blas.hpp"
#include "solve/supernodal_factor.hpp"

namespace trocar::solve {

/// X = L⁻¹ Sᵀ by supernode, only where it is not zero, and C = Xᵀ X = S A⁻¹ Sᵀ. A unit column is
/// not zero on the path from its place to the root of the elimination tree alone, so that a new one
/// costs that path, and C needs no backward sweep. Slots are numbered as they are added. Serial.
class ReachColumns
{
 public:
  explicit ReachColumns(const SupernodalFactor& factor);

  /// Forgets everything: the factor is another one.
  void clear();

  /// Adds unit vectors at these closed positions; -1 makes a column of zeros. Their slots follow
  /// on. Gives what they leave at the open places (open x positions).
  core::MatX add_units(const std::vector<int>& positions);

  /// C of these slots.
  core::MatX block(const std::vector<int>& slots) const { return C_(slots, slots); }
  core::VecX at(const core::VecX& y) const;             ///< Xᵀ y, by slot
  void push(const core::VecX& f, core::VecX& y) const;  ///< y += X f, f by slot

 private:
  /// The columns of X in one supernode.
  struct Piece
  {
    std::vector<double> value;  ///< (columns of the supernode x slots), column-major
    std::vector<int> slot;
  };
  struct Batch;

  base::Block values(int s) const;
  void enlarge(int count);
  void append(int s, const core::MatX& Y, const int* slots);
  void plan(Batch& batch) const;
  void settle(const Batch& batch);
  static void solve_rows(const SupernodalFactor::Supernode& node, int begin, int end,
                         const int* first_position, const int* last_position, core::MatX& Y);
  void eliminate(int s, Batch& batch);

  const SupernodalFactor* factor_;
  std::vector<Piece> pieces_;  ///< by supernode
  std::vector<int> touched_;   ///< supernodes with columns, ascending
  core::MatX C_;               ///< with room to grow
  int size_ = 0;
};

}  // namespace trocar::solve
