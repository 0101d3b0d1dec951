#pragma once

#include <memory>
#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// Finds tets by place in the reference mesh (R-tree over their boxes). Borrows the mesh.
class Locator
{
 public:
  explicit Locator(const Mesh& mesh);
  ~Locator();
  Locator(Locator&&) noexcept;
  Locator& operator=(Locator&&) noexcept;

  /// Tets whose box meets the box [low, high] (m), ascending.
  std::vector<int> in_box(const Vec3& low, const Vec3& high) const;

  /// The lowest-numbered tet that holds p up to `tolerance` times its longest edge, or -1.
  int tet_at(const Vec3& p, double tolerance = 1e-6) const;

 private:
  struct Tree;
  const Mesh* mesh_;
  std::unique_ptr<Tree> tree_;
  double longest_edge_ = 0.0;  ///< bound of it: the largest box diagonal [m]
};

}  // namespace trocar::mesh
