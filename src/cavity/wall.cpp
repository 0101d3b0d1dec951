#include "cavity/wall.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "mesh/topology.hpp"

namespace trocar::cavity {
namespace {

using mesh::Face;
using mesh::sorted;

std::string tag_of(const mesh::Mesh& mesh, int node)
{
  return std::to_string(mesh.node_tag[static_cast<std::size_t>(node)]);
}

std::string place(const Vec3& x)
{
  char text[96];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g) m", x.x(), x.y(), x.z());
  return text;
}

core::Failure trouble(const mesh::Mesh& mesh, const std::string& name, const std::string& what)
{
  return core::data_error(mesh.file + ": cavity wall '" + name + "' " + what);
}

}  // namespace

Wall::Wall(const mesh::Mesh& mesh, const std::string& surface, bool caps) : name_(surface)
{
  orient(mesh, mesh::surface_group(mesh, surface));
  check_fans(mesh);
  check_edges(mesh, caps);
  measure(mesh);
}

/// Faces by vertex, normals into the tissue.
void Wall::orient(const mesh::Mesh& mesh, const mesh::SurfaceGroup& group)
{
  std::map<Face, Face> boundary;  // sorted nodes -> nodes, normal out of the tissue
  for (const mesh::BoundaryFace& face : mesh::boundary_faces(mesh))
    boundary.emplace(sorted(face.nodes), face.nodes);
  std::set<Face> seen;
  std::vector<Face> faces;
  for (const Face& face : group.faces) {
    const std::string at = "(nodes " + tag_of(mesh, face[0]) + ", " + tag_of(mesh, face[1]) + ", " +
                           tag_of(mesh, face[2]) + ")";
    if (!seen.insert(sorted(face)).second) throw trouble(mesh, name_, "has a face twice " + at);
    const auto found = boundary.find(sorted(face));
    if (found == boundary.end())
      throw trouble(mesh, name_,
                    "has a face with tissue on both sides " + at +
                        ": name the volume to be emptied with -cavity_<n>_region instead");
    faces.push_back({found->second[0], found->second[2], found->second[1]});
    nodes_.insert(nodes_.end(), face.begin(), face.end());
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (const Face& face : faces)
    for (int node : face)
      surface_.nodes.push_back(
          static_cast<int>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin()));
}

