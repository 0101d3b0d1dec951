#pragma once

#include <utility>
#include <vector>

#include "core/math.hpp"

namespace trocar::needle {

using core::Mat3;
using core::Vec3;

/// The needle's shape: nodes with frames, whose first column is the tangent of the shaft. Between
/// two nodes the axis is the Hermite cubic of their positions and tangents, so the axis is C1.
struct Shaft
{
  double length = 0.0;  ///< length at rest [m]
  double radius = 0.0;  ///< outer radius [m]
  std::vector<Vec3> x;  ///< positions of the nodes from base to tip [m]
  std::vector<Mat3> R;  ///< frames of the nodes
  /// cot ψ, the ratio of lateral to axial force on the tip's face; 0: symmetric tip. The lateral
  /// force acts along the second column of the tip's frame.
  double bevel = 0.0;

  int elements() const { return static_cast<int>(x.size()) - 1; }
  double element_length() const { return length / elements(); }
  const Vec3& tip() const { return x.back(); }

  /// Names every member and its unit, see core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("length", "m", self.length);
    v("radius", "m", self.radius);
    v("node", "m", self.x);
    v("frame", "1", self.R);
    v("bevel", "1", self.bevel);
  }
};

/// A point on the shaft: arc length s from the base in the undeformed needle [m], position [m],
/// unit tangent and two unit normals.
struct ShaftPoint
{
  double s;
  Vec3 x, tangent, normal_1, normal_2;
};

/// The point at arc length s. Beyond either end the shaft is continued along its end tangent.
ShaftPoint shaft_at(const Shaft& shaft, double s);

/// The point nearest to p on the shaft or on its tangent beyond the tip (s > length). The tangent
/// keeps the gap of a coupling point smooth after the tip has left it, until the point is dropped.
ShaftPoint project(const Shaft& shaft, const Vec3& p);

/// The row H_n of the shaft point at s in the direction d: pairs (dof, coefficient) that give
/// d · δx(s) from the nodal increments (δx, δθ). Dofs 6 i to 6 i + 5 belong to node i.
std::vector<std::pair<int, double>> jacobian(const Shaft& shaft, double s, const Vec3& d);

}  // namespace trocar::needle
