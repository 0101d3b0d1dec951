#pragma once

#include <memory>
#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// Finds tets by position in the reference mesh, with an R-tree of their bounding boxes. Borrows
/// the mesh.
class Locator
{
 public:
  explicit Locator(const Mesh& mesh);
  ~Locator();
  Locator(Locator&&) noexcept;
  Locator& operator=(Locator&&) noexcept;

  /// Tets whose bounding box intersects the box [low, high] (m), ascending.
  std::vector<int> in_box(const Vec3& low, const Vec3& high) const;

  /// The lowest-numbered tet in which no local coordinate of p is below -`tolerance`; -1 where
  /// there is none.
  int tet_at(const Vec3& p, double tolerance = 1e-6) const;

 private:
  struct Tree;
  const Mesh* mesh_;
  std::unique_ptr<Tree> tree_;
  double longest_edge_ = 0.0;  ///< upper bound: the largest box diagonal [m]
};

}  // namespace trocar::mesh
