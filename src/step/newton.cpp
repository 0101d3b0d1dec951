#include "step/newton.hpp"

#include <algorithm>
#include <cmath>

#include "core/words.hpp"
#include "step/refusals.hpp"

// Stopping rule and line search of Newton's iteration. linearise.cpp has the linearisation.
namespace trocar::step {
namespace {

constexpr int most_linearisations = 50;  ///< of a step that is iterated until it is balanced

}  // namespace

Newton::Newton(Model& model, const Scheme& scheme, State first)
    : model_(&model),
      scheme_(&scheme),
      effort_(effort_of(model, scheme.now())),
      next_(std::move(first)),
      touched_(next_.contact),
      walls_(model.walls(next_.tissue.u))
{
  if (!model.contact.empty()) u_start_ = model.space.gather(next_.tissue.u);
  model.tissue.tangent().begin_step();
}

/// Static equilibria and steps with pressures that follow the walls are iterated until everything
/// is balanced. Any other dynamic step takes at most `newton_max` linearisations; with 0 it takes
/// as many as it needs, at most 50.
Newton::Effort Newton::effort_of(const Model& model, const core::TimeStep& now)
{
  constexpr int most = most_linearisations;
  constexpr double automatic_first = 1e-3, automatic = 1e-6;
  const double tolerance = model.scene.tissue.newton_tolerance;
  const bool bends = !model.scene.tissue.all_linear();
  if (now.is_static || model.follows()) return {most, 0.0, tolerance, true};
  const int told = model.scene.time.newton_max;
  if (told > 1) return {told, 0.0, tolerance, true};
  const double any = std::numeric_limits<double>::max();  // accepts any finite residual
  if (told == 1 || !(bends || model.beams())) return {1, any, any, bends};
  // When all tissue is linear, one solve balances it, and its balance is not measured. Beams beside
  // it need more solves, because they bend and their rows turn.
  return {most, automatic_first, automatic, bends};
}

/// Largest increment that the needles would make in another linearisation with the same λ, see
/// Needle::relative_increment. Needles are not judged by their residual: rounding errors of the
/// axial force hide the forces that bend a needle.
double Newton::largest_increment() const
{
  double largest = 0.0;
  for (std::size_t i = 0; i < model_->needles.size(); ++i) {
    const needle::Needle& needle = model_->needles[i];
    const needle::Linearised again =
        needle.linearise(scheme_->past().needles[i], next_.needles[i], scheme_->now());
    largest = std::max(largest, needle.relative_increment(again, solution_->on_needle(i)));
  }
  return largest;
}

void Newton::measure()
{
  const core::TimeStep& now = scheme_->now();
  // Normals and weights of contact move with the bodies, so that one linearisation is not enough.
  if (solution_->contact)
    effort_ = {std::max(effort_.most, most_linearisations), 0.0,
               std::min(effort_.later, model_->scene.tissue.newton_tolerance), true};
  forces_ = {};
  balance_ = {};
  if (!effort_.measured) return;
  forces_ = solution_->forces(*model_, next_, walls_, now);
  if (inverted_ < 0)
    balance_ = model_->tissue.balance(scheme_->past().tissue, next_.tissue.u, now, forces_);
}

bool Newton::balanced()
{
  measure();
  if (inverted_ >= 0) return false;
  const core::TimeStep& now = scheme_->now();
  const tissue::Balance& balance = balance_;
  std::optional<Rows> rows;  // at this iterate, made on first use
  const auto rows_here = [&]() -> const Rows& {
    if (!rows) rows = coupling_rows(*model_, now, next_);
    return *rows;
  };
  const double across =
      model_->beams() ? left_across(*model_, *scheme_, next_, *solution_, rows_here()) : 0.0;
  report_.unbalanced = std::max(balance.worst, across);
  const bool automatic = effort_.first > 0.0;
  if (report_.linearisations == 1 && automatic && report_.unbalanced <= effort_.first) return true;
  const double increment = largest_increment();
  residual_ = std::max(balance.norm, increment);
  if (!(std::max(balance.worst, increment) <= effort_.later)) return false;
  if (automatic && !(across <= effort_.later)) return false;
  // In statics the supports must carry the loads. Rounding in stiff parts may prevent this, so the
  // iteration goes on only while each linearisation halves the sum that is not carried.
  if (now.is_static && !balance.carries(effort_.later) && balance.lost < 0.5 * lost_before_)
    return false;
  if (model_->exact_volumes() && !cavity::closed(*model_->cavities, next_.cavities, walls_, now))
    return false;
  if (solution_->contact && solution_->contact->residual > contact_tolerance(*model_)) return false;
  return gaps_closed(*model_, *solution_, rows_here());
}

core::Outcome<core::Done> Newton::lead_on()
{
  constexpr double slow = 0.5, still = 0.999, rounding = 1e-6;
  constexpr int most_slow = 3, most_still = 5;
  const bool admissible = inverted_ < 0;
  double rest = admissible ? balance_.norm : unbalanced_before_;
  if (!admissible || rest > slow * unbalanced_before_) ++slow_;
  if (slow_ >= most_slow) model_->tissue.tangent().take_exact();
  const bool rests = rest > rounding && (rest > still * unbalanced_before_ || !touches());
  still_ = admissible && rests ? still_ + 1 : 0;
  if (scheme_->now().proximal > 0.0 && still_ >= most_still)
    return core::Refusal{not_held(*model_)};
  const bool overshoots = rest > std::max(unbalanced_before_, effort_.later);
  const bool may_shorten = effort_.most > 1 && effort_.measured;
  if ((!admissible || overshoots) && !(may_shorten && shorten(rest)))
    return core::Refusal{inverted_at(model_->scene, inverted_)};
  forces_before_ = std::move(forces_);
  unbalanced_before_ = rest;
  lost_before_ = balance_.lost;
  return core::Done{};
}

/// Tet (file order) whose inversion is not allowed; -1: none.
int Newton::refused(const tissue::Folded& folded) const
{
  if (folded.linear < 0 || model_->scene.tissue.allow_inversion) return folded.other;
  return folded.other < 0 ? folded.linear : std::min(folded.linear, folded.other);
}

// Line search: takes the first of 1/2, 1/4, ... of the increment that inverts no element and has a
// smaller residual than the start. Forces of needles and cavities are interpolated on the line, so
// the residual falls at first wherever the tangent is that of the forces. It need not fall when
// rows begin to hold or slip: then the whole increment stays, if it inverts no element. False when
// even the shortest part inverts elements, or when more than four increments in a row did.
bool Newton::shorten(double& rest)
{
  constexpr int most_halvings = 4, most_inversions = 4;
  const bool admissible = inverted_ < 0;
  inversions_ = admissible ? 0 : inversions_ + 1;
  if (inversions_ > most_inversions) return false;
  const fem::OwnedField whole = next_.tissue.u, all = forces_;
  bool possible = admissible;
  double part = 1.0;
  for (int halving = 0; halving < most_halvings; ++halving) {
    part *= 0.5;
    const fem::OwnedField u{u_before_.value + part * (whole.value - u_before_.value)};
    if (refused(model_->tissue.folded(u)) >= 0) continue;
    const bool first = !std::isfinite(unbalanced_before_);  // no earlier residual
    fem::OwnedField along = all;
    if (!first) along.value = forces_before_.value + part * (all.value - forces_before_.value);
    const double here =
        model_->tissue.balance(scheme_->past().tissue, u, scheme_->now(), along).norm;
    const bool descends = first || here < unbalanced_before_;
    if (admissible && !descends) continue;
    possible = true;
    next_.tissue.u = u;
    forces_ = std::move(along);
    rest = here;
    if (descends) break;
  }
  if (possible) walls_ = model_->walls(next_.tissue.u);
  return possible;
}

/// True when some pair presses.
bool Newton::touches() const
{
  return solution_->contact && solution_->contact->lambda.size() > 0 &&
         solution_->contact->lambda.maxCoeff() > 0.0;
}

core::Refusal Newton::not_balanced() const
{
  const std::string what = residual_ <= effort_.later
                               ? "the gaps of the rows stay open, or single nodes unbalanced"
                               : "relative residual " + core::shown(residual_);
  return {"equilibrium not reached in " + std::to_string(effort_.most) + " linearisations (" +
          what + ")"};
}

}  // namespace trocar::step
