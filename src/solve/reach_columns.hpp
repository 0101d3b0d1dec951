#pragma once

#include <vector>

#include "base/blas.hpp"
#include "solve/supernodal_factor.hpp"

namespace trocar::solve {

/// The nonzero parts of X = L⁻¹ Sᵀ by supernode, and C = Xᵀ X = S A⁻¹ Sᵀ. The column of a unit
/// vector is nonzero only on the path from its position to the root of the elimination tree. So a
/// new column costs only that path, and C needs no backward half-sweep. Every column has a slot,
/// numbered in the order of adding. Serial.
class ReachColumns
{
 public:
  explicit ReachColumns(const SupernodalFactor& factor);

  /// Discards all columns, as after a new factorisation.
  void clear();

  /// Adds a column for the unit vector at each of these closed positions; -1 adds a column of
  /// zeros. They get the next slots. Returns the residuals at the open places after the forward
  /// half-sweep (open x positions).
  core::MatX add_units(const std::vector<int>& positions);

  /// C restricted to these slots.
  core::MatX block(const std::vector<int>& slots) const { return C_(slots, slots); }
  core::VecX at(const core::VecX& y) const;             ///< Xᵀ y, by slot
  void push(const core::VecX& f, core::VecX& y) const;  ///< y += X f, f by slot

 private:
  /// The rows of X that belong to one supernode.
  struct Piece
  {
    std::vector<double> value;  ///< (columns of the supernode x slots), column-major
    std::vector<int> slot;      ///< slots with a nonzero column here
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
  core::MatX C_;               ///< of all slots, inside a larger matrix that leaves room to grow
  int size_ = 0;
};

}  // namespace trocar::solve
