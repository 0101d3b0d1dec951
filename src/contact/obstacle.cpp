#include "contact/obstacle.hpp"

namespace trocar::contact {

Vec3 Obstacle::moved(double t) const
{
  Vec3 by = Vec3::Zero();
  for (std::size_t axis = 0; path && axis < 3; ++axis)
    by[static_cast<Eigen::Index>(axis)] = core::interpolate(*path, axis + 1, t);
  return by;
}

Clearance clearance(const Obstacle& obstacle, const Vec3& x)
{
  const Vec3 axis = obstacle.normal.normalized();
  Vec3 from = x - obstacle.origin;
  if (obstacle.shape == Obstacle::Shape::plane) return {from.dot(axis), axis};
  if (obstacle.shape == Obstacle::Shape::cylinder) from -= axis.dot(from) * axis;
  const double far = from.norm();
  if (!(far > 0.0)) return {-obstacle.radius, axis.unitOrthogonal()};
  return {far - obstacle.radius, from / far};
}

}  // namespace trocar::contact
