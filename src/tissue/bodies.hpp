#pragma once

#include <string>
#include <vector>

#include "fem/dirichlet.hpp"
#include "tissue/material.hpp"

namespace trocar::tissue {

/// A connected part of the mesh.
struct Body
{
  std::vector<int> volumes;  ///< indices of `Mesh::volumes`, ascending
  bool held = false;         ///< the supports leave it no rigid motion
  /// Smallest and largest side of the box with the moments of its nodes [m].
  double thickness = 0.0, length = 0.0;
};

/// All connected parts and the part of every node.
struct Bodies
{
  std::vector<Body> all;
  std::vector<int> of_node;

  /// "part 2 of 3, volume 'tumour'"; empty when there is only one.
  std::string name(const mesh::Mesh& mesh, std::size_t body) const;
};
/// Not collective.
Bodies bodies_of(const mesh::Mesh& mesh, const fem::Dirichlet& fixed);

/// Throws Failure (64) when the supports leave a rigid motion of a body free: a static problem
/// would be singular.
void require_supports(const fem::Dirichlet& fixed, const mesh::Mesh& mesh);
[[noreturn]] void refuse_free(const Bodies& bodies, const mesh::Mesh& mesh, std::size_t body);

/// Rate s [1/s²] of a term s M in the static operator that is small beside the stiffness of every
/// body, in bending too: 5e-3 times the least E h²/(ρ L⁴), with h and L its thickness and length.
double small_inertia(const Bodies& bodies, const std::vector<Material>& materials);

}  // namespace trocar::tissue
