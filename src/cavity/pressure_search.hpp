#pragma once

#include <map>

#include "cavity/frozen.hpp"
#include "cavity/rows.hpp"
#include "constraint/saddle.hpp"

namespace trocar::cavity {

/// Search for the pressures of frozen cavities (fluid paper). Each update loads the tissue with
/// Σ p g_0, meets the laws of all rows, and compares the volumes of the deformed walls with those
/// of the fluids.
class PressureSearch
{
 public:
  /// Borrows both.
  PressureSearch(const Cavities& cavities, core::Ledger& ledger)
      : cavities_(&cavities), ledger_(&ledger)
  {
  }

  /// Returns the saddle point of a linearisation whose factor is that of A, and stores the
  /// pressures in `state`. Refused when the volumes are not reached. Collective.
  core::Outcome<constraint::Saddle> solve(constraint::Laws& laws, solve::Linearisation& at,
                                          const VecX& start, const TimeStep& now, State& state);
  int updates() const { return updates_; }  ///< updates of the pressures in the last search

 private:
  const PressureResponses& unit_pressure_responses(const State& state, const TimeStep& now,
                                                   solve::LaggedFactor& factor);
  PressureResponses with_rows(const constraint::Laws& laws, const PressureResponses& alone,
                              solve::LaggedFactor& factor) const;

  const Cavities* cavities_;
  core::Ledger* ledger_;
  std::map<core::Rates, PressureResponses> responses_;  ///< of the tissue alone, by operator
  int updates_ = 0;
};

}  // namespace trocar::cavity
