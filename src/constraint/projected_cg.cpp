#include <cmath>
#include <string>

#include "constraint/saddle.hpp"

namespace trocar::constraint {
namespace {

using core::VecX;
using solve::OwnedField;

/// Most passes with an older factor: `most_passes` more than the sweeps that a new factor would
/// cost. Most passes with an up-to-date factor under loads that follow: `most_passes_of_own`.
constexpr int most_passes = 8, most_passes_of_own = 200;

/// State of the iteration to the saddle point (docs/theory.md, algorithm 8.3).
class ProjectedCg
{
 public:
  ProjectedCg(Laws& laws, solve::Linearisation& at, const VecX& start, double tolerance);

  Outcome<Saddle> run();

 private:
  /// Result of one pass: half-sweep forward, laws, half-sweep backward.
  struct Trial
  {
    OwnedField d;  ///< change of u [m]
    VecX more;     ///< change of the multipliers [N]
  };
  /// Changes of the residual by a trial: `rest_` becomes rest_ + pushed - A_d.
  struct Product
  {
    OwnedField A_d, pushed;  ///< A d, and Hᵀ times `more` [N]
  };

  Outcome<Trial> sweep();
  bool reached(const Product& product);
  Outcome<Done> go_on(Trial trial, Product product);
  void change_rows(const Trial& trial, const Product& product, bool same_laws);
  bool descend(Trial trial, OwnedField A_d);
  Outcome<Done> end(bool convex);
  Outcome<Done> make_own_factor();

  const System& system() const { return laws_.system(); }
  const fem::Space& space() const { return at_.space(); }
  bool rows() const { return !laws_.system().empty(); }
  OwnedField pushed_by(const VecX& lambda) const { return system().forces(lambda, space()); }
  void clear_fixed(OwnedField& f) const { at_.factor->fixed().clear(f); }

