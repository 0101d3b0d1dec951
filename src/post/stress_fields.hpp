#pragma once

#include <vector>

#include "io/results.hpp"
#include "step/step.hpp"

namespace trocar::post {

/// The stress fields that the user asked for. No other field is computed.
struct StressOutput
{
  bool stress = false, von_mises = false, principal_stress = false, strain_energy = false;
  bool nodal_stress = false;  ///< means over the tets around every node

  bool any() const
  {
    return stress || von_mises || principal_stress || strain_energy || nodal_stress;
  }
};

/// Makes the wanted fields: /stress (tets, 6; Cauchy: xx, yy, zz, xy, yz, xz), /von_mises (tets),
/// /principal_stress (tets, 3; descending), /strain_energy (tets), /nodal_stress (nodes, 6;
/// volume-weighted means over the tets around a node). Rank 0 gets the fields, other ranks get an
/// empty list. Collective.
std::vector<io::Field> stress_fields(const step::Model& model, const step::State& state,
                                     const StressOutput& wanted);

}  // namespace trocar::post
