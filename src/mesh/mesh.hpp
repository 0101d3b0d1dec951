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

/// Edges of a tet by its corners, in VTK's order of the middle nodes.
inline constexpr std::array<std::array<std::size_t, 2>, 6> tet_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// A physical group of boundary or interior triangles.
struct SurfaceGroup
{
  std::string name;
  std::vector<Face> faces;          ///< by their corners; each is one of a tet, and there once
  std::vector<long long> tags{};    ///< of the triangles, as long as the mesh is being read
  std::vector<long long> strays{};  ///< tags of triangles that are no face of a tet
};

/// A physical group of points, or of curves by their edges.
struct PointGroup
{
  std::string name;
  std::vector<int> nodes;                 ///< points, and corners of the tets on curves
  std::vector<std::array<int, 2>> edges;  ///< of curves, by their corners
};

/// The reference mesh, whole and identical on every rank. Fields and matrices are distributed;
/// the geometry is not: at 1e6 tets it is 40 MB, and the needle path can then be computed by
/// every rank from the same numbers, without communication and without ties between ranks.
struct Mesh
{
  std::string file;
  std::string hash;              ///< FNV-1a of the file's bytes
  double unit = 1.0;             ///< of the file's coordinates [m]
  std::vector<Vec3> x;           ///< [m], reference; row i = i-th smallest Gmsh node tag
  std::vector<Tet> tets;         ///< corners, positively oriented; row i = i-th smallest tet tag
  std::vector<Middles> middles;  ///< nodes on the edges `tet_edges`; empty: linear tets
  std::vector<int> region;       ///< per tet, index into `volumes`
  std::vector<std::string> volumes;  ///< names of the physical volumes, in tag order
  std::vector<SurfaceGroup> surfaces;
  std::vector<PointGroup> points;
  std::vector<long long> node_tag, elem_tag;
  std::vector<std::string> remarks;  ///< what its user should know of it

  int node_count() const { return static_cast<int>(x.size()); }
  int tet_count() const { return static_cast<int>(tets.size()); }
  bool quadratic() const { return !middles.empty(); }
  int nodes_per_tet() const { return quadratic() ? 10 : 4; }
  /// Node in the middle of the edge between two corners of a tet. Quadratic meshes only.
  int middle_of(int a, int b) const { return middle_of_edge.at(edge_key(a, b)); }
  bool has_edge(int a, int b) const { return middle_of_edge.count(edge_key(a, b)) > 0; }
  /// Makes these two know `middles`.
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
/// Volume [m³] of a tet of the mesh, its edges as curved as they are: exact.
double tet_volume(const Mesh& mesh, int tet);
/// Signed volume [m³] of the straight tet between its corners.
double corner_volume(const Mesh& mesh, int tet);

/// Barycentric coordinates (sum 1) of p in the tet with the given corners.
Eigen::Vector4d barycentric(const std::array<Vec3, 4>& corner, const Vec3& p);

std::array<Vec3, 4> corners(const Mesh& mesh, int tet);

/// Mean of the six edges [m].
double mean_edge(const std::array<Vec3, 4>& corner);

/// Longest edge [m].
double longest_edge(const std::array<Vec3, 4>& corner);

/// Nodes of a physical surface or point group, sorted; Failure (65) when there is no such group,
/// or none of its points is on a tet.
std::vector<int> group_nodes(const Mesh& mesh, const std::string& name);

/// The physical surface of that name; Failure (65) naming the nearest one, or tags of triangles in
/// it that are no face of a tet.
const SurfaceGroup& surface_group(const Mesh& mesh, const std::string& name);

/// Root's mesh on every rank. Collective.
void broadcast(Mesh& mesh, const base::Comm& comm);

/// Refuses what no later stage can use: no tets, non-finite coordinates, flat or inverted tets,
/// nodes without volume. Throws Failure (65) naming the element tag.
void validate(const Mesh& mesh);

/// Figures of the quality report. quality = 6√2 V / (rms edge)³, 1 for a regular tet; of curved
/// tets that of the straight ones between their corners, edges likewise.
struct Quality
{
  double smallest = 0, mean = 0;
  long long worst_tag = 0;
  double volume = 0;                           ///< [m³], curved where the edges are
  double shortest_edge = 0, longest_edge = 0;  ///< [m]
};
Quality quality(const Mesh& mesh);

}  // namespace trocar::mesh
