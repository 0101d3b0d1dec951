#include "cavity/wall.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "mesh/quadratic.hpp"
#include "mesh/topology.hpp"

namespace trocar::cavity {
namespace {

using core::MatX;
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

/// Stores the faces by vertex, with normals out of the fluid into the tissue.
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
    for (int node : mesh::nodes_of(mesh, face)) nodes_.push_back(node);
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  surface_.face_nodes = mesh.quadratic() ? 6 : 3;
  for (const Face& face : faces)
    for (int node : mesh::nodes_of(mesh, face)) surface_.nodes.push_back(vertex_of(node));
}

int Wall::vertex_of(int node) const
{
  return static_cast<int>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
}

/// Throws unless the faces around every vertex form one fan, joined along their edges.
void Wall::check_fans(const mesh::Mesh& mesh) const
{
  // Maps a vertex to the edges opposite to it, one in each of its faces.
  std::map<int, std::vector<std::array<int, 2>>> around;
  for (std::size_t f = 0; f < surface_.faces(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      around[face_node(f, k)].push_back({face_node(f, (k + 1) % 3), face_node(f, (k + 2) % 3)});
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

/// Throws when two faces pass an edge in the same direction. Edges of a single face form the rims
/// of holes, which get caps or, without `caps`, are refused.
void Wall::check_edges(const mesh::Mesh& mesh, bool caps)
{
  std::map<std::array<int, 2>, int> directed;
  for (std::size_t f = 0; f < surface_.faces(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<int, 2> edge{face_node(f, k), face_node(f, (k + 1) % 3)};
      if (++directed[edge] > 1)
        throw trouble(mesh, name_,
                      "touches itself along the edge of nodes " +
                          tag_of(mesh, nodes_[static_cast<std::size_t>(edge[0])]) + " and " +
                          tag_of(mesh, nodes_[static_cast<std::size_t>(edge[1])]));
    }
  std::map<int, int> next;  // next vertex on a rim, against the faces' direction
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
    cap(rim, mesh);
  }
}

void Wall::cap(const std::vector<int>& rim, const mesh::Mesh& mesh)
{
  const auto next = [&] { return static_cast<int>(nodes_.size() + cap_vertices_.size()); };
  const std::size_t count = rim.size();
  const bool quadratic = surface_.face_nodes == 6;
  std::vector<int> around = rim;
  for (std::size_t k = 0; quadratic && k < count; ++k)
    around.push_back(
        vertex_of(mesh.middle_of(nodes_[static_cast<std::size_t>(rim[k])],
                                 nodes_[static_cast<std::size_t>(rim[(k + 1) % count])])));
  Mean middle;
  for (int vertex : around) middle.emplace_back(vertex, 1.0 / static_cast<double>(around.size()));
  const int centre = next();
  cap_vertices_.push_back(middle);
  const int spokes = next();
  for (std::size_t k = 0; quadratic && k < count; ++k) {
    Mean half{{rim[k], 0.5}};
    for (const auto& [vertex, weight] : middle) half.emplace_back(vertex, 0.5 * weight);
    cap_vertices_.push_back(half);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t after = (k + 1) % count;
    for (int vertex : {rim[k], rim[after], centre}) surface_.nodes.push_back(vertex);
    if (quadratic)
      for (int vertex :
           {around[count + k], spokes + static_cast<int>(after), spokes + static_cast<int>(k)})
        surface_.nodes.push_back(vertex);
  }
  std::vector<int> nodes;
  for (int vertex : around) nodes.push_back(nodes_[static_cast<std::size_t>(vertex)]);
  rims_.push_back(std::move(nodes));
}

void Wall::measure(const mesh::Mesh& mesh)
{
  for (int node : nodes_)
    reference_ += mesh.x[static_cast<std::size_t>(node)] / static_cast<double>(nodes_.size());
  VecX x = VecX::Zero(3 * static_cast<Eigen::Index>(nodes_.size() + cap_vertices_.size()));
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    x.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        mesh.x[static_cast<std::size_t>(nodes_[i])] - reference_;
  add_caps(x);
  undeformed_ = std::move(x);
  volume_ = law::volume(surface_, undeformed_);
  for (std::size_t f = 0; f < surface_.faces(); ++f) {
    MatX face(3, surface_.face_nodes);
    for (Eigen::Index k = 0; k < face.cols(); ++k)
      face.col(k) = undeformed_.segment<3>(3 * face_node(f, static_cast<std::size_t>(k)));
    area_ += law::face_shares(face).sum();
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
  space.comm().merge(values);
  add_caps(values);
  return values;
}

/// Adds the weighted means of nodal values to the vertices of the caps, which are zero before.
void Wall::add_caps(VecX& values) const
{
  for (std::size_t c = 0; c < cap_vertices_.size(); ++c)
    for (const auto& [vertex, weight] : cap_vertices_[c])
      values.segment<3>(3 * static_cast<Eigen::Index>(nodes_.size() + c)) +=
          weight * values.segment<3>(3 * vertex);
}

OwnedField Wall::to_nodes(const VecX& vertices, const fem::Space& space) const
{
  VecX values = vertices;
  for (std::size_t c = 0; c < cap_vertices_.size(); ++c)
    for (const auto& [vertex, weight] : cap_vertices_[c])
      values.segment<3>(3 * vertex) +=
          weight * vertices.segment<3>(3 * static_cast<Eigen::Index>(nodes_.size() + c));
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
  const auto see = [&](std::size_t f, std::size_t i, std::size_t j, std::size_t k) {
    const auto to = [&](std::size_t n) -> Vec3 {
      return x.segment<3>(3 * face_node(f, n)) - point;
    };
    // Solid angle of a triangle (van Oosterom and Strackee 1983).
    const Vec3 a = to(i), b = to(j), c = to(k);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  };
  for (std::size_t f = 0; f < surface_.faces(); ++f) {
    if (surface_.face_nodes == 3) {
      see(f, 0, 1, 2);
      continue;
    }
    see(f, 0, 3, 5);  // a quadratic face as four flat ones
    see(f, 3, 1, 4);
    see(f, 5, 4, 2);
    see(f, 3, 4, 5);
  }
  return angle > 2.0 * std::numbers::pi;
}

}  // namespace trocar::cavity
