#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cavity/cavities.hpp"
#include "constraint/reduce.hpp"
#include "mesh/partition.hpp"
#include "step/report.hpp"
#include "step/scene.hpp"

namespace trocar::step {

/// One scene: bodies, needles, their coupling, and the step of the papers.
class Simulation
{
 public:
  /// Borrows the scene. Collective.
  Simulation(const Scene& scene, const base::Comm& comm);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// State before the first step: at rest, or in equilibrium with the loads; inserted needles are
  /// coupled on the undeformed mesh first. Failure (70) when no equilibrium is found. Collective.
  StepResult initial_state();

  /// One step from `old`; the old state is not touched. Collective.
  StepResult step(const State& old, const core::TimeStep& step);

  /// Static equilibrium at `now.t`, with load steps when one does not do. Collective.
  StepResult equilibrium(const State& old, const core::TimeStep& now);

  /// Analyses the operator: afterwards its memory is known. Collective.
  void analyse() { tissue_.analyse(); }
  /// Factors the first operator, for -check. Collective.
  void prepare();

  const Scene& scene() const { return scene_; }
  const fem::Space& space() const { return space_; }
  const core::Ledger& ledger() const { return ledger_; }
  core::Ledger& ledger() { return ledger_; }
  const tissue::Tissue& tissue() const { return tissue_; }
  tissue::Tissue& tissue() { return tissue_; }
  const std::vector<needle::Needle>& needles() const { return needles_; }
  const std::optional<cavity::Cavities>& cavities() const { return cavities_; }
  std::optional<cavity::Cavities>& cavities() { return cavities_; }
  /// See Insertion::tributary_lengths [m].
  core::MatX tributary(const insertion::InsertionState& state) const
  {
    return insertion_->tributary_lengths(state);
  }

 private:
  struct Rows
  {
    constraint::Set set;
    std::vector<insertion::CouplingRows> of_needle;
    cavity::CavityRows of_cavities;
  };
  /// One linearisation: its rows and what they answered.
  struct Pass
  {
    Rows rows;
    std::optional<std::string> trouble;  ///< why the step cannot be taken; agreed by all ranks
    int folded = -1;  ///< file tet that is turned inside out, -1: none; agreed by all ranks
    law::Problem problem;
    law::Multipliers lambda;
    bool same_laws = false;                      ///< every row holds or slips as in the pass before
    std::vector<constraint::SmallBody> needles;  ///< as the rows feel them
    core::MatX C;                                ///< isolated compliance of the probes [m/N]
    int factor_version = 0;                      ///< of the factor that C belongs to
    core::VecX mobility;                         ///< see law::mobility [m/N]
    solve::Probes probes;                        ///< tissue nodes that the rows hold
    core::VecX forces;                           ///< Ĥᵀλ on them [N]
    std::vector<core::VecX> levers;              ///< H_nᵀλ on each needle
    double tolerance = 0.0;                      ///< of an approach, see lag_tolerance
  };

  /// What a linearisation started from.
  struct Iterate
  {
    fem::OwnedField u, forces;  ///< place, and forces of needles and cavities on the tissue [N]
    double unbalanced = std::numeric_limits<double>::infinity();  ///< there
    double lost = std::numeric_limits<double>::infinity();        ///< Balance::lost there [N]
    int turnovers = 0;  ///< increments in a row that turned elements inside out
    int slow = 0;       ///< linearisations that left more than half of what was unbalanced
  };
  /// Where a linearisation led.
  struct Place
  {
    fem::OwnedField forces{};  ///< of needles and cavities on the tissue [N]
    tissue::Balance balance{};
  };
  /// How often a step is linearised, and until when.
  struct Effort
  {
    int most;       ///< linearisations
    double first;   ///< what is unbalanced at which one will do; 0: never
    double later;   ///< and which ends the others
    bool measured;  ///< whether the balance of the tissue is looked at
  };

