#pragma once

#include <limits>
#include <string>

#include "step/rows.hpp"

namespace trocar::step {

/// Newton's iteration for one step. An iteration linearises all bodies, solves with the rows,
/// measures the residual, and shortens the increment when the residual has grown. The papers make
/// one iteration per step.
class Newton
{
 public:
  /// Borrows model and scheme. `first`: the first iterate, from `predict`.
  Newton(Model& model, const Scheme& scheme, State first);

  /// False when the largest number of linearisations has been reached.
  bool goes_on() const { return report_.linearisations < effort_.most; }
  /// Linearises at the iterate, solves with the rows in their laws and moves to the solution.
  /// Refused when there is no solution. Throws core::Unsolved (70) when a linear solver misses its
  /// tolerance without an exact tangent. Collective.
  core::Outcome<core::Done> linearise();
  /// Measures the balance. True when the iterate is accepted: forces are balanced to the tolerance,
  /// no element is inverted, and the gaps are closed. Collective.
  bool balanced();
  /// Prepares the next iteration. Shortens the increment when the residual grew or an element is
  /// inverted, and switches to the exact tangent after three slow linearisations. Refused when an
  /// element stays inverted. Collective.
  core::Outcome<core::Done> lead_on();
  core::Refusal not_balanced() const;

  const State& state() const { return next_; }
  State& state() { return next_; }
  const cavity::Shape& walls() const { return walls_; }
  const Solution& solution() const { return *solution_; }
  StepReport& report() { return report_; }
  /// Balance of the tissue, from the last call of `balanced`.
  const tissue::Balance& balance() const { return balance_; }

 private:
  /// Stopping rule: when and after how many linearisations the iteration ends.
  struct Effort
  {
    int most;       ///< largest number of linearisations
    double first;   ///< unbalanced part at which the first linearisation suffices; 0: never
    double later;   ///< unbalanced part of the forces at which a later one suffices
    bool measured;  ///< the balance of the tissue is measured
  };
  static Effort effort_of(const Model& model, const core::TimeStep& now);
  double lag_tolerance(bool rows) const;
  core::Outcome<Solution> solve_once();
  void collect_rows(Solution& solution);
  core::Outcome<Solution> solve_rows(solve::Linearisation& at);
  core::Outcome<constraint::Saddle> meet_laws(solve::Linearisation& at, constraint::System& system);
  void correct(Solution& solution);
  contact::Contacts contacts() const
  {
    return {model_->contact, touched_, u_start_, scheme_->now().begin()};
  }
  void end_contact(Solution& solution) const;
  void measure();
  double largest_increment() const;
  int refused(const tissue::Folded& folded) const;
  bool shorten(double& rest);
  bool touches() const;

  Model* model_;
  const Scheme* scheme_;
  Effort effort_;
  State next_;
  contact::State touched_;    ///< contact at the start of the step
  fem::GlobalField u_start_;  ///< displacement there; empty without pairs
  cavity::Shape walls_;
  StepReport report_;
  std::optional<Solution> solution_;                           ///< of the last linearisation
  double residual_ = std::numeric_limits<double>::infinity();  ///< last one, for lag_tolerance
  int inverted_ = -1;  ///< inverted tet in file order, -1: none; equal on all ranks
  // At the solution of the last linearisation, empty when not measured:
  fem::OwnedField forces_;   ///< forces of needles and cavities on the tissue [N]
  tissue::Balance balance_;  ///< balance of the tissue
  // At the start of the last linearisation:
  fem::OwnedField u_before_, forces_before_;
  double unbalanced_before_ = std::numeric_limits<double>::infinity();
  double lost_before_ = std::numeric_limits<double>::infinity();  ///< Balance::lost [N]
  int inversions_ = 0;  ///< increments in a row that inverted elements
  int still_ = 0;       ///< linearisations in a row that left the residual as it was
  int slow_ = 0;        ///< slow linearisations: residual not halved, or an element inverted
};

}  // namespace trocar::step
