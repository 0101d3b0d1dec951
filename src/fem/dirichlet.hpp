#pragma once

#include <vector>

#include "fem/space.hpp"

namespace trocar::fem {

/// The fixed dofs, whose displacement is prescribed; known on every rank. They are part of the
/// operator: another set of fixed dofs needs a new operator. Borrows the space.
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
  /// Fixed axes of the node with this global number, as bits: 1 for x, 2 for y, 4 for z.
  unsigned axes_of_number(int number) const { return axes_[static_cast<std::size_t>(number)]; }

  /// Sets the entries of fixed dofs to zero.
  void clear(OwnedField& field) const
  {
    for (int local = 0; local < space_->owned(); ++local)
      for (int a = 0; a < 3; ++a)
        if (axes_of_number(space_->first() + local) >> a & 1U) field.value[3 * local + a] = 0.0;
  }

 private:
  std::vector<unsigned char> axes_;  ///< fixed axes as bits, by global node number
  const Space* space_;
};

}  // namespace trocar::fem
