#include "step/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/words.hpp"
#include "law/solve.hpp"

namespace trocar::step {
namespace {

constexpr int most_load_steps = 64;

}  // namespace

Simulation::Simulation(const Scene& scene, const base::Comm& comm)
    : scene_(scene),
      space_(scene.mesh, mesh::partition_nodes(scene.mesh, comm), comm,
             tissue::rings(scene.tissue.dilatation)),
      tissue_(scene.mesh, space_, scene.tissue, ledger_)
{
  if (scene.time.is_static || scene.time.start_in_equilibrium)
    tissue::require_supports(tissue_.fixed(), scene.mesh);
  if (!scene.cavities.cavities.empty())
    cavities_.emplace(scene.mesh, space_, scene.cavities, ledger_);
  driven_at_start_ = !scene.tissue.boundary.displacements.empty() || cavities_.has_value();
  for (const needle::NeedleSettings& settings : scene.needles) {
    needles_.emplace_back(settings);
    driven_at_start_ =
        driven_at_start_ || settings.motion.inserted > 0.0 || settings.motion.trajectory;
  }
  if (needles_.empty()) return;
  locator_.emplace(scene.mesh);
  insertion_.emplace(scene.mesh, *locator_, scene.insertion);
}

void Simulation::prepare()
{
  const bool is_static = scene_.time.is_static || scene_.time.start_in_equilibrium;
  core::TimeStep first{0.0, scene_.time.step, is_static};
  State unused;
  Differenced velocity;
  past_of({}, first, unused, velocity);
  tissue_.prepare(first);
}

StepResult Simulation::initial_state()
{
  State state;
  state.tissue = tissue_.at_rest();
  for (const needle::Needle& needle : needles_) {
    state.needles.push_back(needle.initial());
    state.insertions.push_back(insertion_->start(needle));
  }
  if (cavities_) state.cavities = cavities_->start();
  const core::TimeStep start = core::TimeStep::at_start(scene_.time.step);
  if (scene_.time.start_in_equilibrium || scene_.time.is_static) return equilibrium(state, start);
  StepResult result{state, {}, {}};
  for (std::size_t i = 0; i < needles_.size(); ++i)
    result.report.needles.push_back(
        {state.needles[i].shaft.tip(), insertion_->depth(state.insertions[i]), {}, {}});
  if (cavities_) {
    cavities_->take({}, {}, start, result.state->cavities);
    result.report.cavities = cavities_->accept(result.state->cavities, state.tissue.u,
                                               cavities_->shape(state.tissue.u), start);
  }
  const tissue::BoundaryConditions& boundary = scene_.tissue.boundary;
  result.report.holders.tools.assign(boundary.displacements.size(), Vec3::Zero());
  result.report.holders.supports.assign(boundary.fixed.size(), Vec3::Zero());
  return result;
}

StepResult Simulation::equilibrium(const State& old, const core::TimeStep& now)
{
  // Along a path in time the stepper halves the step; only the start is loaded in parts.
  const int most_parts = now.start ? most_load_steps : 1;
  StepResult result;
  for (int parts = 1; parts <= most_parts; parts *= 2) {
    State from = old;
    for (int part = 1; part <= parts; ++part) {
      core::TimeStep share = now;
      share.load = static_cast<double>(part) / parts;
      result = step(from, share);
      if (!result.state) break;
      from = *result.state;
    }
    if (result.state) return result;
  }
  return result;
}

StepResult Simulation::step(const State& old, const core::TimeStep& step)
{
  core::TimeStep now = step;
  State extrapolated;
  State next = old;
  next.t = now.t;
  next.h = now.is_static ? 0.0 : now.h;
  // What time derivatives count from.
  const State& past = past_of(old, now, extrapolated, next.velocity);
  // 1 events, decided before and frozen during the solve
  if (const auto trouble = move_needles(old, now, next)) return StepResult::rejected(*trouble);
  if (cavities_ && !now.start) advance_cavities(old, next);
  StepReport report;
  const Effort effort = effort_of(now);
  double residual = std::numeric_limits<double>::infinity();
  core::VecX last;  // multipliers, to go on from
  cavity::Shape walls = walls_of(next);
  Iterate before;
  tissue_.begin_step();
  for (int iteration = 1; iteration <= effort.most; ++iteration) {
    if (effort.most > 1) before.u = next.tissue.u;
    const Pass pass = linearised_step(past, now, residual, walls, next, last, report);  // 2 to 5
    if (pass.trouble) return StepResult::rejected(*pass.trouble);
    report.linearisations = iteration;
    Place here;
    if (effort.measured) here = place_of(past, now, pass, walls, next);
    if (pass.folded < 0 &&
        enough(past, next, walls, now, pass, here.balance, before, residual, report)) {
      if (const auto trouble = cannot_stand(now, here.balance))
        return StepResult::rejected(*trouble);
      accept(old, past, now, pass, walls, next, report);
      if (const auto trouble = collapsed(report)) return StepResult::rejected(*trouble);
      return {std::move(next), std::move(report), {}};
    }
    if (!lead_on(past, now, pass, effort, here, before, walls, next))
      return StepResult::rejected(folds_at(pass.folded));
  }
  return StepResult::rejected(not_balanced(effort, residual));
}

// The step of both papers: every body moves freely, the rows that couple them are solved in one
// small dense problem, and the bodies are corrected by it.
Simulation::Pass Simulation::linearised_step(const State& past, const core::TimeStep& now,
                                             double residual, cavity::Shape& walls, State& next,
                                             core::VecX& last, StepReport& report)
try {
  Pass pass;
  fem::Load load;
  if (cavities_) load = cavities_->load(next.cavities, walls, now);
  const bool goes_on = report.linearisations > 0;
  const fem::OwnedField iterate = next.tissue.u;
  tissue::FreeMotion tissue =
      tissue_.free_motion(past.tissue, next.tissue.u, now, load, goes_on);  // 2 each body alone
  if (tissue.trouble && tissue_.drop_exact())
    tissue = tissue_.free_motion(past.tissue, next.tissue.u, now, load, goes_on);
  pass.trouble = tissue.trouble;
  if (pass.trouble) return pass;
  // Directions frozen at the start of the step, as in the paper, or brought up to date within it.
  for (int turn = 1; turn <= scene_.time.direction_max; ++turn) {
    pass = constrained_step(past, now, tissue, residual, walls, next, last, report);  // 3 to 5
    if (!pass.trouble) walls = walls_of(next);
    if (pass.trouble || pass.rows.set.empty() || turn == scene_.time.direction_max) break;
    if (gaps_closed(now, next, pass)) break;
  }
  if (pass.trouble && tissue_.drop_exact()) {  // with the factor of a rotated one it could begin
    next.tissue.u = iterate;
    return linearised_step(past, now, residual, walls, next, last, report);
  }
  if (pass.trouble) return pass;
  pass.folded = tissue_.folded(next.tissue.u);
  if (scene_.tissue.allow_inversion && next.tissue.u.value.allFinite()) {
    report.folded = pass.folded;
    pass.folded = -1;
  }
  for (const needle::NeedleState& needle : next.needles)
    if (!needle.finite()) pass.trouble = "a needle's shape is not finite";
  return pass;
} catch (const core::Unsolved& failure) {  // as a tangent without factor: a smaller step may do
  const bool exact = tissue_.exact_tangent();
  if (tissue_.drop_exact()) return linearised_step(past, now, residual, walls, next, last, report);
  if (!exact) throw;
  Pass pass;
  pass.trouble = "the exact tangent was not solved with (an instability, or too large a step): " +
                 std::string(failure.what());
  return pass;
}

std::optional<std::string> Simulation::move_needles(const State& old, const core::TimeStep& now,
                                                    State& next) const
{
  if (needles_.empty()) return std::nullopt;
  const fem::GlobalField u = space_.gather(old.tissue.u);
  const insertion::Deformed tissue(scene_.mesh, *locator_, u);
  for (std::size_t i = 0; i < needles_.size(); ++i) {
    next.needles[i] = needles_[i].predict(old.needles[i], next.t);
    if (now.start) continue;
    next.insertions[i] = insertion_->advance(old.insertions[i], next.needles[i].shaft, tissue);
    if (insertion_->astray(next.insertions[i], next.needles[i].shaft, tissue))
      return "needle '" + needles_[i].settings().name +
             "': its shaft enters the tissue beside its channel (contact of shafts and surfaces is "
             "not modelled)";
  }
  return std::nullopt;
}

void Simulation::advance_cavities(const State& old, State& next) const
{
  std::vector<std::vector<cavity::VoidPiece>> voids(needles_.size());
  for (std::size_t i = 0; i < needles_.size(); ++i) {
    const insertion::InsertionState& insertion = next.insertions[i];
    const needle::Shaft& shaft = next.needles[i].shaft;
    for (const insertion::Piece& piece : insertion.path.pieces) {
      if (piece.tet >= 0 || piece.begin >= insertion.tip_arc) continue;
      const double middle = 0.5 * (piece.begin + std::min(piece.end, insertion.tip_arc));
      voids[i].push_back({needle::shaft_at(shaft, shaft.length - (insertion.tip_arc - middle)).x,
                          insertion::tissue_length(insertion.path, piece.begin)});
    }
  }
  next.cavities = cavities_->advance(old.cavities, old.t, next.t, voids, old.tissue.u);
}

Simulation::Rows Simulation::coupling_rows(const core::TimeStep& now, const State& state) const
{
  Rows rows;
  const bool coupled = std::any_of(state.insertions.begin(), state.insertions.end(),
                                   [](const auto& one) { return one.touches(); });
  if (!coupled) return rows;
  const fem::GlobalField u = space_.gather(state.tissue.u);
  const insertion::Deformed tissue(scene_.mesh, *locator_, u);
  const double passing = now.start ? 0.0 : now.h;
  for (std::size_t i = 0; i < needles_.size(); ++i)
    rows.of_needle.push_back(insertion_->add_rows(state.insertions[i], state.needles[i].shaft,
                                                  tissue, static_cast<int>(i), passing, rows.set));
  return rows;
}

void Simulation::accept(const State& old, const State& past, const core::TimeStep& now,
                        const Pass& pass, const cavity::Shape& walls, State& next,
                        StepReport& report) const
{
  const tissue::BoundaryConditions& boundary = scene_.tissue.boundary;
  if (!boundary.displacements.empty() || !boundary.fixed.empty())
    report.holders =
        tissue_.holder_forces(past.tissue, next.tissue.u, now, all_forces(pass, next, walls, now));
  if (cavities_) {
    const cavity::Shape shape = cavities_->exact() ? walls : cavities_->shape(next.tissue.u);
    report.cavities = cavities_->accept(next.cavities, next.tissue.u, shape, now);
    for (cavity::CavityReport& cavity : report.cavities)
      cavity.iterations = std::max(report.linearisations, report.pressure_updates);
  }
  std::optional<fem::GlobalField> u;  // gathered only when a tip does something
  for (std::size_t i = 0; i < needles_.size(); ++i) {
    NeedleReport& needle = report.needles[i];
    if (!pass.rows.of_needle.empty())
      needle.coupling = insertion_->accept(next.insertions[i], pass.rows.of_needle[i], pass.lambda);
    if (needle.coupling.tip != insertion::TipOutcome::holds) {
      if (!u) u = space_.gather(next.tissue.u);
      insertion_->settle(next.insertions[i], needle.coupling, next.needles[i].shaft,
                         {scene_.mesh, *locator_, *u});
    }
    needle.tip = next.needles[i].shaft.tip();
    needle.depth = insertion_->depth(next.insertions[i]);
  }
  if (scene_.time.second_order && !now.start)
    next.before = Before{velocity_of(old, now.h), old.tissue, old.needles};
  if (scene_.energy) account(old, past, now, pass, walls, report, next);
}

}  // namespace trocar::step
