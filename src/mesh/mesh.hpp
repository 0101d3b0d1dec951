#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/comm.hpp"
#include "core/math.hpp"

namespace trocar::mesh {

using core::Vec3;
using Tet = std::array<int, 4>;
using Face = std::array<int, 3>;
using Middles = std::array<int, 6>;

/// The two corners of every edge of a tet, edges in VTK's order of the middle nodes.
inline constexpr std::array<std::array<std::size_t, 2>, 6> tet_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// A physical group of boundary or interior triangles.
struct SurfaceGroup
{
  std::string name;
  std::vector<Face> faces;        ///< corners; after `judge` each face is of a tet and listed once
  std::vector<long long> tags{};  ///< of the triangles, only while the mesh is being read
  std::vector<long long> strays{};  ///< tags of triangles that are no face of a tet
};

/// A physical group of points or of curves.
struct PointGroup
{
  std::string name;
  std::vector<int> nodes;                 ///< the points, or the corner nodes on the curves
  std::vector<std::array<int, 2>> edges;  ///< end corners of every edge of the curves
};

/// The reference mesh, whole and identical on every rank. Fields and matrices are distributed, the
/// geometry is not: 1e6 tets take 40 MB. So every rank can compute the needle path from the same
/// numbers, without communication, and ties are decided alike on all ranks.
struct Mesh
{
  std::string file;                  ///< of several files their names, between commas
  std::string hash;                  ///< FNV-1a of the file's bytes
  double unit = 1.0;                 ///< length unit of the file's coordinates [m]
  std::vector<Vec3> x;               ///< reference positions [m], by ascending Gmsh node tag
  std::vector<Tet> tets;             ///< corners, positively oriented; by ascending tet tag
  std::vector<Middles> middles;      ///< middle nodes of the edges `tet_edges`; empty: linear tets
  std::vector<int> region;           ///< per tet, index into `volumes`
  std::vector<std::string> volumes;  ///< names of the physical volumes, in tag order
  std::vector<std::string> file_of;  ///< file of every volume
  std::vector<SurfaceGroup> surfaces;
  std::vector<PointGroup> points;
  std::vector<long long> node_tag, elem_tag;
  std::vector<std::string> remarks;  ///< warnings about the mesh for the user, logged

  int node_count() const { return static_cast<int>(x.size()); }
  int tet_count() const { return static_cast<int>(tets.size()); }
  bool quadratic() const { return !middles.empty(); }
  int nodes_per_tet() const { return quadratic() ? 10 : 4; }
  /// Node in the middle of the edge between two corners of a tet. Quadratic meshes only.
  int middle_of(int a, int b) const { return middle_of_edge.at(edge_key(a, b)); }
  bool has_edge(int a, int b) const { return middle_of_edge.count(edge_key(a, b)) > 0; }
  /// Rebuilds the index of `middle_of` and `has_edge` from `middles`.
  void index_middles();

 private:
  static std::uint64_t edge_key(int a, int b)
  {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
  }
  std::unordered_map<std::uint64_t, int> middle_of_edge;
};

/// Signed volume [m³] of the tet with corners a, b, c, d.
double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// Signed volume [m³] of a tet of the mesh; exact for curved edges too.
double tet_volume(const Mesh& mesh, int tet);
/// Signed volume [m³] of the straight tet between the corners of a tet of the mesh.
double corner_volume(const Mesh& mesh, int tet);

/// Barycentric coordinates (sum 1) of p in the tet with the given corners.
Eigen::Vector4d barycentric(const std::array<Vec3, 4>& corner, const Vec3& p);

std::array<Vec3, 4> corners(const Mesh& mesh, int tet);

/// Mean length of the six edges [m].
double mean_edge(const std::array<Vec3, 4>& corner);

/// Length of the longest edge [m].
double longest_edge(const std::array<Vec3, 4>& corner);

/// Nodes of a physical surface, curve or point group, sorted. Failure (65) when there is no such
/// group, when none of its points is on a tet, or as for `surface_group`.
std::vector<int> group_nodes(const Mesh& mesh, const std::string& name);

/// The physical surface of that name. Failure (65) when there is none (the message suggests the
/// nearest name), or when some of its triangles are no face of a tet (the message lists their
/// tags).
const SurfaceGroup& surface_group(const Mesh& mesh, const std::string& name);

/// Copies the mesh of rank 0 to every rank. Collective.
void broadcast(Mesh& mesh, const base::Comm& comm);

/// Refuses what no later stage can use: no tets, a coordinate that is not finite, a flat, inverted
/// or folded tet, an edge with two middle nodes. Failure (65) with the tag of the node or tet.
void validate(const Mesh& mesh);

/// Figures of the quality report. The quality of a tet is 6√2 V / (rms edge)³, 1 for a regular tet.
/// Quality and edge lengths of a curved tet are those of the straight tet between its corners.
struct Quality
{
  double smallest = 0, mean = 0;
  long long worst_tag = 0;
  double volume = 0;                           ///< of the mesh [m³], curved edges included
  double shortest_edge = 0, longest_edge = 0;  ///< [m]
};
Quality quality(const Mesh& mesh);

}  // namespace trocar::mesh
