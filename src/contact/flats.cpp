#include "contact/flats.hpp"

namespace trocar::contact {
namespace {

/// From the coordinates of its file to where an obstacle is at time t [m].
Vec3 shift_of(const Obstacle& obstacle, double t)
{
  return obstacle.origin + obstacle.moved(t);
}

}  // namespace

std::vector<Flat> flats(const Surface& surface, const Deformation& now)
{
  std::vector<Flat> all;
  const int count = surface.nodes_per_face();
  for (int f = 0; f < surface.faces(); ++f) {
    const FacePlaces face = surface.places(f, now);
    for (int k = 0; k < flat_count(count); ++k) {
      const std::array<std::size_t, 3> node = count == 3
                                                  ? std::array<std::size_t, 3>{0, 1, 2}
                                                  : flat_triangles()[static_cast<std::size_t>(k)];
      all.push_back({f, node, {face.x[node[0]], face.x[node[1]], face.x[node[2]]}});
    }
  }
  return all;
}

std::vector<Flat> flats(const Obstacle& obstacle, double t)
{
  std::vector<Flat> all;
  const Vec3 by = shift_of(obstacle, t);
  for (std::size_t f = 0; f < obstacle.skin->faces.size(); ++f) {
    Triangle at = obstacle.skin->triangle(f);
    for (Vec3& x : at) x += by;
    all.push_back({static_cast<int>(f), {0, 1, 2}, at});
  }
  return all;
}

Bounds bounds_of(const Obstacle& obstacle, double t)
{
  Bounds bounds;
  const Vec3 by = shift_of(obstacle, t);
  for (const Vec3& x : obstacle.skin->x) bounds.add(x + by);
  return bounds;
}

Bounds bounds_of(const Surface& surface, const Deformation& now)
{
  Bounds bounds;
  for (int f = 0; f < surface.faces(); ++f) {
    const FacePlaces face = surface.places(f, now);
    for (std::size_t k = 0; k < static_cast<std::size_t>(face.count); ++k) bounds.add(face.x[k]);
  }
  return bounds;
}

}  // namespace trocar::contact
