#include "contact/clip.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::contact {
namespace {

using Vec2 = Eigen::Vector2d;
using Flat = std::array<Vec2, 3>;

double cross(const Vec2& a, const Vec2& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// The part of a polygon left of the line from p to q.
std::vector<Vec2> left_of(const std::vector<Vec2>& polygon, const Vec2& p, const Vec2& q)
{
  std::vector<Vec2> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &x = polygon[i], &y = polygon[(i + 1) % polygon.size()];
    const double at_x = cross(q - p, x - p), at_y = cross(q - p, y - p);
    if (at_x >= 0.0) kept.push_back(x);
    if ((at_x > 0.0 && at_y < 0.0) || (at_x < 0.0 && at_y > 0.0))
      kept.push_back(x + at_x / (at_x - at_y) * (y - x));
  }
  return kept;
}

Eigen::Vector3d barycentric(const Flat& corner, const Vec2& x)
{
  const Vec2 a = corner[1] - corner[0], b = corner[2] - corner[0], r = x - corner[0];
  const double area = cross(a, b);
  const double one = cross(r, b) / area, two = cross(a, r) / area;
  return {1.0 - one - two, one, two};
}

}  // namespace

std::vector<Overlap> overlap(const Triangle& slave, const Triangle& master, double search)
{
  constexpr double facing = -0.2, least = 1e-14;
  const Vec3 along = slave[1] - slave[0];
  const Vec3 doubled = along.cross(slave[2] - slave[0]);
  const Vec3 n = doubled.normalized(), e = along.normalized(), f = n.cross(e);
  if (n.dot((master[1] - master[0]).cross(master[2] - master[0]).normalized()) > facing) return {};
  const auto flat = [&](const Vec3& x) { return Vec2(e.dot(x - slave[0]), f.dot(x - slave[0])); };
  Eigen::Vector3d height;
  Flat from, onto;
  for (std::size_t k = 0; k < 3; ++k) {
    onto[k] = flat(slave[k]);
    from[k] = flat(master[k]);
    height[static_cast<Eigen::Index>(k)] = n.dot(master[k] - slave[0]);
  }
  if (height.minCoeff() > search || height.maxCoeff() < -search) return {};
  std::vector<Vec2> polygon{from[0], from[2], from[1]};  // the master faces the slave
  for (std::size_t k = 0; k < 3 && polygon.size() > 2; ++k)
    polygon = left_of(polygon, onto[k], onto[(k + 1) % 3]);
  std::vector<Overlap> pieces;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const double area = 0.5 * cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    if (area <= least * doubled.norm()) continue;
    Overlap piece{{}, {}, area};
    for (Eigen::Index c = 0; c < 3; ++c) {
      const Vec2& x = polygon[c == 0 ? 0 : k + static_cast<std::size_t>(c) - 1];
      piece.slave.col(c) = barycentric(onto, x);
      piece.master.col(c) = barycentric(from, x);
    }
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace trocar::contact
