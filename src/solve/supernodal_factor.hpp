#pragma once

#include <memory>
#include <vector>

#include "core/math.hpp"

namespace trocar::solve {

/// Pattern of the upper triangle of a symmetric matrix, in compressed columns with ascending rows.
struct SymmetricPattern
{
  std::vector<int> start;  ///< first entry of every column, then the number of entries
  std::vector<int> row;    ///< by entry

  int size() const { return static_cast<int>(start.size()) - 1; }
};

/// Supernodal Cholesky factor A = L Lᵀ (CHOLMOD), with half-sweeps and with the structure of L that
/// the isolated compliance needs. A "position" is the place of a dof in the factor's own
/// elimination order. Serial.
class SupernodalFactor
{
 public:
  /// Analyses the pattern for the given elimination order (dof at each place). The last `open`
  /// places are not eliminated; the others are "closed". In the pattern all open places must be
  /// coupled with each other, and each connected part of the closed places must be coupled with an
  /// open place. Only then CHOLMOD's postorder keeps the open places last. Failure (70) when the
  /// factor does not fit in memory.
  SupernodalFactor(const SymmetricPattern& pattern, const std::vector<int>& order, int open = 0);
  ~SupernodalFactor();
  SupernodalFactor(SupernodalFactor&&) noexcept;
  SupernodalFactor& operator=(SupernodalFactor&&) noexcept;

  /// Takes values (by entry of the pattern) and factors. Failure (70) when A is not positive
  /// definite.
  void factorise(const std::vector<double>& values);

  int position(int dof) const { return position_[static_cast<std::size_t>(dof)]; }
  int size() const { return static_cast<int>(position_.size()); }
  int closed() const { return closed_; }  ///< number of eliminated places, which come first
  /// Schur complement of A on the open places (open x open), in the order of their positions.
  core::MatX open_block() const;
  double bytes() const;      ///< memory of L [B], known from the analysis
  double all_bytes() const;  ///< memory of L, the matrix and CHOLMOD's work space [B]
  double flops() const;      ///< of one factorisation

  /// One supernode: a dense block of columns of L, diagonal block on top, and its rows' positions.
  struct Supernode
  {
    int first;        ///< position of its first column
    int columns;      ///< number of columns, and of rows in the diagonal block
    int rows;         ///< number of rows, diagonal block included
    const int* row;   ///< position in the factor of each of these rows
    const double* L;  ///< (rows x columns), column-major
    std::size_t at;   ///< offset of `L` in the values of the whole factor

    int below() const { return rows - columns; }
    Eigen::Map<const core::MatX> block() const { return {L, rows, columns}; }
  };
  int supernodes() const { return supernodes_; }
  Supernode supernode(int s) const;
  /// The supernode that has this position as a column; -1 for open places.
  int supernode_at(int position) const { return at_[static_cast<std::size_t>(position)]; }
  /// Parent in the elimination tree; -1 for a root, or where the parent is an open place.
  int parent(int s) const { return parent_[static_cast<std::size_t>(s)]; }

  /// b <- L⁻¹ b, by position. Open places get the residual: b less the terms of the closed places.
  void forward(core::VecX& b) const;
  /// y <- L⁻ᵀ y, by position; open places hold the solution already.
  void backward(core::VecX& y) const;
  /// The same half-sweeps with a copy of L in single precision, which takes half as long to read.
  /// The copy is made on first use.
  void forward_single(core::VecX& b);
  void backward_single(core::VecX& y);

 private:
  void copy_single();
  Supernode whole_supernode(int s) const;

  struct Handles;
  std::unique_ptr<Handles> handles_;
  int closed_ = 0;
  int supernodes_ = 0;         ///< number of supernodes with a closed column
  std::vector<int> position_;  ///< position by dof
  std::vector<int> at_;        ///< supernode by position
  std::vector<int> parent_;    ///< by supernode, see `parent`
  std::vector<float> single_;  ///< L in single precision; empty until first use
};

}  // namespace trocar::solve
