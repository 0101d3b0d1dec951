#pragma once

#include "tissue/tissue.hpp"

// What the element loops of the tissue share.
namespace trocar::tissue {

using Nodal = Eigen::Matrix<double, 3, 4>;

inline Nodal nodal_values(const fem::GhostedField& field, const fem::Space::LocalTet& tet)
{
  Nodal values;
  for (int a = 0; a < 4; ++a) values.col(a) = field.node(tet.nodes[static_cast<std::size_t>(a)]);
  return values;
}

/// Adds the element's nodal vectors to the nodes owned here; the others' owners add their own.
inline void scatter(const Nodal& element, const fem::Space::LocalTet& tet, OwnedField& field)
{
  for (int a = 0; a < 4; ++a) {
    const int node = tet.nodes[static_cast<std::size_t>(a)];
    if (3 * node < field.value.size()) field.node(node) += element.col(a);
  }
}

/// M w of one tet [kg · unit of w].
inline Nodal mass_times(const Nodal& w, double mass, Mass kind)
{
  if (kind == Mass::lumped) return mass / 4.0 * w;
  return mass / 20.0 * (w.colwise() + w.rowwise().sum().eval());
}

}  // namespace trocar::tissue
