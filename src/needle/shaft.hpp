#pragma once

#include <utility>
#include <vector>

#include "core/math.hpp"

namespace trocar::needle {

using core::Mat3;
using core::Vec3;

/// The needle's shape: a chain of nodes with frames, the first column along the shaft. Between
/// nodes the axis is the cubic with the nodes' positions and tangents: C1 along the needle.
struct Shaft
{
  double length = 0.0;  ///< at rest [m]
  std::vector<Vec3> x;  ///< nodes from base to tip [m]
  std::vector<Mat3> R;  ///< their frames
  double bevel = 0.0;   ///< lateral over axial force of the tip's face, along its frame's 2nd axis

  int elements() const { return static_cast<int>(x.size()) - 1; }
  double element_length() const { return length / elements(); }
  const Vec3& tip() const { return x.back(); }

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("length", "m", self.length);
    v("node", "m", self.x);
    v("frame", "1", self.R);
    v("bevel", "1", self.bevel);
  }
};

/// A place on the shaft: arc length s from the base at rest [m], position, unit tangent and two
/// unit normals.
struct ShaftPoint
{
  double s;
  Vec3 x, tangent, normal_1, normal_2;
};

/// The place at arc length s; beyond the ends the end tangents go on.
ShaftPoint shaft_at(const Shaft& shaft, double s);

/// The place nearest to p, on the shaft or on its tangent beyond the tip (s > length): a point the
/// tip has just left keeps a smooth gap until it is dropped.
ShaftPoint project(const Shaft& shaft, const Vec3& p);

/// d · δx(s) as a sum over nodal increments (δx, δθ), dof 6 i + k of node i: the row H_n of a
/// point at s in the direction d.
std::vector<std::pair<int, double>> jacobian(const Shaft& shaft, double s, const Vec3& d);

}  // namespace trocar::needle
