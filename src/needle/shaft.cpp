#include "needle/shaft.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar::needle {
namespace {

/// Element in which an arc length lies, and the local coordinate t in [0, 1] there.
struct Place
{
  std::size_t element;
  double t;
};

Place place_of(const Shaft& shaft, double s)
{
  const double scaled =
      std::clamp(s / shaft.element_length(), 0.0, static_cast<double>(shaft.elements()));
  const auto element =
      static_cast<std::size_t>(std::min(static_cast<int>(scaled), shaft.elements() - 1));
  return {element, scaled - static_cast<double>(element)};
}

/// Values of the four Hermite cubics of an element (position a, slope a, position b, slope b), or
/// of their first (`derivative`) or second (`curvature`) derivatives with respect to t.
struct Hermite
{
  double a, slope_a, b, slope_b;
};
Hermite value(double t)
{
  return {1 - 3 * t * t + 2 * t * t * t, t - 2 * t * t + t * t * t, 3 * t * t - 2 * t * t * t,
          t * t * t - t * t};
}
Hermite derivative(double t)
{
  return {-6 * t + 6 * t * t, 1 - 4 * t + 3 * t * t, 6 * t - 6 * t * t, 3 * t * t - 2 * t};
}
Hermite curvature(double t)
{
  return {-6 + 12 * t, -4 + 6 * t, 6 - 12 * t, 6 * t - 2};
}

Vec3 combine(const Shaft& shaft, std::size_t e, const Hermite& n)
{
  const double L = shaft.element_length();
  return n.a * shaft.x[e] + n.slope_a * L * shaft.R[e].col(0) + n.b * shaft.x[e + 1] +
         n.slope_b * L * shaft.R[e + 1].col(0);
}

/// Local coordinate of the point on one element's axis that is nearest to p. Newton's method starts
/// from the projection of p on the chord and stays in [0, 1].
double nearest_in_element(const Shaft& shaft, std::size_t e, const Vec3& p)
{
  const Vec3 chord = shaft.x[e + 1] - shaft.x[e];
  double t = std::clamp((p - shaft.x[e]).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
  for (int k = 0; k < 20; ++k) {
    const Vec3 away = combine(shaft, e, value(t)) - p;
    const Vec3 slope = combine(shaft, e, derivative(t));
    const double second = slope.squaredNorm() + away.dot(combine(shaft, e, curvature(t)));
    const double step = -away.dot(slope) / (second > 0.0 ? second : slope.squaredNorm());
    const double next = std::clamp(t + step, 0.0, 1.0);
    const double change = std::abs(next - t);
    t = next;
    if (change < 1e-15) break;
  }
  return t;
}

}  // namespace

ShaftPoint shaft_at(const Shaft& shaft, double s)
{
  const Place place = place_of(shaft, s);
  const std::size_t e = place.element;
  ShaftPoint point;
  point.s = s;
  point.tangent = combine(shaft, e, derivative(place.t)).normalized();
  const double beyond = s < 0.0 ? s : std::max(s - shaft.length, 0.0);
  point.x = combine(shaft, e, value(place.t)) + beyond * point.tangent;
  const Vec3 y = (1.0 - place.t) * shaft.R[e].col(1) + place.t * shaft.R[e + 1].col(1);
  point.normal_1 = (y - point.tangent * point.tangent.dot(y)).normalized();
  point.normal_2 = point.tangent.cross(point.normal_1);
  return point;
}

ShaftPoint project(const Shaft& shaft, const Vec3& p)
{
  double best = std::numeric_limits<double>::infinity();
  double s = 0.0;
  for (std::size_t e = 0; e + 1 < shaft.x.size(); ++e) {
    const double t = nearest_in_element(shaft, e, p);
    const double distance = (combine(shaft, e, value(t)) - p).squaredNorm();
    if (distance < best) {
      best = distance;
      s = (static_cast<double>(e) + t) * shaft.element_length();
    }
  }
  if (s >= shaft.length) s += std::max(0.0, (p - shaft.tip()).dot(shaft_at(shaft, s).tangent));
  return shaft_at(shaft, s);
}

std::vector<std::pair<int, double>> jacobian(const Shaft& shaft, double s, const Vec3& d)
{
  const Place place = place_of(shaft, s);
  const Hermite n = value(place.t);
  const double L = shaft.element_length();
  std::vector<std::pair<int, double>> entries;
  const auto add = [&](std::size_t node, double position, double slope) {
    const Vec3 turn = slope * L * shaft.R[node].col(0).cross(d);  // d·(δθ × t) = δθ·(t × d)
    for (int k = 0; k < 3; ++k) {
      entries.emplace_back(6 * static_cast<int>(node) + k, position * d[k]);
      entries.emplace_back(6 * static_cast<int>(node) + 3 + k, turn[k]);
    }
  };
  add(place.element, n.a, n.slope_a);
  add(place.element + 1, n.b, n.slope_b);
  if (s > shaft.length) {  // beyond the tip the point turns with the last node
    const Vec3 turn = (s - shaft.length) * shaft_at(shaft, shaft.length).tangent.cross(d);
    for (int k = 0; k < 3; ++k) entries.emplace_back(6 * shaft.elements() + 3 + k, turn[k]);
  }
  return entries;
}

}  // namespace trocar::needle
