#pragma once

#include <string>

#include "core/math.hpp"

namespace trocar::contact {

using core::Vec3;

/// A rigid body that does not move: the half space below a plane, a ball, or a long cylinder.
struct Obstacle
{
  enum class Shape { plane, sphere, cylinder };
  std::string name;
  Shape shape = Shape::plane;
  Vec3 origin = Vec3::Zero();   ///< a point of the plane or of the axis, the ball's middle [m]
  Vec3 normal = Vec3::UnitZ();  ///< out of the half space; along the cylinder's axis
  double radius = 0.0;          ///< of ball and cylinder [m]
};

/// Distance of x from the surface, negative inside [m], and its gradient: the way out.
struct Clearance
{
  double distance;
  Vec3 outward;
};
Clearance clearance(const Obstacle& obstacle, const Vec3& x);

}  // namespace trocar::contact
