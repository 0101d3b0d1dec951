#pragma once

#include <map>
#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::insertion {

using core::Vec3;

/// Force that pierces what the tip comes to, f_p >= 0 [N].
struct PunctureSettings
{
  std::vector<double> volume;   ///< by volume of the mesh: the skin around it
  std::vector<double> surface;  ///< by physical surface of the mesh; -1: as the volume says
};

/// The faces that must be punctured: the surface of the tissue (outside, cavity walls), faces
/// between two volumes, and those of physical surfaces inside a volume. A face takes the threshold
/// of its physical surface, else that of the volume entered; on the way out, of the volume left.
class Membranes
{
 public:
  /// Borrows the mesh.
  Membranes(const mesh::Mesh& mesh, PunctureSettings settings);

  bool any() const { return any_; }

  /// f_p [N] for going at the reference place X from one tet into another (-1: no tissue);
  /// 0: nothing is in the way.
  double threshold(int from, int to, const Vec3& X) const;

 private:
  double of_surface(int tet, const Vec3& X) const;

  const mesh::Mesh* mesh_;
  PunctureSettings settings_;
  bool any_ = false;
  std::map<mesh::Face, double> tagged_;  ///< sorted nodes of a surface's faces -> its threshold
};

}  // namespace trocar::insertion
