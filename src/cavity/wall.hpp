#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fem/space.hpp"
#include "law/volume.hpp"

namespace trocar::cavity {

using core::Vec3;
using core::VecX;
using fem::OwnedField;

/// The wall between a cavity's fluid and the tissue: a physical surface of the mesh, oriented out
/// of the fluid, with its holes closed by caps. A cap is a fan of triangles around the mean of its
/// rim. It adds no dofs: the rim carries the pressure on the cap. Faces are flat, or quadratic when
/// the mesh is.
class Wall
{
 public:
  /// Checks and orients the surface. Throws Failure (65) naming the surface when it is empty, has a
  /// face twice, is not the boundary of the tissue, touches itself, lies round the tissue instead
  /// of a void, encloses nothing, or has a hole and `caps` is false. Not collective.
  Wall(const mesh::Mesh& mesh, const std::string& surface, bool caps);

  const std::string& name() const { return name_; }
  double volume() const { return volume_; }                 ///< V_0, undeformed [m³]
  double area() const { return area_; }                     ///< undeformed, caps included [m²]
  const Vec3& reference() const { return reference_; }      ///< origin of vertex coordinates [m]
  const std::vector<int>& nodes() const { return nodes_; }  ///< file nodes, ascending
  /// File nodes around each hole that was capped.
  const std::vector<std::vector<int>>& rims() const { return rims_; }
  const law::ClosedSurface& surface() const { return surface_; }

  /// Undeformed coordinates of the vertices (nodes, then caps) less the reference point [m].
  const VecX& undeformed() const { return undeformed_; }
  /// Values of a field at the vertices (3 · vertices), equal on every rank. Collective.
  VecX at_vertices(const OwnedField& field, const fem::Space& space) const;
  /// The adjoint of `at_vertices`: nodal forces equivalent to forces at the vertices. Not
  /// collective.
  OwnedField to_nodes(const VecX& vertices, const fem::Space& space) const;

  /// True when `point` lies inside the wall with vertex coordinates x: the solid angle of the wall,
  /// seen from the point, is then 4π. Both count from the reference point [m].
  bool holds(const Vec3& point, const VecX& x) const;

 private:
  void orient(const mesh::Mesh& mesh, const mesh::SurfaceGroup& group);
  void check_edges(const mesh::Mesh& mesh, bool caps);
  void check_fans(const mesh::Mesh& mesh) const;
  void cap(const std::vector<int>& rim, const mesh::Mesh& mesh);
  int vertex_of(int node) const;
  int face_node(std::size_t face, std::size_t k) const
  {
    return surface_.nodes[static_cast<std::size_t>(surface_.face_nodes) * face + k];
  }
  void measure(const mesh::Mesh& mesh);
  void add_caps(VecX& values) const;

  std::string name_;
  law::ClosedSurface surface_;          ///< faces, by vertex numbers
  std::vector<int> nodes_;              ///< file nodes, ascending: the first vertices
  std::vector<std::vector<int>> rims_;  ///< in file nodes
  /// A cap's vertex as a mean of nodal vertices: (vertex, weight). Numbered after these.
  using Mean = std::vector<std::pair<int, double>>;
  std::vector<Mean> cap_vertices_;
  Vec3 reference_ = Vec3::Zero();  ///< mean of the nodes [m]
  VecX undeformed_;
  double volume_ = 0.0, area_ = 0.0;
};

}  // namespace trocar::cavity