  Differenced velocity_of(const State& state, double h) const;
  const State& past_of(const State& old, core::TimeStep& now, State& extrapolated,
                       Differenced& velocity) const;
  Pass linearised_step(const State& past, const core::TimeStep& now, double residual,
                       cavity::Shape& walls, State& next, core::VecX& last, StepReport& report);
  Pass constrained_step(const State& past, const core::TimeStep& now,
                        const tissue::FreeMotion& tissue, double residual,
                        const cavity::Shape& walls, State& next, core::VecX& last,
                        StepReport& report);
  void meet_frozen_laws(const core::TimeStep& now, const tissue::FreeMotion& tissue,
                        const core::VecX& last, Pass& pass, State& next, StepReport& report);
  void at_pressures(const fem::OwnedField& free, const std::vector<fem::OwnedField>& per_p,
                    const fem::OwnedField& start, const core::VecX& last, Pass& pass, State& next,
                    StepReport& report);
  cavity::PressureAnswers answers_with_rows(const Pass& pass, const cavity::PressureAnswers& alone);
  const cavity::PressureAnswers& unit_answers(const cavity::State& state,
                                              const core::TimeStep& now);
  fem::OwnedField needle_forces(const Pass& pass) const;
  fem::OwnedField all_forces(const Pass& pass, const State& next, const cavity::Shape& walls,
                             const core::TimeStep& now) const;
  void advance_cavities(const State& old, State& next) const;
  cavity::Shape walls_of(const State& state) const;
  bool beams() const;
  double left_across(const State& past, const State& next, const core::TimeStep& now,
                     const Pass& pass) const;
  bool gaps_closed(const core::TimeStep& now, const State& next, const Pass& pass) const;
  std::optional<std::string> move_needles(const State& old, const core::TimeStep& now,
                                          State& next) const;
  Rows coupling_rows(const core::TimeStep& now, const State& state) const;
  void meet_laws(const tissue::FreeMotion& tissue, const fem::OwnedField& start,
                 const core::VecX& last, Pass& pass, fem::OwnedField& u, StepReport& report);
  void meet_stale_laws(const tissue::FreeMotion& tissue, const fem::OwnedField& start,
                       const core::VecX& last, Pass& pass, fem::OwnedField& u, StepReport& report);
  void get_compliance(Pass& pass, StepReport& report);
  std::optional<std::string> solve_constraints(const core::VecX& free, const core::VecX& start,
                                               Pass& pass, StepReport& report);
  void correct(const State& past, const core::TimeStep& now,
               const std::vector<needle::Linearised>& needles, const Pass& pass, State& next,
               StepReport& report);
  static core::VecX more_forces(const tissue::FreeMotion& motion, const Pass& pass);
  tissue::Push push_of(const Pass& pass) const;
  double lag_tolerance(const core::TimeStep& now, double residual, bool rows, bool goes_on) const;
  Effort effort_of(const core::TimeStep& now) const;
  Place place_of(const State& past, const core::TimeStep& now, const Pass& pass,
                 const cavity::Shape& walls, const State& next);
  bool enough(const State& past, const State& next, const cavity::Shape& walls,
              const core::TimeStep& now, const Pass& pass, const tissue::Balance& balance,
              const Iterate& before, double& residual, StepReport& report) const;
  bool lead_on(const State& past, const core::TimeStep& now, const Pass& pass, const Effort& effort,
               Place& here, Iterate& before, cavity::Shape& walls, State& next);
  bool shorten(const State& past, const core::TimeStep& now, bool upright, Iterate& before,
               fem::OwnedField& forces, cavity::Shape& walls, State& next, double& unbalanced_part);
  std::string folds_at(int tet) const;
  std::string not_balanced(const Effort& effort, double residual) const;
  std::string place_of_row(const Pass& pass, int row) const;
  std::optional<std::string> cannot_stand(const core::TimeStep& now,
                                          const tissue::Balance& balance) const;
  std::optional<std::string> collapsed(const StepReport& report) const;
  void accept(const State& old, const State& past, const core::TimeStep& now, const Pass& pass,
              const cavity::Shape& walls, State& next, StepReport& report) const;
  void account(const State& old, const State& past, const core::TimeStep& now, const Pass& pass,
               const cavity::Shape& walls, const StepReport& report, State& next) const;

  const Scene& scene_;
  core::Ledger ledger_;
  fem::Space space_;
  tissue::Tissue tissue_;
  std::vector<needle::Needle> needles_;
  bool driven_at_start_ = false;  ///< motion that rows or supports prescribe from the start on
  std::optional<mesh::Locator> locator_;                         ///< only with needles
  std::optional<insertion::Insertion> insertion_;                ///< only with needles
  std::optional<cavity::Cavities> cavities_;                     ///< only with cavities
  std::map<core::Rates, cavity::PressureAnswers> unit_answers_;  ///< frozen cavities, by operator
};

}  // namespace trocar::step
