#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// Mean length of the edges around a place, continuous from tet to tet. The value of a node is the
/// mean over the tets around it, by volume, of their mean edges, and is averaged once more over the
/// neighbours. Lengths that are read off the single tets scatter by a third on a mesh that is meant
/// to be uniform. Edges of a quadratic tet are whole, from corner to corner. Borrows the mesh.
class SmoothedEdges
{
 public:
  explicit SmoothedEdges(const Mesh& mesh);

  /// At the place X of a tet, interpolated linearly between its corners [m].
  double at(int tet, const Vec3& X) const;

 private:
  void average(const std::vector<double>& of_tet);

  const Mesh* mesh_;
  std::vector<double> of_node_;  ///< [m]; 0 for middle nodes
};

}  // namespace trocar::mesh
