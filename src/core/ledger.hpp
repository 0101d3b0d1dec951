#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace trocar::core {

/// Exact count of the work done; collective work counts once, not per rank.
struct Ledger
{
  std::int64_t assemblies = 0;          ///< fills of the tissue operator
  std::int64_t factorisations = 0;      ///< numeric factorisations (preconditioner set-ups) of it
  std::int64_t solves = 0;              ///< solves with one full right-hand side
  std::int64_t half_sweeps = 0;         ///< forward or backward half-solves
  std::int64_t columns_built = 0;       ///< columns of A⁻¹ computed for probes
  std::int64_t columns_reused = 0;      ///< columns served from the cache
  std::int64_t constraint_solves = 0;   ///< dense constraint problems solved
  std::int64_t surface_passes = 0;      ///< passes over the walls of cavities
  std::int64_t pressure_updates = 0;    ///< of frozen cavities, outside the constraint problem
  std::int64_t contact_queries = 0;     ///< narrow-phase contact queries
  std::int64_t stress_evaluations = 0;  ///< stress fields computed for output
  std::int64_t steps = 0;               ///< accepted steps
  std::int64_t rejected_steps = 0;      ///< steps retried with a smaller h

  std::array<std::pair<std::string_view, std::int64_t>, 13> entries() const
  {
    return {{{"assemblies", assemblies},
             {"factorisations", factorisations},
             {"solves", solves},
             {"half_sweeps", half_sweeps},
             {"columns_built", columns_built},
             {"columns_reused", columns_reused},
             {"constraint_solves", constraint_solves},
             {"surface_passes", surface_passes},
             {"pressure_updates", pressure_updates},
             {"contact_queries", contact_queries},
             {"stress_evaluations", stress_evaluations},
             {"steps", steps},
             {"rejected_steps", rejected_steps}}};
  }
};

}  // namespace trocar::core
