#include "tissue/tissue.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::tissue {
Tissue::Tissue(const mesh::Mesh& mesh, const fem::Space& space, TissueSettings settings,
               core::Ledger& ledger)
    : mesh_(&mesh),
      space_(&space),
      settings_(std::move(settings)),
      ledger_(&ledger),
      fixed_(dirichlet_set(settings_.boundary, mesh, space)),
      elements_(Elements::make(mesh, space, settings_)),
      tangent_(settings_, *elements_),
      pattern_(space, elements_->cliques()),
      values_(pattern_),
      damped_by_stiffness_(
          std::any_of(settings_.materials.begin(), settings_.materials.end(),
                      [](const Material& m) { return m.rayleigh_stiffness > 0.0; })),
      weight_(space.zero())
{
  elements_->add_weight(settings_.boundary.gravity, weight_);
  for (const Traction& traction : settings_.boundary.tractions)
    traction_.push_back(
        traction_load(mesh::surface_group(mesh, traction.surface), traction.value, mesh, space));
  find_holders();
}

void Tissue::assemble(const LinearisationPoint& at, const core::Rates& rate)
{
  values_.set_zero();
  elements_->assemble(at, rate, pattern_, values_);
  values_.fix(*space_, fixed_);
  ++ledger_->assemblies;
}

bool Tissue::configure(const fem::GhostedField& u, LinearisationPoint& at) const
{
  return space_->comm().all(elements_->configure(u, at));
}

void Tissue::analyse()
{
  const bool turns = !settings_.all_linear() && settings_.lag_tolerance > 0.0;
  std::unique_ptr<solve::StepSolver> solver = solve::make_step_solver(
      settings_.provider, {*space_, pattern_, fixed_, mesh_->x, settings_.ordered_last,
                           settings_.reuse != solve::Reuse::none, settings_.most_memory, turns,
                           settings_.linear, *ledger_});
  if (settings_.reuse == solve::Reuse::stale && !solver->can_turn())
    throw core::solver_error("stale reuse keeps a factor, but the tissue solver is " +
                             solver->describe());
  operators_.push_back({solve::LaggedFactor(std::move(solver), *space_, fixed_), {}, {}, {}});
  current_ = &operators_.back();
}

/// The operator for these rates. Linear tissue keeps two operators, so that a step length used
/// before finds its factor again; more would fill the memory. Other tissue has one operator.
Tissue::Operator& Tissue::operator_for(const core::Rates& rate)
{
  constexpr std::size_t most_kept = 2;
  const bool linear = settings_.all_linear();
  const auto known = std::find_if(operators_.begin(), operators_.end(), [&](const Operator& o) {
    return !linear || o.rate == rate || !o.rate;
  });
  if (known != operators_.end()) return *known;
  if (operators_.size() < most_kept)
    analyse();
  else  // reuse the oldest operator with its symbolic analysis
    std::rotate(operators_.begin(), operators_.begin() + 1, operators_.end());
  return operators_.back();
}

core::Outcome<core::Done> Tissue::use_operator(const LinearisationPoint& at, const TimeStep& step)
{
  const core::Rates rate = step.operator_rates();
  const bool linear = settings_.all_linear();
  current_ = &operator_for(rate);
  solve::LaggedFactor& factor = current_->factor;
  const bool same_rates = current_->rate == rate;
  if (space_->comm().all(same_rates && (linear || current_->at == at))) {
    factor.serve_again();
    return core::Done{};
  }
  current_->rate = rate;
  if (!linear) current_->at = at;
  assemble(at, rate);
  const bool serves = may_lag() && factor.age().uses > 0;
  if (!serves || !space_->comm().all(same_rates) || factor_worn()) return make_factor(at);
  factor.keep(node_rotations(at.R, current_->made->at.R));
  return core::Done{};
}

OwnedField Tissue::external(const TimeStep& step) const
{
  OwnedField f{step.load * weight_.value};
  for (std::size_t i = 0; i < traction_.size(); ++i)
    f.value +=
        step.load * load_factor(settings_.boundary.tractions[i].curve, step.t) * traction_[i].value;
  return f;
}

OwnedField Tissue::forces(const TissueState& old, const OwnedField& u, const LinearisationPoint& at,
                          const TimeStep& step, Sizes* sizes) const
{
  ForceSums sums{space_->zero(), space_->zero()};
  if (sizes) {
    sums.size = std::move(sizes->size);
    sums.rounding = std::move(sizes->rounding);
    if (!step.is_static && damped_by_stiffness_) sums.damping = space_->zero();
  }
  elements_->add_forces(at, kinematics(old, u, step), sums);
  const OwnedField load = external(step);
  if (sizes) {
    const double norms =
        space_->norm(load) + space_->norm(sums.internal) + space_->norm(sums.inertia);
    *sizes = {std::move(sums.size), std::move(sums.rounding), norms, sums.internal,
              std::move(sums.damping)};
    for (int a = 0; a < space_->owned(); ++a) sizes->size[a] += load.node(a).norm();
  }
  return {load.value - sums.internal.value - sums.inertia.value};
}

/// Whether the last `balance` computed the forces at u. Those of stress are then known. Those of
/// stiffness damping are known too if the step is still the same (`goes_on`), or if they are zero
/// because u is `old.u`. The latter holds at the beginning of a backward Euler step.
bool Tissue::forces_known(const TissueState& old, const OwnedField& u, bool goes_on) const
{
  if (!known_) return false;
  if (!damped_by_stiffness_ || goes_on) return true;
  if (settings_.dilatation != Dilatation::pointwise) return false;  // averaged together with p
  return space_->comm().all(old.u.value == u.value);
}

