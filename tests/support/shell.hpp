#pragma once

#include "mesh/mesh.hpp"

namespace trocar::test {

/// Points and outward triangles of the unit sphere: an octahedron whose edges are halved `levels`
/// times.
struct SphereSurface
{
  std::vector<core::Vec3> point;
  std::vector<mesh::Face> face;
};
SphereSurface sphere_surface(int levels);

/// Tets between two radii around the origin: layers of a sphere's triangles, thicker outwards.
/// Surfaces "wall" and "outer"; points "on_x", "on_y", "on_z" where the axes meet the outer one.
mesh::Mesh shell(int levels, int layers, double inner, double outer);

/// Makes a mesh around the origin quadratic, with the middle of every edge at the mean distance of
/// its ends: faces of spheres become round.
void make_round(mesh::Mesh& mesh);

/// The same around the z axis, `height` high: surfaces "wall", "outer", "ends"; points "on_x",
/// "on_y" along the outer surface.
mesh::Mesh tube(int around, int along, int layers, double inner, double outer, double height);

}  // namespace trocar::test
