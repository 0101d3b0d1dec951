#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::solve {

/// The dense end of an elimination that several ranks share: what is left of A on the dofs between
/// their domains, and the columns of X there. Serial; lives on rank 0.
class InterfaceBlock
{
 public:
  /// Takes A less what the domains have taken off it (n x n). Failure (70) when it is not positive
  /// definite.
  void factorise(core::MatX S);
  core::VecX forward(const core::VecX& t) const;   ///< L⁻¹ t
  core::VecX backward(const core::VecX& y) const;  ///< L⁻ᵀ y

  void forget_columns() { X_.resize(L_.rows(), 0); }
  /// Adds columns L⁻¹ t; their slots follow on.
  void add(const core::MatX& t);
  core::MatX block(const std::vector<int>& slots) const;  ///< Xᵀ X of these slots
  core::VecX at(const core::VecX& y) const { return X_.transpose() * y; }  ///< by slot
  void push(const core::VecX& f, core::VecX& y) const { y.noalias() += X_ * f; }

 private:
  core::MatX L_, X_;
};

}  // namespace trocar::solve
