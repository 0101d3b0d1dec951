#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::solve {

/// The dense last block of an elimination on several ranks: the Schur complement of A on the
/// interface, its factor L Lᵀ, and the interface rows of the compliance columns X (docs/theory.md,
/// algorithms 8.1 and 8.2). Serial; lives on rank 0.
class InterfaceBlock
{
 public:
  /// Factors the Schur complement S (n x n) and discards the columns. Failure (70) when S is not
  /// positive definite.
  void factorise(core::MatX S);
  core::VecX forward(const core::VecX& t) const;   ///< L⁻¹ t
  core::VecX backward(const core::VecX& y) const;  ///< L⁻ᵀ y

  void forget_columns() { X_.resize(L_.rows(), 0); }
  /// Adds the columns L⁻¹ t; they get the next slots.
  void add(const core::MatX& t);
  core::MatX block(const std::vector<int>& slots) const;  ///< part of Xᵀ X for these slots
  core::VecX at(const core::VecX& y) const { return X_.transpose() * y; }  ///< Xᵀ y, by slot
  /// y += X f, f by slot
  void push(const core::VecX& f, core::VecX& y) const { y.noalias() += X_ * f; }

 private:
  core::MatX L_, X_;
};

}  // namespace trocar::solve
