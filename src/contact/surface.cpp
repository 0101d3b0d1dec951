#include "contact/surface.hpp"

#include <algorithm>
#include <set>

#include "core/failure.hpp"
#include "mesh/topology.hpp"

namespace trocar::contact {

Surface::Surface(const mesh::Mesh& mesh, const std::string& name)
    : name_(name), count_(mesh.quadratic() ? 6 : 3)
{
  std::map<mesh::Face, mesh::Face> outward;
  for (const mesh::BoundaryFace& face : mesh::boundary_faces(mesh))
    outward[mesh::sorted(face.nodes)] = face.nodes;
  std::set<int> corners;
  double edges = 0.0;
  for (const mesh::Face& face : mesh::surface_group(mesh, name).faces) {
    const auto at = outward.find(mesh::sorted(face));
    if (at == outward.end())
      throw core::data_error(mesh.file + ": surface '" + name +
                             "' cannot be in contact: a face of it lies inside the tissue");
    const auto [a, b, c] = at->second;
    ByNode<int> nodes{a, b, c, -1, -1, -1};
    if (mesh.quadratic())
      for (std::size_t k = 0; k < 3; ++k)
        nodes[3 + k] = mesh.middle_of(nodes[k], nodes[(k + 1) % 3]);
    faces_.push_back(nodes);
    corners.insert({a, b, c});
    for (std::size_t k = 0; k < 3; ++k)
      edges += (mesh.x[static_cast<std::size_t>(nodes[k])] -
                mesh.x[static_cast<std::size_t>(nodes[(k + 1) % 3])])
                   .norm();
  }
  mean_edge_ = edges / (3.0 * static_cast<double>(faces_.size()));
  corners_.assign(corners.begin(), corners.end());
  for (std::size_t k = 0; k < corners_.size(); ++k) index_[corners_[k]] = static_cast<int>(k);
  std::vector<std::set<int>> near(corners_.size());
  for (const ByNode<int>& face : faces_)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        if (k != l) near[static_cast<std::size_t>(index_[face[k]])].insert(index_[face[l]]);
  for (const std::set<int>& one : near) neighbours_.emplace_back(one.begin(), one.end());
}

FacePlaces Surface::places(int f, const Deformation& now) const
{
  FacePlaces places{count_, {}};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count_); ++k)
    places.x[k] = now.at(face(f)[k]);
  return places;
}

double area_element(const FacePoint& point)
{
  return 0.5 * point.along.cross(point.across).norm();
}

std::vector<Vec3> Surface::normals(const Deformation& now) const
{
  std::vector<Vec3> normals(corners_.size(), Vec3::Zero());
  for (int f = 0; f < faces(); ++f) {
    const FacePlaces face = places(f, now);
    for (std::size_t k = 0; k < 3; ++k) {
      const FacePoint at = face_point(face, node_param(k));
      normals[static_cast<std::size_t>(corner_of(this->face(f)[k]))] += at.along.cross(at.across);
    }
  }
  for (Vec3& normal : normals) normal.normalize();
  return normals;
}

std::vector<double> Surface::areas(const Deformation& now) const
{
  std::vector<double> areas(corners_.size(), 0.0);
  for (int f = 0; f < faces(); ++f) {
    const FacePlaces face = places(f, now);
    for (const TrianglePoint& point : triangle_points()) {
      const double area = point.weight * area_element(face_point(face, point.at.tail<2>()));
      for (std::size_t k = 0; k < 3; ++k)
        areas[static_cast<std::size_t>(corner_of(this->face(f)[k]))] +=
            area * point.at[static_cast<Eigen::Index>(k)];
    }
  }
  return areas;
}

}  // namespace trocar::contact
