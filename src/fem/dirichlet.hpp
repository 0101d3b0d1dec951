#pragma once

#include <vector>

#include "fem/space.hpp"

namespace trocar::fem {

/// Dofs whose displacement is prescribed, known on every rank. A value of this type is part of the
/// operator: a change of the fixed set is a new operator.
class Dirichlet
{
 public:
  explicit Dirichlet(const Space& space)
      : axes_(static_cast<std::size_t>(space.global()), 0), space_(&space)
  {
  }

  void fix(int file_node, int axis)
  {
    auto& bits = axes_[static_cast<std::size_t>(space_->number_of_file(file_node))];
    bits = static_cast<unsigned char>(bits | (1U << axis));
  }
  bool fixed(int file_node, int axis) const
  {
    return axes_of_number(space_->number_of_file(file_node)) >> axis & 1U;
  }
  /// Bits of the fixed axes (1, 2, 4) of the node with that global number.
  unsigned axes_of_number(int number) const { return axes_[static_cast<std::size_t>(number)]; }

  /// Sets the entries of fixed dofs to zero.
  void clear(OwnedField& field) const
  {
    for (int local = 0; local < space_->owned(); ++local)
      for (int a = 0; a < 3; ++a)
        if (axes_of_number(space_->first() + local) >> a & 1U) field.value[3 * local + a] = 0.0;
  }

 private:
  std::vector<unsigned char> axes_;  ///< by global number
  const Space* space_;
};

}  // namespace trocar::fem
