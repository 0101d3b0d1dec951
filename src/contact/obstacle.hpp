#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/csv.hpp"
#include "core/math.hpp"
#include "mesh/skin.hpp"

namespace trocar::contact {

using core::Vec3;

/// A rigid body: the half space below a plane, a ball, a long cylinder, or what a surface encloses.
/// It may move along a path without turning.
struct Obstacle
{
  enum class Shape { plane, sphere, cylinder, surface };
  std::string name;
  Shape shape = Shape::plane;
  Vec3 origin = Vec3::Zero();       ///< a point of the plane or of the axis, the ball's middle [m]
  Vec3 normal = Vec3::UnitZ();      ///< out of the half space; along the cylinder's axis
  double radius = 0.0;              ///< of ball and cylinder [m]
  std::optional<core::Csv> path{};  ///< columns time [s], and its displacement x, y, z [m]

  std::shared_ptr<const mesh::Skin> skin{};  ///< of shape `surface`; `origin` is added to it

  Vec3 moved(double t) const;  ///< displacement at a time [m]
};

/// Distance of x from the surface of a shape other than `surface` where the obstacle has not moved,
/// negative inside [m], and its gradient: the way out.
struct Clearance
{
  double distance;
  Vec3 outward;
};
Clearance clearance(const Obstacle& obstacle, const Vec3& x);

}  // namespace trocar::contact
