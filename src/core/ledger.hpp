#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace trocar::core {

/// Exact counts of the work done. Collective work counts once, not once per rank.
struct Ledger
{
  std::int64_t assemblies = 0;          ///< assemblies of the tissue operator
  std::int64_t factorisations = 0;      ///< numeric factorisations or preconditioner set-ups
  std::int64_t solves = 0;              ///< solves with one full right-hand side
  std::int64_t half_sweeps = 0;         ///< forward or backward triangular solves
  std::int64_t columns_built = 0;       ///< columns of A⁻¹ computed for probes
  std::int64_t columns_reused = 0;      ///< columns served from the cache
  std::int64_t constraint_solves = 0;   ///< dense constraint problems solved
  std::int64_t surface_passes = 0;      ///< passes over the walls of cavities
  std::int64_t pressure_updates = 0;    ///< updates of the pressures of frozen cavities
  std::int64_t contact_queries = 0;     ///< pairs of surfaces clipped with each other
  std::int64_t stress_evaluations = 0;  ///< stress fields computed for output
  std::int64_t steps = 0;               ///< accepted steps
  std::int64_t rejected_steps = 0;      ///< rejected steps, usually retried in halves
  std::int64_t repeated_steps = 0;      ///< BDF2 steps made again with backward Euler, see step.cpp

  using Count = std::int64_t Ledger::*;
  static constexpr std::array<std::pair<std::string_view, Count>, 14> members()
  {
    return {{{"assemblies", &Ledger::assemblies},
             {"factorisations", &Ledger::factorisations},
             {"solves", &Ledger::solves},
             {"half_sweeps", &Ledger::half_sweeps},
             {"columns_built", &Ledger::columns_built},
             {"columns_reused", &Ledger::columns_reused},
             {"constraint_solves", &Ledger::constraint_solves},
             {"surface_passes", &Ledger::surface_passes},
             {"pressure_updates", &Ledger::pressure_updates},
             {"contact_queries", &Ledger::contact_queries},
             {"stress_evaluations", &Ledger::stress_evaluations},
             {"steps", &Ledger::steps},
             {"rejected_steps", &Ledger::rejected_steps},
             {"repeated_steps", &Ledger::repeated_steps}}};
  }
  std::array<std::pair<std::string_view, std::int64_t>, 14> entries() const
  {
    std::array<std::pair<std::string_view, std::int64_t>, 14> all;
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = {members()[i].first, this->*members()[i].second};
    return all;
  }
};

}  // namespace trocar::core
