#include <algorithm>
#include <cmath>
#include <limits>

#include "step/simulation.hpp"

// When a step has been linearised often enough, and what leads on when it has not.
namespace trocar::step {

/// Static equilibria and steps with pressures that follow the walls are iterated until everything
/// is balanced. A dynamic one is as many times as it was told to, or as it takes.
Simulation::Effort Simulation::effort_of(const core::TimeStep& now) const
{
  constexpr int most = 50;
  constexpr double automatic_first = 1e-3, automatic = 1e-6;
  const bool follows = cavities_ && cavities_->follows();
  const double tolerance = scene_.tissue.newton_tolerance;
  const bool bends = scene_.tissue.model != tissue::Model::linear;
  if (now.is_static || follows) return {most, 0.0, tolerance, true};
  const int told = scene_.time.newton_max;
  if (told > 1) return {told, 0.0, tolerance, true};
  const double any = std::numeric_limits<double>::max();  // but what is not finite
  if (told == 1 || !(bends || beams())) return {1, any, any, bends};
  // Linear tissue is balanced by one solve; beams beside it bend, and their rows turn.
  return {most, automatic_first, automatic, bends};
}

Simulation::Place Simulation::place_of(const State& past, const core::TimeStep& now,
                                       const Pass& pass, const cavity::Shape& walls,
                                       const State& next)
{
  Place here;
  here.forces = all_forces(pass, next, walls, now);
  if (pass.folded < 0) here.balance = tissue_.balance(past.tissue, next.tissue.u, now, here.forces);
  return here;
}

/// Sets what the next linearisation is led by, `residual`.
bool Simulation::enough(const State& past, const State& next, const cavity::Shape& walls,
                        const core::TimeStep& now, const Pass& pass, const tissue::Balance& balance,
                        const Iterate& before, double& residual, StepReport& report) const
{
  const Effort effort = effort_of(now);
  const double across = beams() ? left_across(past, next, now, pass) : 0.0;
  report.unbalanced = std::max(balance.worst, across);
  if (report.linearisations == 1 && effort.first > 0.0 && report.unbalanced <= effort.first)
    return true;
  double increment = 0.0;
  for (std::size_t i = 0; i < needles_.size(); ++i) {
    // Of a needle the next increment is asked: against its axial stiffness, forces that bend it
    // are below round-off.
    const needle::Linearised again = needles_[i].linearise(past.needles[i], next.needles[i], now);
    const core::VecX lever =
        pass.lambda.lambda.size() > 0 ? pass.levers[i] : core::VecX::Zero(again.r.size()).eval();
    increment = std::max(increment, needles_[i].relative_increment(again, lever));
  }
  residual = std::max(balance.norm, increment);
  if (!(std::max(balance.worst, increment) <= effort.later)) return false;
  if (effort.first > 0.0 && !(across <= effort.later)) return false;
  // Sums over stiff parts are rounded: as long as it helps, the residual is refined.
  if (now.is_static && !balance.carries(effort.later) && balance.lost < 0.5 * before.lost)
    return false;
  if (cavities_ && cavities_->exact() && !cavities_->closed(next.cavities, walls, now))
    return false;
  return gaps_closed(now, next, pass);
}

bool Simulation::beams() const
{
  return std::any_of(needles_.begin(), needles_.end(), [](const needle::Needle& one) {
    return one.settings().model == needle::Model::beam;
  });
}

/// What another linearisation would change of the forces that beams are held with, as a part of the
/// largest of each: the gaps of the rows in the new geometry, and what the beams' own rest makes of
/// them with the factor they had. Along a beam a change of place far below those is a huge force,
/// but one that nothing else feels.
double Simulation::left_across(const State& past, const State& next, const core::TimeStep& now,
                               const Pass& pass) const
{
  constexpr double part = 1e-6;  // below which of a gap that is closed anyway nothing is asked
  const Rows again = coupling_rows(now, next);
  std::vector<core::VecX> d;
  for (std::size_t b = 0; b < needles_.size(); ++b) {
    const constraint::SmallBody& body = pass.needles[b];
    const Eigen::Index dofs = body.free_increment.size();
    d.push_back(core::VecX::Zero(body.held + dofs));
    if (dofs == 0) continue;
    core::VecX r = needles_[b].residual(past.needles[b], next.needles[b], now);
    if (!pass.levers.empty()) r -= pass.levers[b];
    d.back().tail(dofs) = body.factor.solve(core::VecX(r.tail(dofs)));
  }
  std::vector<double> largest(needles_.size(), 0.0);
  const auto held = [](const constraint::Row& row) {
    return row.body >= 0 && row.kind == law::RowKind::bilateral && row.relative_softness == 0.0;
  };
  for (int i = 0; i < again.set.size(); ++i) {
    const constraint::Row& row = again.set.rows()[static_cast<std::size_t>(i)];
    double& most = largest[static_cast<std::size_t>(std::max(row.body, 0))];
    if (held(row)) most = std::max(most, std::abs(pass.lambda.lambda[i]));
  }
  double worst = 0.0;
  for (int i = 0; i < again.set.size(); ++i) {
    const constraint::Row& row = again.set.rows()[static_cast<std::size_t>(i)];
    if (!held(row) || !(pass.mobility[i] > 0.0)) continue;
    const auto b = static_cast<std::size_t>(row.body);
    double gap = row.gap + row.softness * pass.lambda.lambda[i];
    for (const auto& [dof, coefficient] : row.lever) gap -= coefficient * d[b][dof];
    const double least = 10.0 * scene_.laws.tolerance / part;
    worst = std::max(worst, std::abs(gap) / (pass.mobility[i] * largest[b] + least));
  }
  return worst;
}

/// The rows turn with the shaft: the gaps of the new geometry must be closed as well.
bool Simulation::gaps_closed(const core::TimeStep& now, const State& next, const Pass& pass) const
{
  constexpr double no_gap = 1e-12;  // [m], of places that are known to a part in 1e14
  const Rows again = coupling_rows(now, next);
  for (int i = 0; i < again.set.size(); ++i) {
    const constraint::Row& row = again.set.rows()[static_cast<std::size_t>(i)];
    const bool hard = row.kind == law::RowKind::bilateral && row.softness == 0.0 &&
                      row.relative_softness == 0.0 && pass.mobility[i] > 0.0;
    if (hard && std::abs(row.gap) > std::max(10.0 * scene_.laws.tolerance, no_gap)) return false;
  }
  return true;
}

/// From a linearisation that was not enough to the next one: its increment may be too long, and
/// the tangent with held rotations lead on too slowly. False when an element stays folded.
bool Simulation::lead_on(const State& past, const core::TimeStep& now, const Pass& pass,
                         const Effort& effort, Place& here, Iterate& before, cavity::Shape& walls,
                         State& next)
{
  constexpr double slow = 0.5;
  constexpr int most_slow = 3;
  const bool upright = pass.folded < 0;
  double rest = upright ? here.balance.norm : before.unbalanced;
  if (!upright || rest > slow * before.unbalanced) ++before.slow;
  if (before.slow >= most_slow) tissue_.take_exact();
  const bool overshoots = rest > std::max(before.unbalanced, effort.later);
  if (!upright || overshoots) {
    if (effort.most == 1 || !effort.measured) return false;
    if (!shorten(past, now, upright, before, here.forces, walls, next, rest)) return false;
  }
  before.forces = std::move(here.forces);
  before.unbalanced = rest;
  before.lost = here.balance.lost;
  return true;
}

// Half of the increment, a quarter, ...: the first on which no element is inside out and less is
// unbalanced than before it. Forces of needles and cavities come in along the line, so that the
// residual falls at first wherever the tangent is that of the forces; rows that begin to hold or
// slip are no reason for it to fall, then the whole increment stays. False when even the shortest
// turns elements inside out, or one increment after the other does.
bool Simulation::shorten(const State& past, const core::TimeStep& now, bool upright,
                         Iterate& before, fem::OwnedField& forces, cavity::Shape& walls,
                         State& next, double& unbalanced_part)
{
  constexpr int most_halvings = 4, most_turnovers = 4;
  before.turnovers = upright ? 0 : before.turnovers + 1;
  if (before.turnovers > most_turnovers) return false;
  const fem::OwnedField whole = next.tissue.u, all = forces;
  bool possible = upright;
  double part = 1.0;
  for (int halving = 0; halving < most_halvings; ++halving) {
    part *= 0.5;
    const fem::OwnedField u{before.u.value + part * (whole.value - before.u.value)};
    if (tissue_.folded(u) >= 0) continue;
    const bool first = !std::isfinite(before.unbalanced);  // nothing to compare with
    fem::OwnedField along = all;
    if (!first) along.value = before.forces.value + part * (all.value - before.forces.value);
    const double here = tissue_.balance(past.tissue, u, now, along).norm;
    const bool descends = first || here < before.unbalanced;
    if (upright && !descends) continue;
    possible = true;
    next.tissue.u = u;
    forces = std::move(along);
    unbalanced_part = here;
    if (descends) break;
  }
  if (possible) walls = walls_of(next);
  return possible;
}

}  // namespace trocar::step
