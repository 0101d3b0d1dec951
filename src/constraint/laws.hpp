#pragma once

#include <utility>
#include <vector>

#include "constraint/system.hpp"
#include "core/ledger.hpp"
#include "core/outcome.hpp"
#include "law/compare.hpp"
#include "solve/lagged_factor.hpp"

namespace trocar::constraint {

using core::Done;
using core::Outcome;

/// Accuracy and cost of meeting the laws of the rows, over all linearisations of a step.
struct LawReport
{
  int rows = 0, rank = 0, iterations = 0;  ///< rows, rank: of the last problem; iterations: sum
  double residual = 0.0;                   ///< worst true KKT residual [m]
  double condition = 0.0;                  ///< of the last problem, see law::Multipliers
  int outer = 0;                           ///< most solves until state-dependent bounds settled
  double contraction = 0.0;                ///< worst ratio of the last two changes of such bounds
  bool nonunique = false;
  std::vector<law::BenchmarkResult> trials{};  ///< of the solvers in `LawSettings::compare`
  solve::ComplianceReport compliance{};        ///< sums over the linearisations
  int passes = 0;                              ///< passes made: half-sweep, laws, half-sweep
  double leftover_gap = 0.0;  ///< largest gap left by laws met with a stale compliance [m]
  double stale_error = 0.0;   ///< its largest displacement error, if asked for [m]
};

struct LawSettings
{
  law::Settings solver;
  std::vector<law::BenchmarkCase> compare;  ///< other solvers, timed on the same problems
  core::Ledger* ledger = nullptr;
};

/// Meets the laws of one system of rows with the isolated compliance of a factor: solves
/// δ = W λ + g, (δ, λ) in the laws, for one free motion after the other.
class Laws
{
 public:
  /// Borrows all three.
  Laws(System& system, const LawSettings& settings, LawReport& report)
      : system_(&system), settings_(&settings), report_(&report)
  {
  }

  /// Solves for the multipliers. `free`: free motion of the probes from the place where gaps were
  /// measured [m]. The solver starts from the multipliers of the last call, in the first call from
  /// `start` [N]. Refused when the laws cannot be met; the reason names the place of a row that
  /// nothing can move. Collective.
  Outcome<Done> meet(solve::LaggedFactor& factor, const core::VecX& free, const core::VecX& start);
  /// Makes C and W for this factor, unless they are there already. Collective.
  void use(solve::LaggedFactor& factor);

  const System& system() const { return *system_; }
  const LawSettings& settings() const { return *settings_; }
  LawReport& report() { return *report_; }
  const core::MatX& compliance() const { return C_; }  ///< C of the probes [m/N]
  const law::Problem& problem() const { return problem_; }
  const core::VecX& multipliers() const { return answer_.lambda; }  ///< [N]; empty before `meet`
  law::Multipliers take() { return std::exchange(answer_, {}); }
  /// True when every row holds or slips as in the call of `meet` before.
  bool same_states() const { return same_states_; }

 private:
  System* system_;
  const LawSettings* settings_;
  LawReport* report_;
  int version_ = 0;  ///< of the factor that C belongs to; 0: none
  core::MatX C_, W_;
  law::Problem problem_;
  law::Multipliers answer_;
  bool same_states_ = false;
};

}  // namespace trocar::constraint
