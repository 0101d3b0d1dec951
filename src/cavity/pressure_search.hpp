#pragma once

#include <map>

#include "cavity/frozen.hpp"
#include "cavity/rows.hpp"
#include "constraint/saddle.hpp"

namespace trocar::cavity {

/// The frozen model's search for pressures around the laws of all other rows (fluid paper): the
/// tissue is moved by p g_0 until the exact volumes are those of the fluids.
class PressureSearch
{
 public:
  /// Borrows both.
  PressureSearch(const Cavities& cavities, core::Ledger& ledger)
      : cavities_(&cavities), ledger_(&ledger)
  {
  }

  /// The saddle point of a linearisation with its own factor, and the pressures into `state`.
  /// Refused when the volumes are not reached. Collective.
  core::Outcome<constraint::Saddle> solve(constraint::Laws& laws, solve::Linearisation& at,
                                          const VecX& start, const TimeStep& now, State& state);
  int updates() const { return updates_; }  ///< of the pressures in the last search

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
