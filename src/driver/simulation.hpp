#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cavity/cavities.hpp"
#include "constraint/reduce.hpp"
#include "driver/scenario.hpp"
#include "mesh/partition.hpp"

namespace trocar::driver {

using core::Vec3;

/// Where the energy went [J]: what is stored at the end of a step, and sums since the start.
/// supplied = stored - stored at the start + friction + cutting + damping + rest; the rest is what
/// backward Euler loses and what frozen geometry leaves.
struct EnergyAccount
{
  double elastic = 0.0, kinetic = 0.0;
  double stored_at_start = 0.0;
  double supplied = 0.0;  ///< by holders, loads and moving supports
  double friction = 0.0, cutting = 0.0, damping = 0.0;

  double rest() const
  {
    return supplied - (elastic + kinetic - stored_at_start) - friction - cutting - damping;
  }
};

/// Velocity as it was differenced from displacements: v = u'(t) - lag u'' + curvature u''' + O(h³).
struct Differenced
{
  double lag = 0.0;        ///< [s]
  double curvature = 0.0;  ///< [s²]
};

/// What BDF2 remembers of the step before.
struct Before
{
  Differenced velocity;
  tissue::TissueState tissue;
  std::vector<needle::NeedleState> needles;
};

/// All that changes in a run. A value: a rejected step leaves no trace.
struct State
{
  double t = 0.0;        ///< [s]
  double h = 0.0;        ///< length of the step that led here [s]; 0: none in time did
  Differenced velocity;  ///< exact where none did
  tissue::TissueState tissue;
  std::vector<needle::NeedleState> needles;
  std::vector<insertion::InsertionState> insertions;  ///< by needle
  cavity::State cavities;
  std::optional<Before> before;  ///< with -time_scheme bdf2 only
  EnergyAccount energy;          ///< kept with -output_energy only
};

/// What one needle did in a step.
struct NeedleReport
{
  Vec3 tip = Vec3::Zero();  ///< [m]
  double depth = 0.0;       ///< inserted path length in tissue [m]
  needle::Wrench base;      ///< by the holder on the needle
  insertion::CouplingReport coupling;
};

/// Figures of an accepted step, for log and histories. Equal on every rank.
struct StepReport
{
  std::vector<NeedleReport> needles;
  std::vector<cavity::CavityReport> cavities;
  tissue::HolderForces holders;            ///< of prescribed displacements and supports
  int pressure_updates = 0;                ///< of frozen cavities
  int rows = 0, rank = 0, iterations = 0;  ///< of the last constraint problem; iterations summed
  double residual = 0.0;                   ///< worst of the step [m]
  double unbalanced = 0.0;                 ///< tissue::Balance::worst at the end of the step
  int folded = -1;                         ///< tet that linear tissue was allowed to fold; -1: none
  double condition = 0.0;                  ///< see law::Multipliers
  int outer = 0;                           ///< most solves that state-dependent bounds took
  double contraction = 0.0;                ///< worst ratio of their last two changes
  bool nonunique = false;
  std::vector<law::Trial> trials;      ///< of the solvers compared
  solve::ComplianceReport compliance;  ///< sums over the step's linearisations
  int linearisations = 0;
  double leftover_gap = 0.0;  ///< what the laws with a stale compliance leave of the gaps [m]
  double stale_error = 0.0;   ///< worst displacement error of that, on request [m]
  int passes = 0;  ///< sweeps with the laws behind them: one each, more with an older factor
};

/// An accepted new state, or why the step was rejected. Agreed by all ranks.
struct StepResult
{
  std::optional<State> state;
  StepReport report;
  std::string why;

  static StepResult rejected(const std::string& why) { return {std::nullopt, {}, why}; }
};

/// One scene: bodies, needles, their coupling, and the step of the papers.
class Simulation
{
 public:
  /// Borrows the scenario. Collective.
  Simulation(const Scenario& scenario, const base::Comm& comm);
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

  const Scenario& scenario() const { return scenario_; }
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
    double first;   ///< Balance::worst at which one will do; 0: never
    double later;   ///< and which ends the others
    bool measured;  ///< whether the balance is looked at
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
  bool gaps_closed(const core::TimeStep& now, const State& next, const Pass& pass) const;
  std::optional<std::string> move_needles(const State& old, State& next) const;
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
  double lag_tolerance(const core::TimeStep& now, double residual, bool rows) const;
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

  const Scenario& scenario_;
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

}  // namespace trocar::driver
