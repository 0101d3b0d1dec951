#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "law/problem.hpp"
#include "law/second_order_cone.hpp"

// Ends of intervals and friction cones as an interior point method sees them.
namespace trocar::law {

using core::Vec3;

/// One end of an interval: side · (λ - end) >= 0.
struct End
{
  int row;
  double side, end;  ///< 1 and the lower end, -1 and the upper end [N]
};

/// A cone of rows first, first + 1, first + 2. Its force is r = (μ λ_n, λ_t), its gap
/// v = ((δ_n + μ|δ_t|)/μ, δ_t); both lie in the second-order cone and r ∘ v = 0.
struct Cone
{
  int first;
  double friction;

  Vec3 scale() const { return {friction, 1.0, 1.0}; }
};

/// The iterate. Forces of ends and cones follow from λ.
struct Point
{
  VecX lambda;
  VecX z;               ///< gaps of the ends [m]
  std::vector<Vec3> v;  ///< gaps of the cones, scaled [m]
};

/// All inequalities of a problem.
struct Inside
{
  std::vector<End> ends{};
  std::vector<std::pair<int, double>> middles{};  ///< rows between two ends, and the middle [N]
  std::vector<Cone> cones{};

  std::size_t count() const { return ends.size() + cones.size(); }

  void add_ends(const Block& block)
  {
    const double lower = block.law.lower, upper = block.law.upper;
    if (std::isfinite(lower)) ends.push_back({block.first, 1.0, lower});
    if (std::isfinite(upper)) ends.push_back({block.first, -1.0, upper});
    if (std::isfinite(lower) && std::isfinite(upper))
      middles.emplace_back(block.first, 0.5 * (lower + upper));
  }

  Vec3 force(const Cone& cone, const VecX& lambda) const
  {
    return cone.scale().cwiseProduct(lambda.segment<3>(cone.first));
  }
  double room(const End& end, const VecX& lambda) const
  {
    return end.side * (lambda[end.row] - end.end);
  }

  /// Σ force · gap of all inequalities [N m].
  double products(const Point& p) const
  {
    double sum = 0.0;
    for (std::size_t k = 0; k < ends.size(); ++k)
      sum += room(ends[k], p.lambda) * p.z[static_cast<Eigen::Index>(k)];
    for (std::size_t k = 0; k < cones.size(); ++k) sum += force(cones[k], p.lambda).dot(p.v[k]);
    return sum;
  }

  /// Smallest product of one inequality, comparable with the mean of all.
  double least_product(const Point& p) const
  {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < ends.size(); ++k)
      least = std::min(least, room(ends[k], p.lambda) * p.z[static_cast<Eigen::Index>(k)]);
    for (std::size_t k = 0; k < cones.size(); ++k)
      least = std::min(least, cone::root(force(cones[k], p.lambda)) * cone::root(p.v[k]));
    return least;
  }

  /// Longest step, at most 1, that stays inside.
  double longest(const Point& at, const Point& d) const
  {
    constexpr double part = 0.95;
    double step = 1.0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double change = ends[k].side * d.lambda[ends[k].row];
      if (change < 0.0) step = std::min(step, -part * room(ends[k], at.lambda) / change);
      if (d.z[i] < 0.0) step = std::min(step, -part * at.z[i] / d.z[i]);
    }
    for (std::size_t k = 0; k < cones.size(); ++k) {
      const Vec3 r = force(cones[k], at.lambda), dr = force(cones[k], d.lambda);
      step = std::min(step, part * cone::step_to_border(r, dr));
      step = std::min(step, part * cone::step_to_border(at.v[k], d.v[k]));
    }
    return step;
  }
};

}  // namespace trocar::law
