#pragma once

#include <map>
#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::insertion {

using core::Vec3;

/// Forces f_p >= 0 at which membranes are pierced [N].
struct PunctureSettings
{
  std::vector<double> volume;   ///< by physical volume of the mesh: f_p of its boundary
  std::vector<double> surface;  ///< by physical surface of the mesh; -1: f_p of the volume
};

/// The faces that must be punctured: the surface of the tissue (outside, cavity walls), faces
/// between two volumes, and faces of physical surfaces inside a volume. A face has the threshold of
/// its physical surface. Without one it has the threshold of the volume that the tip enters or, on
/// the way out of the tissue, of the volume that it leaves.
class Membranes
{
 public:
  /// Borrows the mesh.
  Membranes(const mesh::Mesh& mesh, PunctureSettings settings);

  bool any() const { return any_; }

  /// f_p [N] of the membrane between two tets (-1: no tissue) at the reference place X; 0: no
  /// membrane.
  double threshold(int from, int to, const Vec3& X) const;

 private:
  double of_surface(int tet, const Vec3& X) const;

  const mesh::Mesh* mesh_;
  PunctureSettings settings_;
  bool any_ = false;
  std::map<mesh::Face, double> tagged_;  ///< sorted corners -> f_p of the physical surface
};

}  // namespace trocar::insertion
