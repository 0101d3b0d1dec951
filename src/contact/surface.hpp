#pragma once

#include <map>
#include <string>
#include <vector>

#include "contact/face.hpp"
#include "fem/space.hpp"

namespace trocar::contact {

/// The deformed mesh at a time. Borrows mesh and displacement.
struct Deformation
{
  const mesh::Mesh& mesh;
  const fem::GlobalField& u;
  double t = 0.0;  ///< [s]

  Vec3 at(int node) const { return mesh.x[static_cast<std::size_t>(node)] + u.node(node); }
};

/// A named surface of the tissue as contact sees it: its faces, oriented outwards.
class Surface
{
 public:
  /// Throws Failure (65) when there is no such surface, or when a face of it lies inside the
  /// tissue.
  Surface(const mesh::Mesh& mesh, const std::string& name);

  const std::string& name() const { return name_; }
  int faces() const { return static_cast<int>(faces_.size()); }
  int nodes_per_face() const { return count_; }
  /// File nodes of a face, see ByNode.
  const ByNode<int>& face(int f) const { return faces_[static_cast<std::size_t>(f)]; }
  FacePlaces places(int f, const Deformation& now) const;

  const std::vector<int>& corners() const { return corners_; }  ///< file nodes, ascending
  int corner_of(int node) const { return index_.at(node); }     ///< position in `corners`
  /// The corners that share an edge with a corner, as positions in `corners`, ascending.
  const std::vector<int>& neighbours(int corner) const
  {
    return neighbours_[static_cast<std::size_t>(corner)];
  }
  /// Normals at the corners: the mean of the faces' normals there, weighted by area.
  std::vector<Vec3> normals(const Deformation& now) const;
  /// ∫φ_j over the whole surface by corner [m²], φ_j linear on every face.
  std::vector<double> areas(const Deformation& now) const;
  double mean_edge() const { return mean_edge_; }  ///< of the undeformed faces [m]

 private:
  std::string name_;
  int count_;
  std::vector<ByNode<int>> faces_;
  std::vector<int> corners_;
  std::map<int, int> index_;
  std::vector<std::vector<int>> neighbours_;
  double mean_edge_ = 0.0;
};

/// Length of the true area element over that of the parameters, at a place of a face [m²].
double area_element(const FacePoint& point);

}  // namespace trocar::contact
