#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "law/immovable.hpp"
#include "law/solve.hpp"
#include "step/simulation.hpp"

// 3 to 5 of the step: rows, the dense problem, the correction.
namespace trocar::step {
Simulation::Pass Simulation::constrained_step(const State& past, const core::TimeStep& now,
                                              const tissue::FreeMotion& tissue, double residual,
                                              const cavity::Shape& walls, State& next,
                                              core::VecX& last, StepReport& report)
{
  Pass pass;
  std::vector<needle::Linearised> needles;
  for (std::size_t i = 0; i < needles_.size(); ++i)
    needles.push_back(needles_[i].linearise(past.needles[i], next.needles[i], now));
  for (const needle::Linearised& needle : needles)
    pass.needles.push_back({needle.held, needle.factor, needle.free_increment});
  pass.rows = coupling_rows(now, next);  // 3 rows H, gaps, laws
  if (cavities_)
    pass.rows.of_cavities =
        cavities_->add_rows(next.cavities, walls, next.tissue.u, now, pass.rows.set);
  pass.probes = pass.rows.set.probes();
  pass.tolerance = lag_tolerance(now, residual, !pass.rows.set.empty(), report.linearisations > 0);
  const fem::OwnedField start = next.tissue.u;  // where the gaps are measured from
  if (last.size() != pass.rows.set.size()) last = pass.rows.set.starts();
  const bool stale =
      scene_.tissue.reuse == solve::Reuse::stale && tissue.approach && !pass.rows.set.empty();
  if (cavities_ && !cavities_->frozen(next.cavities).empty())
    meet_frozen_laws(now, tissue, last, pass, next, report);
  else if (!stale || scene_.stale_error)
    meet_laws(tissue, start, last, pass, next.tissue.u, report);
  if (stale && !pass.trouble) meet_stale_laws(tissue, start, last, pass, next.tissue.u, report);
  if (pass.trouble) return pass;
  last = pass.lambda.lambda;
  if (cavities_) cavities_->take(pass.rows.of_cavities, last, now, next.cavities);
  correct(past, now, needles, pass, next, report);
  return pass;
}

void Simulation::meet_laws(const tissue::FreeMotion& tissue, const fem::OwnedField& start,
                           const core::VecX& last, Pass& pass, fem::OwnedField& u,
                           StepReport& report)
{
  tissue::FreeMotion motion = tissue;
  if (motion.approach) tissue_.start_from(motion, last, push_of(pass).forces(last));
  for (bool converged = false;
       !converged;) {              // once, or more often when the factor is an older one
    if (!pass.rows.set.empty()) {  // 4 W and g from the isolated compliance, then the laws
      get_compliance(pass, report);
      core::VecX free = tissue_.at(pass.probes, motion, start);
      if (motion.pushed.size() > 0)
        free -= pass.C * constraint::probe_forces(pass.rows.set, motion.pushed);
      pass.trouble = solve_constraints(free, last, pass, report);
    }
    if (pass.trouble && motion.approach &&
        tissue_.lags()) {  // try with the factor of the operator itself
      tissue_.give_up(motion);
      pass.trouble = motion.trouble;
      if (pass.trouble) return;
      continue;
    }
    if (pass.trouble) return;
    u = tissue_.finish(motion, pass.probes, more_forces(motion, pass));  // 5
    ++report.passes;
    converged = !motion.approach || tissue_.converged(motion, u, push_of(pass), pass.tolerance);
    pass.trouble = motion.trouble;
    if (pass.trouble) return;
  }
}

// The needle paper's reuse of columns from step to step: the laws are met once, with the compliance
// of an older operator; the tissue obeys the present one. What the gaps are off is reported.
void Simulation::meet_stale_laws(const tissue::FreeMotion& tissue, const fem::OwnedField& start,
                                 const core::VecX& last, Pass& pass, fem::OwnedField& u,
                                 StepReport& report)
{
  const fem::OwnedField exact = u;
  const auto alone = [&](tissue::FreeMotion motion) {
    do {
      u = tissue_.finish(motion, {}, {});
      ++report.passes;
    } while (!tissue_.converged(motion, u, {}, pass.tolerance) && !motion.trouble);
    pass.trouble = motion.trouble;
  };
  tissue::FreeMotion motion = tissue;
  tissue_.start_from(motion, {}, space_.zero());
  alone(motion);
  if (pass.trouble) return;
  get_compliance(pass, report);
  pass.lambda = {};
  const core::VecX free = solve::read(pass.probes, {u.value - start.value}, space_);
  pass.trouble = solve_constraints(free, last, pass, report);
  if (pass.trouble) return;
  alone(tissue_.pushed(u, push_of(pass).forces(pass.lambda.lambda)));
  if (pass.trouble) return;
  const core::VecX moved = solve::read(pass.probes, {u.value - start.value}, space_);
  const core::VecX thought = free + pass.C * pass.forces;
  const core::VecX off = constraint::row_displacements(pass.rows.set, moved - thought);
  report.leftover_gap = std::max(report.leftover_gap, off.cwiseAbs().maxCoeff());
  if (scene_.stale_error) {
    const fem::OwnedField difference{u.value - exact.value};
    const double mine = difference.value.size() > 0 ? difference.value.cwiseAbs().maxCoeff() : 0.0;
    report.stale_error = std::max(report.stale_error, space_.comm().max(mine));
  }
}

void Simulation::get_compliance(Pass& pass, StepReport& report)
{
  if (pass.factor_version == tissue_.factor_version()) return;
  solve::ComplianceReport compliance;
  pass.C = tissue_.compliance().block(pass.probes, compliance);
  pass.factor_version = tissue_.factor_version();
  report.compliance += compliance;
}

core::VecX Simulation::more_forces(const tissue::FreeMotion& motion, const Pass& pass)
{
  if (motion.pushed.size() == 0) return pass.forces;
  return pass.forces - constraint::probe_forces(pass.rows.set, motion.pushed);
}

tissue::Push Simulation::push_of(const Pass& pass) const
{
  tissue::Push push;
  push.lambda = pass.lambda.lambda;
  push.same_laws = pass.same_laws;
  push.forces = [&pass, this](const core::VecX& lambda) {
    return solve::spread(pass.probes, constraint::probe_forces(pass.rows.set, lambda), space_);
  };
  push.yielding = [&pass](const core::VecX& a, const core::VecX& b) {
    return constraint::yielding(pass.rows.set, pass.needles, a, b);
  };
  return push;
}

/// Of a step that is iterated anyway, a linearisation need only lead on: beside forces of rows,
/// well beyond what the last one left, or one sweep with an older factor would pass for it again
/// and again and lead nowhere. Under pressures that follow it does so by the square of that, so
/// that Newton's rate is kept.
double Simulation::lag_tolerance(const core::TimeStep& now, double residual, bool rows,
                                 bool goes_on) const
{
  constexpr double least = 1e-10, part = 0.1;
  const bool follows = cavities_ && cavities_->follows();
  const int told = scene_.time.newton_max;
  const bool iterated = now.is_static || told > 1 || (told == 0 && goes_on);
  const double lag = scene_.tissue.lag_tolerance;
  const double leads_on = follows ? 1e-4 : std::max(lag, iterated ? 1e-4 : 0.0);
  if (!(follows || (iterated && rows)) || !std::isfinite(residual)) return leads_on;
  return std::clamp(follows ? residual * residual : part * residual, least, leads_on);
}

std::optional<std::string> Simulation::solve_constraints(const core::VecX& free,
                                                         const core::VecX& start, Pass& pass,
                                                         StepReport& report)
{
  constexpr int most_refreshes = 50;
  constraint::Set& set = pass.rows.set;
  law::Problem& problem = pass.problem;
  const law::Multipliers last = std::move(pass.lambda);
  int refreshes = 0;
  for (;; ++refreshes) {  // once, or until the laws of fluids settle
    problem = constraint::reduce(set, pass.C, free, pass.needles);
    problem.start = refreshes > 0 ? pass.lambda.lambda : last.converged ? last.lambda : start;
    pass.lambda = law::solve(problem, scene_.laws);
    ++ledger_.constraint_solves;
    if (!pass.lambda.converged)
      return pass.lambda.immovable < 0
                 ? pass.lambda.why
                 : pass.lambda.why + ", of " + place_of_row(pass, pass.lambda.immovable);
    report.iterations += pass.lambda.iterations;
    if (!cavities_ || !cavities_->refresh(pass.lambda.lambda, pass.rows.of_cavities, set)) break;
    if (refreshes == most_refreshes) return "the laws of the fluids do not settle";
  }
  pass.same_laws = refreshes == 0 && last.converged &&
                   law::same_states(problem, last.lambda, pass.lambda.lambda);
  if (!last.converged) law::compare(problem, scene_.compare, report.trials);

  pass.mobility = law::mobility(problem);
  pass.forces = constraint::probe_forces(set, pass.lambda.lambda);
  pass.levers.clear();
  for (std::size_t i = 0; i < needles_.size(); ++i)
    pass.levers.push_back(
        constraint::body_forces(set, pass.lambda.lambda, static_cast<int>(i), needles_[i].dofs()));
  report.rows = set.size();
  report.rank = pass.lambda.rank;
  report.condition = pass.lambda.condition;
  report.nonunique = pass.lambda.nonunique;
  report.residual = std::max(report.residual, pass.lambda.residual);
  report.outer = std::max(report.outer, pass.lambda.outer);
  report.contraction = std::max(report.contraction, pass.lambda.contraction);
  return std::nullopt;
}

void Simulation::correct(const State& past, const core::TimeStep& now,
                         const std::vector<needle::Linearised>& needles, const Pass& pass,
                         State& next, StepReport& report)
{
  const bool pushed = pass.lambda.lambda.size() > 0;
  next.tissue.v.value = now.rates().velocity * (next.tissue.u.value - past.tissue.u.value);
  report.needles.assign(needles_.size(), {});
  for (std::size_t i = 0; i < needles_.size(); ++i) {
    const core::VecX lever = pushed ? pass.levers[i] : core::VecX::Zero(needles_[i].dofs()).eval();
    report.needles[i].base = needles_[i].base_wrench(next.needles[i], needles[i], lever);
    next.needles[i] = needles_[i].correct(past.needles[i], next.needles[i], needles[i], lever, now);
  }
}

}  // namespace trocar::step
