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

/// How the laws of rows are met, and what it took: sums over the linearisations of a step.
struct LawReport
{
  int rows = 0, rank = 0, iterations = 0;  ///< of the last problem; iterations summed
  double residual = 0.0;                   ///< worst true KKT residual [m]
  double condition = 0.0;                  ///< see law::Multipliers
  int outer = 0;                           ///< most solves that state-dependent bounds took
  double contraction = 0.0;                ///< worst ratio of their last two changes
  bool nonunique = false;
  std::vector<law::BenchmarkResult> trials{};  ///< of the solvers compared
  solve::ComplianceReport compliance{};        ///< sums over the linearisations
  int passes = 0;                              ///< sweeps with the laws behind them
  double leftover_gap = 0.0;  ///< what the laws with a stale compliance leave of the gaps [m]
  double stale_error = 0.0;   ///< worst displacement error of that, on request [m]
};

struct LawSettings
{
  law::Settings solver;
  std::vector<law::BenchmarkCase> compare;  ///< solvers timed beside it
  core::Ledger* ledger = nullptr;
};

/// The laws of one system of rows on the isolated compliance of a factor: δ = W λ + g, (δ, λ) in
/// the laws, for one free motion after the other.
class Laws
{
 public:
  /// Borrows all.
  Laws(System& system, const LawSettings& settings, LawReport& report)
      : system_(&system), settings_(&settings), report_(&report)
  {
  }

  /// Multipliers for the free motion `free` of the probes [m], from where gaps were measured,
  /// beginning with those of the last call or, at first, with `start`. Refused when the laws are
  /// not met, with the row's place where nothing can move it. Collective.
  Outcome<Done> meet(solve::LaggedFactor& factor, const core::VecX& free, const core::VecX& start);
  /// W and C for this factor, when they are not yet. Collective.
  void use(solve::LaggedFactor& factor);

  const System& system() const { return *system_; }
  const LawSettings& settings() const { return *settings_; }
  LawReport& report() { return *report_; }
  const core::MatX& compliance() const { return C_; }  ///< C of the probes [m/N]
  const law::Problem& problem() const { return problem_; }
  const core::VecX& multipliers() const { return answer_.lambda; }  ///< [N]; empty: not met yet
  law::Multipliers take() { return std::exchange(answer_, {}); }
  /// Every row holds or slips as in the call before.
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
