#pragma once

#include <memory>
#include <vector>

#include "core/math.hpp"

namespace trocar::solve {

/// Upper triangle of a symmetric matrix by compressed columns, rows ascending.
struct SymmetricPattern
{
  std::vector<int> start;  ///< by column, one more than columns
  std::vector<int> row;

  int size() const { return static_cast<int>(start.size()) - 1; }
};

/// A = L Lᵀ by supernodes (CHOLMOD), and the sweeps and the structure that isolated compliance
/// needs. "Position" is a place in the factor's own order. Serial.
class SupernodalFactor
{
 public:
  /// Analyses the pattern in the given order (dof at each place). The last `open` places, which
  /// must be coupled with each other and with all that stands before, are not eliminated: sweeps
  /// leave there what the others pass on. Failure (70) when it does not fit in memory.
  SupernodalFactor(const SymmetricPattern& pattern, const std::vector<int>& order, int open = 0);
  ~SupernodalFactor();
  SupernodalFactor(SupernodalFactor&&) noexcept;
  SupernodalFactor& operator=(SupernodalFactor&&) noexcept;

  /// Takes values (by entry of the pattern) and factors. Failure (70) when A is not positive
  /// definite.
  void factorise(const std::vector<double>& values);

  int position(int dof) const { return position_[static_cast<std::size_t>(dof)]; }
  int size() const { return static_cast<int>(position_.size()); }
  int closed() const { return closed_; }  ///< places that are eliminated, the first ones
  /// What is left of A on the open places (open x open), by place.
  core::MatX open_block() const;
  double bytes() const;      ///< of L [B], known from the analysis
  double all_bytes() const;  ///< with the matrix and what factoring needs [B]
  double flops() const;      ///< of one factorisation

  /// One supernode: its dense columns of L, diagonal block first, and the positions of its rows.
  struct Supernode
  {
    int first;    ///< position of its first column
    int columns;  ///< as many rows are in the diagonal block
    int rows;     ///< all of them
    const int* row;
    const double* L;  ///< (rows x columns), column-major
    std::size_t at;   ///< where it begins in all values of L

    int below() const { return rows - columns; }
    Eigen::Map<const core::MatX> block() const { return {L, rows, columns}; }
  };
  int supernodes() const { return supernodes_; }
  Supernode supernode(int s) const;
  /// -1 at open places.
  int supernode_at(int position) const { return at_[static_cast<std::size_t>(position)]; }
  /// The supernode that this one's update goes to first, -1 for a root and for open places.
  int parent(int s) const { return parent_[static_cast<std::size_t>(s)]; }

  void forward(core::VecX& b) const;   ///< b <- L⁻¹ b, by position
  void backward(core::VecX& y) const;  ///< y <- L⁻ᵀ y, by position
  /// The same to single precision from a copy of L that takes half as long to read; the copy is
  /// made on first use.
  void forward_single(core::VecX& b);
  void backward_single(core::VecX& y);

 private:
  void copy_single();
  Supernode whole_supernode(int s) const;

  struct Handles;
  std::unique_ptr<Handles> handles_;
  int closed_ = 0;
  int supernodes_ = 0;         ///< that begin before the open places
  std::vector<int> position_;  ///< by dof
  std::vector<int> at_;        ///< supernode by position
  std::vector<int> parent_;
  std::vector<float> single_;  ///< values of L; empty until asked for
};

}  // namespace trocar::solve
