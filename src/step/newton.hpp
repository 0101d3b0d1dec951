#pragma once

#include <limits>
#include <string>

#include "step/rows.hpp"

namespace trocar::step {

/// Newton's iteration of one step: linearise all bodies, solve, judge what is left, and go on along
/// an increment that is no longer than it leads. One iteration is the papers' step.
class Newton
{
 public:
  /// Borrows model and scheme. `first`: where it begins, with the events of the step.
  Newton(Model& model, const Scheme& scheme, State first);

  /// False when as many iterations as may be were in vain.
  bool goes_on() const { return report_.linearisations < effort_.most; }
  /// Linearises at the state so far, solves with the rows in their laws and moves there. Refused
  /// when that cannot be. Collective.
  core::Outcome<core::Done> linearise();
  /// The state so far is taken: it is balanced well enough, no element is turned inside out and the
  /// gaps are closed. Collective.
  bool balanced();
  /// Prepares the next iteration: shortens the increment where the residual grows or elements turn
  /// inside out, and takes the exact tangent where the other leads on too slowly. Refused when an
  /// element stays turned. Collective.
  core::Outcome<core::Done> lead_on();
  core::Refusal not_balanced() const;

  const State& state() const { return next_; }
  State& state() { return next_; }
  const cavity::Shape& walls() const { return walls_; }
  const Solution& solution() const { return *solution_; }
  StepReport& report() { return report_; }
  /// Of the tissue at the state so far.
  const tissue::Balance& balance() const { return balance_; }

 private:
  /// How often a step is linearised, and until when.
  struct Effort
  {
    int most;       ///< linearisations
    double first;   ///< what is unbalanced at which one will do; 0: never
    double later;   ///< and which ends the others
    bool measured;  ///< whether the balance of the tissue is looked at
  };
  static Effort effort_of(const Model& model, const core::TimeStep& now);
  double lag_tolerance(bool rows) const;
  core::Outcome<Solution> solve_once();
  void collect_rows(Solution& solution);
  core::Outcome<Solution> solve_rows(solve::Linearisation& at);
  core::Outcome<constraint::Saddle> meet_laws(solve::Linearisation& at, constraint::System& system);
  void correct(Solution& solution);
  void measure();
  double largest_increment() const;
  int refused(const tissue::Folded& folded) const;
  bool shorten(double& rest);

  Model* model_;
  const Scheme* scheme_;
  Effort effort_;
  State next_;
  cavity::Shape walls_;
  StepReport report_;
  std::optional<Solution> solution_;  ///< of the last linearisation: the multipliers of the step
  double residual_ = std::numeric_limits<double>::infinity();  ///< what the next one is led by
  int inverted_ = -1;  ///< file tet that is turned inside out, -1: none; agreed by all ranks
  // Where the last linearisation led, as far as it was measured:
  fem::OwnedField forces_;   ///< of needles and cavities on the tissue [N]
  tissue::Balance balance_;  ///< of the tissue
  // Where it started from:
  fem::OwnedField u_before_, forces_before_;
  double unbalanced_before_ = std::numeric_limits<double>::infinity();
  double lost_before_ = std::numeric_limits<double>::infinity();  ///< Balance::lost [N]
  int inversions_ = 0;  ///< increments in a row that turned elements inside out
  int slow_ = 0;        ///< linearisations that left more than half of what was unbalanced
};

}  // namespace trocar::step
