#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>

#include "mesh/quadratic.hpp"
#include "mesh/soundness.hpp"

namespace trocar::mesh {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Entry = std::pair<Box, int>;
using Corners = std::array<Vec3, 4>;

/// Largest number of pairs of tets to test: `least_pairs`, plus `most_per_tet` for each boundary
/// tet. A mesh needs some tens for each boundary tet; n tets at one place would need n² in all.
constexpr long long most_per_tet = 200, least_pairs = 1'000'000;

/// Overlap, as a fraction of the longest edge, that rounding of coordinates may cause.
constexpr double touching = 1e-9;

Box box_of(const Corners& x)
{
  const Vec3 low = x[0].cwiseMin(x[1]).cwiseMin(x[2]).cwiseMin(x[3]);
  const Vec3 high = x[0].cwiseMax(x[1]).cwiseMax(x[2]).cwiseMax(x[3]);
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

/// Overlap of the projections of two tets onto a unit axis [m], negative when they are apart.
double shadow(const Corners& a, const Corners& b, const Vec3& axis)
{
  constexpr double far = std::numeric_limits<double>::max();
  double a_low = far, a_high = -far, b_low = far, b_high = -far;
  for (std::size_t k = 0; k < 4; ++k) {
    const double on_a = axis.dot(a[k]), on_b = axis.dot(b[k]);
    a_low = std::min(a_low, on_a);
    a_high = std::max(a_high, on_a);
    b_low = std::min(b_low, on_b);
    b_high = std::max(b_high, on_b);
  }
  return std::min(a_high - b_low, b_high - a_low);
}

/// Largest distance of a middle node of the tet from the midpoint of its edge's chord [m]. The
/// straight tets of a curved mesh may overlap by this much where the curved tets do not.
double sagitta(const Mesh& mesh, int tet)
{
  if (!mesh.quadratic()) return 0.0;
  double most = 0.0;
  const TetPositions x = positions(mesh, tet);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto a = static_cast<Eigen::Index>(tet_edges[k][0]),
               b = static_cast<Eigen::Index>(tet_edges[k][1]);
    const Vec3 off = x.col(static_cast<Eigen::Index>(k) + 4) - 0.5 * (x.col(a) + x.col(b));
    most = std::max(most, off.norm());
  }
  return most;
}

}  // namespace

// Separating axis theorem: of two convex polyhedra that do not overlap, the projections onto the
// normal of some face, or onto the cross product of two edges, do not overlap.
double overlap_depth(const Corners& a, const Corners& b)
{
  const double least = touching * std::max(longest_edge(a), longest_edge(b));
  const Vec3 origin = a[0];  // near both tets: less rounding in the projections
  Corners p = a, q = b;
  for (std::size_t k = 0; k < 4; ++k) {
    p[k] -= origin;
    q[k] -= origin;
  }
  double depth = std::numeric_limits<double>::max();
  const auto separates = [&](const Vec3& axis) {
    const double length = axis.norm();
    if (length == 0.0) return false;
    depth = std::min(depth, shadow(p, q, axis / length));
    return depth <= least;
  };
  for (const Corners* x : {&p, &q})
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 &from = (*x)[(k + 1) % 4], &to = (*x)[(k + 2) % 4], &on = (*x)[(k + 3) % 4];
      if (separates((to - from).cross(on - from))) return 0.0;
    }
  for (const auto& [a0, a1] : tet_edges)
    for (const auto& [b0, b1] : tet_edges) {
      const Vec3 along = p[a1] - p[a0], across = q[b1] - q[b0];
      const Vec3 axis = along.cross(across);
      if (axis.squaredNorm() <= 1e-20 * along.squaredNorm() * across.squaredNorm()) continue;
      if (separates(axis)) return 0.0;
    }
  return depth;
}

Overlap find_overlap(const Mesh& mesh, const std::vector<int>& boundary,
                     const std::vector<int>& part)
{
  std::vector<Entry> entries;
  entries.reserve(boundary.size());
  for (int tet : boundary) entries.emplace_back(box_of(corners(mesh, tet)), tet);
  const bg::index::rtree<Entry, bg::index::quadratic<16>> tree(entries.begin(), entries.end());
  const auto part_of = [&](int tet) {
    return part[static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(tet)][0])];
  };
  Overlap found;
  const long long most_pairs = least_pairs + most_per_tet * static_cast<long long>(entries.size());
  long long looked_at = 0;
  for (const auto& [box, tet] : entries) {
    const Corners x = corners(mesh, tet);
    for (auto at = tree.qbegin(bg::index::intersects(box)); at != tree.qend(); ++at) {
      const int other = at->second;
      if (++looked_at > most_pairs) {
        found.whole = false;
        return found;
      }
      if (other <= tet) continue;
      const double depth = overlap_depth(x, corners(mesh, other));
      if (depth <= sagitta(mesh, tet) + sagitta(mesh, other)) continue;
      if (part_of(tet) != part_of(other)) {
        ++found.between_parts;
        found.depth = std::max(found.depth, depth);
      } else if (found.tets[0] < 0 || std::array<int, 2>{tet, other} < found.tets) {
        found.tets = {tet, other};
      }
    }
  }
  return found;
}

}  // namespace trocar::mesh
