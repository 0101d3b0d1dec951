#pragma once

#include <vector>

#include "io/results.hpp"
#include "step/step.hpp"

namespace trocar::post {

/// Fields of stress, made only when asked for.
struct StressOutput
{
  bool stress = false, von_mises = false, principal_stress = false, strain_energy = false;
  bool nodal_stress = false;  ///< means of the tets around every node

  bool any() const
  {
    return stress || von_mises || principal_stress || strain_energy || nodal_stress;
  }
};

/// The fields that are asked for: /stress (tets, 6; Cauchy: xx, yy, zz, xy, yz, xz), /von_mises,
/// /principal_stress (tets, 3; falling), /strain_energy (tets), /nodal_stress (nodes, 6; means of
/// the tets around a node by volume). On rank 0; other ranks get none. Collective.
std::vector<io::Field> stress_fields(const step::Model& model, const step::State& state,
                                     const StressOutput& wanted);

}  // namespace trocar::post