/// Around every vertex the faces must hang together by edges: one fan.
void Wall::check_fans(const mesh::Mesh& mesh) const
{
  std::map<int, std::vector<std::array<int, 2>>> around;  // vertex -> edges opposite to it
  for (std::size_t f = 0; f < surface_.faces(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      around[surface_.nodes[3 * f + k]].push_back(
          {surface_.nodes[3 * f + (k + 1) % 3], surface_.nodes[3 * f + (k + 2) % 3]});
  for (const auto& [vertex, edges] : around) {
    std::vector<std::array<int, 2>> left(edges.begin() + 1, edges.end());
    std::set<int> reached{edges.front()[0], edges.front()[1]};
    for (bool grew = true; grew && !left.empty();) {
      const auto touching = std::find_if(left.begin(), left.end(), [&](const auto& e) {
        return reached.count(e[0]) || reached.count(e[1]);
      });
      grew = touching != left.end();
      if (!grew) break;
      reached.insert(touching->begin(), touching->end());
      left.erase(touching);
    }
    if (!left.empty())
      throw trouble(
          mesh, name_,
          "touches itself at node " + tag_of(mesh, nodes_[static_cast<std::size_t>(vertex)]));
  }
}

/// Every edge has one face on each side; edges with one face only are the rims of holes.
void Wall::check_edges(const mesh::Mesh& mesh, bool caps)
{
  std::map<std::array<int, 2>, int> directed;
  for (std::size_t f = 0; f < surface_.faces(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<int, 2> edge{surface_.nodes[3 * f + k], surface_.nodes[3 * f + (k + 1) % 3]};
      if (++directed[edge] > 1)
        throw trouble(mesh, name_,
                      "touches itself along the edge of nodes " +
                          tag_of(mesh, nodes_[static_cast<std::size_t>(edge[0])]) + " and " +
                          tag_of(mesh, nodes_[static_cast<std::size_t>(edge[1])]));
    }
  std::map<int, int> next;  // along the rims, against the faces
  for (const auto& [edge, count] : directed)
    if (!directed.count({edge[1], edge[0]})) next[edge[1]] = edge[0];
  while (!next.empty()) {
    std::vector<int> rim;
    for (auto at = next.begin(); at != next.end(); at = next.find(rim.back())) {
      const int to = at->second;
      if (rim.empty()) rim.push_back(at->first);
      next.erase(at);
      if (to == rim.front()) break;
      rim.push_back(to);
    }
    Vec3 middle = Vec3::Zero();
    for (int vertex : rim)
      middle += mesh.x[static_cast<std::size_t>(nodes_[static_cast<std::size_t>(vertex)])] /
                static_cast<double>(rim.size());
    if (!caps)
      throw trouble(mesh, name_,
                    "has a hole of " + std::to_string(rim.size()) + " edges around " +
                        place(middle) + ": close it, or give -cavity_<n>_cap");
    cap(rim);
  }
}

void Wall::cap(const std::vector<int>& rim)
{
  const int centre = static_cast<int>(nodes_.size() + rim_vertices_.size());
  for (std::size_t k = 0; k < rim.size(); ++k) {
    surface_.nodes.push_back(rim[k]);
    surface_.nodes.push_back(rim[(k + 1) % rim.size()]);
    surface_.nodes.push_back(centre);
  }
  rim_vertices_.push_back(rim);
  std::vector<int> nodes;
  for (int vertex : rim) nodes.push_back(nodes_[static_cast<std::size_t>(vertex)]);
  rims_.push_back(std::move(nodes));
}

void Wall::measure(const mesh::Mesh& mesh)
{
  for (int node : nodes_)
    reference_ += mesh.x[static_cast<std::size_t>(node)] / static_cast<double>(nodes_.size());
  VecX x(3 * static_cast<Eigen::Index>(nodes_.size() + rim_vertices_.size()));
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    x.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        mesh.x[static_cast<std::size_t>(nodes_[i])] - reference_;
  for (std::size_t c = 0; c < rim_vertices_.size(); ++c) {
    Vec3 middle = Vec3::Zero();
    for (int vertex : rim_vertices_[c])
      middle += x.segment<3>(3 * vertex) / static_cast<double>(rim_vertices_[c].size());
    x.segment<3>(3 * static_cast<Eigen::Index>(nodes_.size() + c)) = middle;
  }
  undeformed_ = std::move(x);
  volume_ = law::volume(surface_, undeformed_);
  for (std::size_t f = 0; f < surface_.faces(); ++f) {
    const auto at = [&](std::size_t k) -> Vec3 {
      return undeformed_.segment<3>(3 * surface_.nodes[3 * f + k]);
    };
    area_ += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  const double nothing = 1e-9 * std::pow(area_, 1.5);
  if (std::abs(volume_) <= nothing) throw trouble(mesh, name_, "encloses no volume");
  if (volume_ < 0.0)
    throw trouble(mesh, name_, "is inside out: it lies round the tissue, not round a void");
}

VecX Wall::at_vertices(const OwnedField& field, const fem::Space& space) const
{
  VecX values = VecX::Zero(undeformed_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const int local = space.owned_local(nodes_[i]);
    if (local >= 0) values.segment<3>(3 * static_cast<Eigen::Index>(i)) = field.node(local);
  }
  space.comm().sum(values);
  for (std::size_t c = 0; c < rim_vertices_.size(); ++c)
    for (int vertex : rim_vertices_[c])
      values.segment<3>(3 * static_cast<Eigen::Index>(nodes_.size() + c)) +=
          values.segment<3>(3 * vertex) / static_cast<double>(rim_vertices_[c].size());
  return values;
}

OwnedField Wall::to_nodes(const VecX& vertices, const fem::Space& space) const
{
  VecX values = vertices;
  for (std::size_t c = 0; c < rim_vertices_.size(); ++c)
    for (int vertex : rim_vertices_[c])
      values.segment<3>(3 * vertex) +=
          vertices.segment<3>(3 * static_cast<Eigen::Index>(nodes_.size() + c)) /
          static_cast<double>(rim_vertices_[c].size());
  OwnedField field = space.zero();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const int local = space.owned_local(nodes_[i]);
    if (local >= 0) field.node(local) = values.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  return field;
}

bool Wall::holds(const Vec3& point, const VecX& x) const
{
  double angle = 0.0;
  for (std::size_t f = 0; f < surface_.faces(); ++f) {
    const auto to = [&](std::size_t k) -> Vec3 {
      return x.segment<3>(3 * surface_.nodes[3 * f + k]) - point;
    };
    // van Oosterom and Strackee 1983
    const Vec3 a = to(0), b = to(1), c = to(2);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle > 2.0 * std::numbers::pi;
}

}  // namespace trocar::cavity
