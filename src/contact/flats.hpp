#pragma once

#include <boost/geometry.hpp>
#include <limits>
#include <vector>

#include "contact/clip.hpp"
#include "contact/obstacle.hpp"
#include "contact/surface.hpp"

// The flat triangles that stand for faces in clipping, and boxes around them.
namespace trocar::contact {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;

struct Bounds
{
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;

  void add(const Vec3& x)
  {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  Box grown(double by) const
  {
    return {Point(low.x() - by, low.y() - by, low.z() - by),
            Point(high.x() + by, high.y() + by, high.z() + by)};
  }
};

/// A flat triangle of a face.
struct Flat
{
  int face;
  std::array<std::size_t, 3> node;  ///< local nodes of the face
  Triangle x;

  Bounds bounds() const
  {
    Bounds bounds;
    for (const Vec3& corner : x) bounds.add(corner);
    return bounds;
  }
  /// Parameters on the face of a place with these barycentric coordinates in the triangle.
  Param param(const Eigen::Vector3d& at) const
  {
    Param sum = Param::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      sum += at[static_cast<Eigen::Index>(k)] * node_param(node[k]);
    return sum;
  }
};

std::vector<Flat> flats(const Surface& surface, const Deformation& now);
/// Those of an obstacle of shape `surface`, where it is at time t.
std::vector<Flat> flats(const Obstacle& obstacle, double t);

/// Box around a surface.
Bounds bounds_of(const Surface& surface, const Deformation& now);
Bounds bounds_of(const Obstacle& obstacle, double t);

}  // namespace trocar::contact
