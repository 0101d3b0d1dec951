#include "post/pv_curve.hpp"

#include <algorithm>
#include <cmath>

#include "core/dense.hpp"
#include "core/stopwatch.hpp"
#include "core/words.hpp"

namespace trocar::post {
namespace {

using core::MatX;
using core::VecX;
using step::Model;
using step::State;

struct Point
{
  double ratio, pressure;
};

constexpr int most_halvings = 8;

double undeformed_volume(const Model& model, int cavity)
{
  return model.cavities->wall(cavity).volume();
}

/// Equilibrium at the volume ratio `ratio`, from a state at the ratio `before`. A change of volume
/// that fails is retried as two halves, and so is each half. Throws Failure (70) after 8 halvings.
step::Outcome<step::Accepted> at_ratio(Model& model, int cavity, State from, double before,
                                       double ratio, int halvings)
{
  const double V0 = undeformed_volume(model, cavity);
  cavity::hold_volume(cavity, ratio * V0, from.cavities);
  const core::TimeStep no_time{0.0, 0.0, true};
  step::Outcome<step::Accepted> result = step::advance(model, from, no_time);
  if (result) return result;
  ++model.ledger.rejected_steps;
  if (halvings == most_halvings)
    throw core::solver_error("P-V curve, volume ratio " + core::shown(ratio) + ": " + result.why());
  const double middle = 0.5 * (before + ratio);
  step::Outcome<step::Accepted> half =
      at_ratio(model, cavity, std::move(from), before, middle, halvings + 1);
  return at_ratio(model, cavity, std::move(half->state), middle, ratio, halvings + 1);
}

/// Least-squares fit of p by a continuous function of the ratio with straight pieces of equal
/// width. Returns its values at the points [Pa]. One piece is a straight line.
VecX straight_pieces(const std::vector<Point>& points, int pieces)
{
  const auto count = static_cast<Eigen::Index>(points.size());
  const double low = points.front().ratio, width = (points.back().ratio - low) / pieces;
  MatX hats = MatX::Zero(count, pieces + 1);
  VecX p(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Point& point = points[static_cast<std::size_t>(i)];
    const double at = (point.ratio - low) / width;
    const int piece = std::min(static_cast<int>(at), pieces - 1);
    hats(i, piece) = 1.0 - (at - piece);
    hats(i, piece + 1) = at - piece;
    p[i] = point.pressure;
  }
  return hats * core::least_squares(hats, p);
}

PvCurve fitted(const std::vector<Point>& points, int pieces)
{
  PvCurve curve;
  for (const Point& point : points) {
    curve.ratio.push_back(point.ratio);
    curve.pressure.push_back(point.pressure);
  }
  const VecX line = straight_pieces(points, 1);
  const VecX in_pieces = straight_pieces(points, pieces);
  curve.line.assign(line.begin(), line.end());
  curve.pieces.assign(in_pieces.begin(), in_pieces.end());
  const Eigen::Map<const VecX> p(curve.pressure.data(),
                                 static_cast<Eigen::Index>(curve.pressure.size()));
  curve.slope = (line[line.size() - 1] - line[0]) / (curve.ratio.back() - curve.ratio.front());
  const double spread = (p.array() - p.mean()).square().sum();
  curve.r_squared = spread > 0.0 ? 1.0 - (p - line).squaredNorm() / spread : 0.0;
  return curve;
}

}  // namespace

PvSweep sweep_volume(Model& model, const PvSettings& settings, const State& start,
                     step::Observer& observer)
{
  std::vector<Point> points;
  step::Progress at;
  const cavity::Cavities& cavities = *model.cavities;
  const double started = cavities.volumes(cavities.shape(start.tissue.u))[settings.cavity] /
                         undeformed_volume(model, settings.cavity);
  const auto sweep = [&](bool up) {
    State state = start;
    double before = started;
    for (int k = 0; k < settings.points; ++k) {
      const int from_low = up ? k : settings.points - 1 - k;
      const double ratio =
          settings.low + (settings.high - settings.low) * from_low / (settings.points - 1);
      if (up ? ratio <= 1.0 : ratio > 1.0) continue;
      const core::Stopwatch watch;
      step::Outcome<step::Accepted> result =
          at_ratio(model, settings.cavity, std::move(state), before, ratio, 0);
      state = std::move(result->state);
      before = ratio;
      ++model.ledger.steps;
      at.nominal = ++at.accepted;
      at.seconds = model.space.comm().max(watch.seconds());
      State shown = state;
      shown.t = static_cast<double>(at.accepted);
      observer.accepted(shown, result->report, at);
      const auto cavity = static_cast<std::size_t>(settings.cavity);
      points.push_back({ratio, result->report.cavities[cavity].pressure});
    }
    return state;
  };
  sweep(false);
  std::reverse(points.begin(), points.end());
  State end = sweep(true);
  return {fitted(points, settings.pieces), std::move(end)};
}

}  // namespace trocar::post
