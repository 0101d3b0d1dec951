#include "driver/pv_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/dense.hpp"
#include "core/words.hpp"

namespace trocar::driver {
namespace {

using core::MatX;
using core::VecX;

struct Point
{
  double ratio, pressure;
};

constexpr int most_halvings = 8;

/// Takes the state to a volume, in halves of the way when it is not reached at once.
State at_ratio(Simulation& simulation, State from, double before, double ratio, int halvings,
               StepReport& report)
{
  const int cavity = simulation.scenario().pv.cavity;
  const double V0 = simulation.cavities()->wall(cavity).volume();
  simulation.cavities()->hold_volume(cavity, ratio * V0, from.cavities);
  // Time stands still: beyond the start, so that loads act whole, but of no length.
  const core::TimeStep now{1e-300, 0.0, true};
  StepResult result = simulation.step(from, now);
  if (result.state) {
    report = result.report;
    return std::move(*result.state);
  }
  ++simulation.ledger().rejected_steps;
  if (halvings == most_halvings)
    throw core::solver_error("P-V curve, volume ratio " + core::shown(ratio) + ": " + result.why);
  const double middle = 0.5 * (before + ratio);
  State half = at_ratio(simulation, std::move(from), before, middle, halvings + 1, report);
  return at_ratio(simulation, std::move(half), middle, ratio, halvings + 1, report);
}

/// Least squares of p over hat functions between equally spaced ratios: straight pieces that hang
/// together. One piece is a straight line.
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

/// Curve and fits into run.h5, slope and R² of the line into the log.
void write(const Simulation& simulation, Recorder& recorder, const Log& log,
           const std::vector<Point>& points)
{
  std::vector<double> ratio, pressure;
  for (const Point& point : points) {
    ratio.push_back(point.ratio);
    pressure.push_back(point.pressure);
  }
  const VecX line = straight_pieces(points, 1);
  const VecX pieces = straight_pieces(points, simulation.scenario().pv.pieces);
  const Eigen::Map<const VecX> p(pressure.data(), static_cast<Eigen::Index>(pressure.size()));
  const double slope = (line[line.size() - 1] - line[0]) / (ratio.back() - ratio.front());
  const double spread = (p.array() - p.mean()).square().sum();
  const double R2 = spread > 0.0 ? 1.0 - (p - line).squaredNorm() / spread : 0.0;
  const auto list = [](const VecX& v) {
    return std::vector<double>(v.data(), v.data() + v.size());
  };
  recorder.table(simulation, "/pv_curve/volume_ratio", ratio, "1");
  recorder.table(simulation, "/pv_curve/pressure", pressure, "Pa");
  recorder.table(simulation, "/pv_curve/line", list(line), "Pa");
  recorder.table(simulation, "/pv_curve/pieces", list(pieces), "Pa");
  recorder.table(simulation, "/pv_curve/slope", {slope}, "Pa");
  recorder.table(simulation, "/pv_curve/r_squared", {R2}, "1");
  log.note("P-V curve: slope K_p = " + core::shown(slope) + " Pa, R^2 = " + core::shown(R2));
}

}  // namespace

State run_pv_curve(Simulation& simulation, Recorder& recorder, Log& log, const State& start)
{
  const PvSettings& pv = simulation.scenario().pv;
  std::vector<Point> points;
  int number = 0;
  const cavity::Cavities& cavities = *simulation.cavities();
  const double started = cavities.volumes(cavities.shape(start.tissue.u))[pv.cavity] /
                         cavities.wall(pv.cavity).volume();
  const auto sweep = [&](bool up) {
    State state = start;
    double before = started;
    for (int k = 0; k < pv.points; ++k) {
      const int from_low = up ? k : pv.points - 1 - k;
      const double ratio = pv.low + (pv.high - pv.low) * from_low / (pv.points - 1);
      if (up ? ratio <= 1.0 : ratio > 1.0) continue;
      const core::Stopwatch watch;
      StepReport report;
      state = at_ratio(simulation, std::move(state), before, ratio, 0, report);
      before = ratio;
      ++simulation.ledger().steps;
      State shown = state;
      shown.t = static_cast<double>(++number);
      recorder.record(simulation, shown, report, number,
                      simulation.space().comm().max(watch.seconds()), true);
      log.step(number, shown, report);
      points.push_back({ratio, report.cavities[static_cast<std::size_t>(pv.cavity)].pressure});
    }
    return state;
  };
  sweep(false);
  std::reverse(points.begin(), points.end());
  State end = sweep(true);
  write(simulation, recorder, log, points);
  return end;
}

}  // namespace trocar::driver
