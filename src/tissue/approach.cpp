#include "tissue/approach.hpp"

#include <cmath>

#include "tissue/tissue.hpp"

namespace trocar::tissue {

/// A factor is made anew when the last linearisation took more sweeps than one does on average when
/// the factor's cost is shared by all that used it: from there on its share no longer falls.
bool Tissue::factor_worn() const
{
  const Operator& o = *current_;
  if (settings_.reuse == solve::Reuse::stale) return o.uses >= settings_.stale_steps;
  return o.uses > 0 && o.last_sweeps * o.uses > o.solver->sweeps_per_factor() + o.sweeps;
}

void Tissue::factor(const std::vector<Mat3>& R)
{
  current_->solver->set_operator(values_);
  ++factor_version_;
  if (settings_.model != Model::linear) current_->R_factor = R;
  current_->older = false;
  current_->uses = 1;
  current_->sweeps = current_->last_sweeps = 1.0;
}

/// Begins where the velocity leads.
void Tissue::begin_approach(const TissueState& old, const TimeStep& step, const OwnedField& r,
                            const fem::Load& more, double least, bool goes_on, FreeMotion& motion)
{
  Approach approach;
  approach.stiffness = more.stiffness;
  approach.least = least;
  OwnedField ahead = space_->zero();
  if (!step.start && !goes_on) {
    ahead.value = step.h * old.v.value;
    fixed_.clear(ahead);
  }
  approach.residual = {r.value - operate(approach, ahead).value};
  fixed_.clear(approach.residual);
  OwnedField load = r;
  fixed_.clear(load);
  approach.load = space_->norm(load);
  motion.base.value += ahead.value;
  approach.u = motion.base;
  motion.approach = std::move(approach);
}

/// A d with the present operator.
OwnedField Tissue::operate(const Approach& approach, const OwnedField& d) const
{
  OwnedField product = times(d);
  if (approach.stiffness) product.value -= approach.stiffness(d).value;
  return product;
}

void Tissue::start_from(FreeMotion& motion, const core::VecX& lambda, const OwnedField& forces)
{
  if (!motion.approach) return;
  Approach& a = *motion.approach;
  a.lambda = motion.pushed = lambda;
  a.residual.value += forces.value;
  fixed_.clear(a.residual);
  motion.half = begin(a.residual);
}

FreeMotion Tissue::pushed(const OwnedField& u, const OwnedField& forces)
{
  FreeMotion motion{u, begin(forces)};
  if (!current_->older) return motion;
  Approach approach;
  approach.u = u;
  approach.residual = forces;
  fixed_.clear(approach.residual);
  approach.load = space_->norm(approach.residual);
  motion.approach = std::move(approach);
  return motion;
}

void Tissue::give_up(FreeMotion& motion)
{
  motion.trouble = why_not([&] { factor(current_->at.R); });
  if (motion.trouble) return;
  Approach& a = *motion.approach;
  motion.base = a.u;
  motion.pushed = a.lambda;
  motion.half = begin(a.residual);
  a.passes = 0;
  a.on_rows = false;
  a.direction_energy = 0.0;
  if (!a.stiffness) motion.approach.reset();
}

bool Tissue::converged(FreeMotion& motion, const OwnedField& u, const Push& push, double tolerance)
{
  if (!motion.approach) return true;
  Approach& a = *motion.approach;
  const bool rows = push.lambda.size() > 0;
  core::VecX more = push.lambda - a.lambda;
  OwnedField d{u.value - a.u.value};
  OwnedField A_d = operate(a, d);
  const OwnedField pushed = rows ? push.forces(more) : space_->zero();
  OwnedField rest{a.residual.value + pushed.value - A_d.value};
  double load = a.load;
  if (rows) {
    OwnedField forces = push.forces(push.lambda);
    fixed_.clear(forces);
    load += space_->norm(forces);
  }
  fixed_.clear(rest);
  ++a.passes;
  const double left = space_->norm(rest);
  const bool same_laws = space_->comm().all(push.same_laws);  // rows are solved by each rank
  if (left <= std::max(tolerance * load, a.least)) {
    current_->last_sweeps = a.passes;
    current_->sweeps += a.passes;
    return true;
  }
  const double most =
      lags() ? most_passes + current_->solver->sweeps_per_factor() : most_passes_of_own;
  const bool leads_on = a.passes < most && std::isfinite(left);
  bool convex = true;
  if (leads_on && rows && !(same_laws && a.on_rows))
    change_rows(a, d, A_d, more, pushed, push, same_laws);
  else if (leads_on)
    convex = advance(a, std::move(d), std::move(A_d), std::move(more), push);
  if (!leads_on || !convex) {
    end_approach(motion, convex);
    return false;
  }
  motion.base = a.u;
  motion.pushed = a.lambda;
  motion.half = begin(a.residual);
  return false;
}

/// An approach that does not lead on: its factor is too old, or there is nothing to come to.
void Tissue::end_approach(FreeMotion& motion, bool convex)
{
  if (lags()) return give_up(motion);
  motion.trouble =
      convex ? "pressures that follow the tissue are not balanced in " +
                   std::to_string(motion.approach->passes) + " passes"
             : "the energy under pressures that follow the tissue has negative curvature (limit "
               "point or buckling): volume control passes limit points of the pressure";
}

/// A step on which rows begin to hold or slip. The energy is convex and d a proximal step in the
/// metric of P: it falls along d at least up to (dᵀPd)/(dᵀAd). The first step is a whole one, to
/// get on the bilateral rows.
void Tissue::change_rows(Approach& a, const OwnedField& d, const OwnedField& A_d,
                         const core::VecX& more, const OwnedField& pushed, const Push& push,
                         bool same_laws) const
{
  double step = 1.0;
  if (a.passes > 1 && !same_laws) {
    const double others = push.yielding(more, more);
    const double P = space_->dot(d, {a.residual.value + pushed.value}) + others;
    const double A = space_->dot(d, A_d) + others;
    if (P < A) step = P / A;
  }
  a.u.value += step * d.value;
  a.lambda += step * more;
  a.residual.value += step * (pushed.value - A_d.value);
  fixed_.clear(a.residual);
  a.on_rows = step == 1.0;
  a.direction_energy = 0.0;
}

/// One step of conjugate gradients from a preconditioned direction d; needles and soft rows are
/// part of the energy, because they move with the multipliers.
/// False when the energy has no minimum along it.
bool Tissue::advance(Approach& a, OwnedField d, OwnedField A_d, core::VecX more,
                     const Push& push) const
{
  const bool rows = more.size() > 0;
  if (a.direction_energy > 0.0) {
    double coupled = space_->dot(d, a.A_direction);
    if (rows) coupled += push.yielding(more, a.lambda_direction);
    const double beta = -coupled / a.direction_energy;
    d.value += beta * a.direction.value;
    A_d.value += beta * a.A_direction.value;
    more += beta * a.lambda_direction;
  }
  a.direction_energy = space_->dot(d, A_d) + (rows ? push.yielding(more, more) : 0.0);
  const double along = space_->dot(a.residual, d);
  if (a.stiffness && !(a.direction_energy > 0.0)) return false;
  const double step = a.direction_energy > 0.0 ? along / a.direction_energy : 1.0;
  a.u.value += step * d.value;
  a.lambda += step * more;
  a.residual.value -= step * A_d.value;
  if (rows) a.residual.value += step * push.forces(more).value;
  fixed_.clear(a.residual);
  a.direction = std::move(d);
  a.A_direction = std::move(A_d);
  a.lambda_direction = std::move(more);
  return true;
}

}  // namespace trocar::tissue
