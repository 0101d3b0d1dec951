#include "tissue/tissue.hpp"

// Sets the linearisation point, makes factors or keeps older ones, and refuses a step where this
// fails.
namespace trocar::tissue {

/// Sets the linearisation point at_ for `iterate`; false when an element is inverted. `goes_on`:
/// this step has been linearised before. If it has, an exact tangent takes its pressures from the
/// previous linearisation.
bool Tissue::linearise_at(const OwnedField& iterate, bool goes_on)
{
  const bool led = goes_on && exact_at_ && tangent_.exact();
  core::VecX p;
  if (led)
    p = elements_->linearised_pressures(at_, space_->with_ghosts({iterate.value - u_at_.value}));
  const bool known = configured_.u && configured_.exact == tangent_.exact() && !tangent_.exact() &&
                     configured_.u->value == iterate.value;
  // A known state is admissible, because `balance` is called for admissible states only.
  bool admissible = true;
  known_ = space_->comm().all(known);
  if (known_)
    at_ = configured_.at;
  else
    admissible = configure(space_->with_ghosts(iterate), at_);
  exact_at_ = admissible && tangent_.exact();
  if (exact_at_) u_at_ = iterate;
  if (led && admissible) at_.p = std::move(p);
  return admissible;
}

/// Whether the factor of one operator may also serve later operators (modified Newton).
bool Tissue::may_lag() const
{
  return !settings_.all_linear() && settings_.lag_tolerance > 0.0 &&
         current_->factor.solver().can_turn();
}

core::Outcome<core::Done> Tissue::make_factor(const LinearisationPoint& at)
{
  const auto made = current_->factor.make(values_);
  current_->made.reset();
  if (!made)
    current_->rate.reset();
  else if (may_lag())
    current_->made =
        std::make_shared<const FactorOrigin>(FactorOrigin{*current_->rate, at, tangent_.exact()});
  return made;
}

/// The refusal of a step whose exact tangent has no factor. An exact tangent may be indefinite on
/// the way to an equilibrium, and a smaller step may succeed. For any other tangent a smaller step
/// does not help: throws Failure (70).
core::Refusal Tissue::without_factor(const core::Refusal& refusal) const
{
  if (!tangent_.exact()) throw core::solver_error(refusal.why);
  return {"the exact tangent has no factor (an instability, or too large a step): " + refusal.why,
          false, true};
}

/// Makes the factor of the state `old` again when the solver now has another one (after a rejected
/// step, dropped caches or a restart). So a step depends on its state alone. Does nothing when the
/// rates have changed, and drops a worn factor: a new factor is made in both cases.
core::Outcome<core::Done> Tissue::go_on_with_factor(const TissueState& old, const TimeStep& step)
{
  if (!old.factor || !(old.factor->rates == step.operator_rates())) return core::Done{};
  current_ = &operator_for(old.factor->rates);
  if (!may_lag()) return core::Done{};
  current_->factor.set_age(old.age);
  if (space_->comm().all(current_->made == old.factor)) return core::Done{};
  if (factor_worn()) {
    current_->rate.reset();
    return core::Done{};
  }
  const Tangent now = tangent_.now();
  if (tangent_.automatic()) tangent_.set(old.factor->exact ? Tangent::exact : Tangent::rotated);
  current_->rate = old.factor->rates;
  current_->at = old.factor->at;
  assemble(current_->at, *current_->rate);
  const auto made = make_factor(current_->at);
  if (tangent_.automatic()) tangent_.set(now);
  if (!made) return made;
  current_->made = old.factor;
  current_->factor.set_age(old.age);
  return made;
}

void Tissue::remember_factor(TissueState& state) const
{
  state.factor = current_->made;
  state.age = current_->factor.age();
}

void Tissue::drop_caches()
{
  for (Operator& one : operators_) {
    one.rate.reset();
    one.made.reset();
    one.factor.set_age({});
  }
  configured_.u.reset();
}

/// Whether the factor should be made anew. With Reuse::stale it serves `stale_steps`
/// linearisations, however many sweeps they take.
bool Tissue::factor_worn() const
{
  if (settings_.reuse == solve::Reuse::stale)
    return current_->factor.age().uses >= settings_.stale_steps;
  return current_->factor.worn();
}

Folded Tissue::folded(const OwnedField& u) const
{
  const int none = mesh_->tet_count();
  Folded mine = elements_->folded(space_->with_ghosts(u));
  if (!u.value.allFinite()) mine.other = 0;
  core::VecX least(2);  // negative, because the maximum is then the first tet
  least << (mine.linear < 0 ? -none : -mine.linear), (mine.other < 0 ? -none : -mine.other);
  space_->comm().max(least);
  const auto first = [&](Eigen::Index k) {
    const auto tet = static_cast<int>(-least[k]);
    return tet == none ? -1 : tet;
  };
  return {first(0), first(1)};
}

}  // namespace trocar::tissue