/// External minus internal, damping and inertia forces [N], from those that `balance` kept. Valid
/// only where `forces_known` is true.
OwnedField Tissue::forces_from_balance(const TissueState& old, const OwnedField& u,
                                       const TimeStep& step, bool goes_on) const
{
  const Sizes& sizes = configured_.sizes;
  OwnedField f{external(step).value - sizes.internal.value};
  if (!goes_on && sizes.damping.value.size() > 0) f.value += sizes.damping.value;
  if (step.is_static) return f;
  OwnedField inertia = space_->zero();
  elements_->add_inertia(kinematics(old, u, step), inertia);
  return {f.value - inertia.value};
}

/// External loads minus the internal, damping and inertia forces of the given elements [N].
OwnedField Tissue::forces_of(const std::vector<std::size_t>& elements, const TissueState& old,
                             const OwnedField& u, const LinearisationPoint& at,
                             const TimeStep& step) const
{
  ForceSums sums{space_->zero(), space_->zero()};
  elements_->add_forces_of(elements, at, kinematics(old, u, step), sums);
  return {external(step).value - sums.internal.value - sums.inertia.value};
}

Kinematics Tissue::kinematics(const TissueState& old, const OwnedField& u,
                              const TimeStep& step) const
{
  Kinematics motion{space_->with_ghosts(u), {}, {}};
  if (step.is_static) return motion;
  motion.rates = step.rates();
  const OwnedField v{(u.value - old.u.value) * motion.rates.velocity};
  motion.v = space_->with_ghosts(v);
  motion.a = space_->with_ghosts({(v.value - old.v.value) * motion.rates.acceleration});
  return motion;
}

/// Increment from `iterate` to the prescribed displacements [m]; 0 on free dofs.
OwnedField Tissue::prescribed_increment(const OwnedField& iterate, const TimeStep& step) const
{
  OwnedField prescribed = space_->zero();
  const OwnedField target = prescribed_displacement(settings_.boundary, *mesh_, *space_, step.t);
  for (int local = 0; local < space_->owned(); ++local) {
    const unsigned axes = fixed_.axes_of_number(space_->first() + local);
    for (int a = 0; a < 3; ++a)
      if (axes >> a & 1U)
        prescribed.value[3 * local + a] =
            step.load * target.value[3 * local + a] - iterate.value[3 * local + a];
  }
  return prescribed;
}

/// A linearisation with the product and the factor of the current operator. `linearise` adds
/// displacements and residual.
solve::Linearisation Tissue::with_operator(const fem::Load& more)
{
  solve::Linearisation at;
  at.factor = &current_->factor;
  at.loads_follow = static_cast<bool>(more.stiffness);
  at.product = [this, stiffness = more.stiffness](const OwnedField& d) {
    OwnedField product = times(d);
    if (stiffness) product.value -= stiffness(d).value;
    return product;
  };
  at.refactor = [this]() -> core::Outcome<core::Done> {
    const auto made = make_factor(current_->at);
    if (!made) return without_factor(made.refusal());
    return made;
  };
  return at;
}

core::Outcome<solve::Linearisation> Tissue::linearise(const TissueState& old,
                                                      const OwnedField& iterate,
                                                      const TimeStep& step, const fem::Load& more,
                                                      bool goes_on)
{
  if (!linearise_at(iterate, goes_on))
    return core::Refusal{"an element of the tissue turned inside out"};
  if (!goes_on)
    if (const auto made = go_on_with_factor(old, step); !made)
      return without_factor(made.refusal());
  if (const auto made = use_operator(at_, step); !made) return without_factor(made.refusal());
  solve::Linearisation at = with_operator(more);
  const bool known = forces_known(old, iterate, goes_on);
  Sizes sizes;
  if (at.lagged() && !known) sizes = no_sizes();
  OwnedField r = known ? forces_from_balance(old, iterate, step, goes_on)
                       : forces(old, iterate, at_, step, at.lagged() ? &sizes : nullptr);
  if (more.force.value.size() > 0) r.value += more.force.value;

  const OwnedField prescribed = prescribed_increment(iterate, step);
  const bool moves = space_->comm().any(!prescribed.value.isZero(0.0));
  if (moves) r.value -= operate_by_elements(at_, step.operator_rates(), prescribed).value;
  if (moves && more.stiffness) r.value += more.stiffness(prescribed).value;
  fixed_.clear(r);
  at.iterate = iterate;
  at.base = {iterate.value + prescribed.value};
  at.residual = std::move(r);
  if (!at.lagged()) return at;
  // Iterative solvers also stop at this norm, below which the residual is only rounding. A
  // tolerance relative to the load alone would never be met where nothing happens. Under loads that
  // follow the tissue, r is a small difference of large forces, hence the larger part.
  at.least = least_rest(known ? configured_.sizes : sizes, at.loads_follow ? 1e-10 : 1e-12);
  if (!step.start && !goes_on) {
    at.guess = OwnedField{step.h * old.v.value};
    fixed_.clear(*at.guess);
  }
  return at;
}

OwnedField Tissue::residual(const TissueState& old, const OwnedField& u, const TimeStep& step) const
{
  LinearisationPoint at;
  configure(space_->with_ghosts(u), at);
  OwnedField r = forces(old, u, at, step);
  fixed_.clear(r);
  return r;
}

void Tissue::prepare(const TimeStep& step)
{
  LinearisationPoint at;
  configure(space_->with_ghosts(space_->zero()), at);
  if (const auto made = use_operator(at, step); !made) throw core::solver_error(made.why());
}

}  // namespace trocar::tissue
