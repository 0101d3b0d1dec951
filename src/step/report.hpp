#pragma once

#include <vector>

#include "constraint/laws.hpp"
#include "insertion/coupling.hpp"
#include "step/state.hpp"

namespace trocar::step {

using core::Vec3;

/// What one needle did in a step.
struct NeedleReport
{
  Vec3 tip = Vec3::Zero();  ///< [m]
  double depth = 0.0;       ///< inserted path length in tissue [m]
  needle::Wrench base;      ///< by the holder on the needle
  insertion::CouplingReport coupling;
};

/// Figures of an accepted step, for log and histories. Equal on every rank.
struct StepReport : constraint::LawReport
{
  std::vector<NeedleReport> needles;
  std::vector<cavity::CavityReport> cavities;
  tissue::Reactions holders;  ///< of prescribed displacements and supports
  int pressure_updates = 0;   ///< of frozen cavities
  int linearisations = 0;
  double unbalanced = 0.0;  ///< what the end of the step leaves, see docs/theory.md section 1
  int folded = -1;          ///< tet that linear tissue was allowed to fold; -1: none
};

}  // namespace trocar::step