  Laws& laws_;
  solve::Linearisation& at_;
  VecX start_;
  double tolerance_;
  OwnedField u_;                        ///< displacement where the next pass starts [m]
  VecX lambda_;                         ///< multipliers at u_ [N]
  OwnedField rest_;                     ///< residual r + Hᵀλ - A Δu at u_ [N]
  double load_;                         ///< ‖r‖ [N]
  OwnedField direction_, A_direction_;  ///< last direction [m] and its product with A [N]
  VecX lambda_direction_;
  double direction_energy_ = 0.0;  ///< energy of the last direction [J]; 0: there is none
  bool on_rows_ = false;           ///< u_ and lambda_ meet the laws of all rows
  bool exact_ = false;             ///< the factor is that of the operator A, so one pass is enough
  int passes_ = 0;
  double left_ = 0.0;  ///< norm of the residual after the last trial [N]
};

ProjectedCg::ProjectedCg(Laws& laws, solve::Linearisation& at, const VecX& start, double tolerance)
    : laws_(laws),
      at_(at),
      start_(start),
      tolerance_(tolerance),
      u_(at.base),
      lambda_(start),
      rest_(at.residual),
      load_(at.space().norm(at.residual))
{
  if (at.guess) {
    rest_.value -= at.product(*at.guess).value;
    u_.value += at.guess->value;
  }
  if (rows()) rest_.value += pushed_by(lambda_).value;
  clear_fixed(rest_);
}

Outcome<Saddle> ProjectedCg::run()
{
  for (;;) {
    auto trial = sweep();
    if (!trial) {  // the laws cannot be met with this factor: try that of A
      if (!at_.factor->lags()) return trial.refusal();
      if (const auto made = make_own_factor(); !made) return made.refusal();
      continue;
    }
    ++laws_.report().passes;
    Product product;
    if (!exact_)
      product = {at_.product(trial->d), rows() ? pushed_by(trial->more) : space().zero()};
    if (exact_ || reached(product))
      return Saddle{{u_.value + trial->d.value}, laws_.take(), laws_.problem()};
    if (const auto on = go_on(std::move(*trial), std::move(product)); !on) return on.refusal();
  }
}

Outcome<ProjectedCg::Trial> ProjectedCg::sweep()
{
  const solve::HalfSolution half = at_.factor->begin(rest_);
  if (!rows()) return Trial{at_.factor->finish(half, {}, {}), {}};
  laws_.use(*at_.factor);
  const OwnedField ahead{u_.value - at_.iterate.value};
  const VecX held = system().probe_forces(lambda_);  // these forces are in rest_ already
  const VecX free = at_.factor->read(system().probes(), half) +
                    solve::read(system().probes(), ahead, space()) - laws_.compliance() * held;
  if (const auto met = laws_.meet(*at_.factor, free, start_); !met) return met.refusal();
  const VecX forces = system().probe_forces(laws_.multipliers()) - held;
  return Trial{at_.factor->finish(half, system().probes(), forces), laws_.multipliers() - lambda_};
}

bool ProjectedCg::reached(const Product& product)
{
  OwnedField left{rest_.value + product.pushed.value - product.A_d.value};
  clear_fixed(left);
  double load = load_;
  if (rows()) {
    OwnedField forces = pushed_by(laws_.multipliers());
    clear_fixed(forces);
    load += space().norm(forces);
  }
  ++passes_;
  left_ = space().norm(left);
  if (!(left_ <= std::max(tolerance_ * load, at_.least))) return false;
  at_.factor->served(passes_);
  return true;
}

Outcome<Done> ProjectedCg::go_on(Trial trial, Product product)
{
  // Every rank solves the dense problem by itself, so the ranks have to agree here.
  const bool same_laws = space().comm().all(laws_.same_states());
  const solve::LaggedFactor& factor = *at_.factor;
  const double most =
      factor.lags() ? most_passes + factor.solver().sweeps_per_factor() : most_passes_of_own;
  if (!(passes_ < most) || !std::isfinite(left_)) return end(true);
  if (rows() && !(same_laws && on_rows_)) {
    change_rows(trial, product, same_laws);
    return Done{};
  }
  if (!descend(std::move(trial), std::move(product.A_d))) return end(false);
  return Done{};
}

/// The passes do not converge. An old factor is replaced. With an up-to-date one there may be no
/// equilibrium: refused. `convex`: no direction of negative curvature was found.
Outcome<Done> ProjectedCg::end(bool convex)
{
  if (at_.factor->lags()) return make_own_factor();
  if (convex)
    return core::Refusal{"pressures that follow the tissue are not balanced in " +
                         std::to_string(passes_) + " passes"};
  return core::Refusal{
      "the energy under pressures that follow the tissue has negative curvature (limit point or "
      "buckling): volume control passes limit points of the pressure"};
}

Outcome<Done> ProjectedCg::make_own_factor()
{
  if (const auto made = at_.refactor(); !made) return made.refusal();
  passes_ = 0;
  on_rows_ = false;
  direction_energy_ = 0.0;
  exact_ = !at_.loads_follow;
  return Done{};
}

/// A step in which rows begin to hold or slip. The energy is convex and d is a proximal Newton step
/// in the metric of P, so the energy falls along d at least up to the fraction (dᵀPd)/(dᵀAd). The
/// first step goes all the way, so that the bilateral rows are met from then on.
void ProjectedCg::change_rows(const Trial& trial, const Product& product, bool same_laws)
{
  double step = 1.0;
  if (passes_ > 1 && !same_laws) {
    const double others = system().yielded(trial.more, trial.more);
    const double P = space().dot(trial.d, {rest_.value + product.pushed.value}) + others;
    const double A = space().dot(trial.d, product.A_d) + others;
    if (P < A) step = P / A;
  }
  u_.value += step * trial.d.value;
  lambda_ += step * trial.more;
  rest_.value += step * (product.pushed.value - product.A_d.value);
  clear_fixed(rest_);
  on_rows_ = step == 1.0;
  direction_energy_ = 0.0;
}

/// One step of conjugate gradients with the preconditioned residual d. Small bodies and compliant
/// rows move with the multipliers, so the energy includes their part. False when the energy has no
/// minimum along the new direction.
bool ProjectedCg::descend(Trial trial, OwnedField A_d)
{
  auto& [d, more] = trial;
  if (direction_energy_ > 0.0) {
    double coupled = space().dot(d, A_direction_);
    if (rows()) coupled += system().yielded(more, lambda_direction_);
    const double beta = -coupled / direction_energy_;
    d.value += beta * direction_.value;
    A_d.value += beta * A_direction_.value;
    if (rows()) more += beta * lambda_direction_;
  }
  direction_energy_ = space().dot(d, A_d) + (rows() ? system().yielded(more, more) : 0.0);
  const double along = space().dot(rest_, d);
  if (at_.loads_follow && !(direction_energy_ > 0.0)) return false;
  const double step = direction_energy_ > 0.0 ? along / direction_energy_ : 1.0;
  u_.value += step * d.value;
  if (rows()) lambda_ += step * more;
  rest_.value -= step * A_d.value;
  if (rows()) rest_.value += step * pushed_by(more).value;
  clear_fixed(rest_);
  direction_ = std::move(d);
  A_direction_ = std::move(A_d);
  lambda_direction_ = std::move(more);
  return true;
}

}  // namespace

Outcome<Saddle> projected_cg(Laws& laws, solve::Linearisation& at, const VecX& start,
                             double tolerance)
{
  return ProjectedCg(laws, at, start, tolerance).run();
}

}  // namespace trocar::constraint
