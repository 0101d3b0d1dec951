#pragma once

#include <vector>

#include "constraint/laws.hpp"
#include "contact/contacts.hpp"
#include "insertion/coupling.hpp"
#include "step/state.hpp"

namespace trocar::step {

using core::Vec3;

/// What one needle did in a step.
struct NeedleReport
{
  Vec3 tip = Vec3::Zero();  ///< place of the tip [m]
  double depth = 0.0;       ///< inserted path length in tissue [m]
  needle::Wrench base;      ///< force and moment of the holder on the needle
  insertion::CouplingReport coupling;
};

/// Results of an accepted step for log and histories. Equal on every rank.
struct StepReport : constraint::LawReport
{
  std::vector<NeedleReport> needles;
  std::vector<cavity::CavityReport> cavities;
  std::vector<contact::PairReport> contact;
  tissue::Reactions holders;  ///< forces on the tissue by its holders, see tissue::Reactions [N]
  int pressure_updates = 0;   ///< most pressure updates of frozen cavities in a linearisation
  int linearisations = 0;
  double unbalanced = 0.0;  ///< part of the forces left unbalanced, see docs/theory.md section 1
  int folded = -1;          ///< inverted tet of linear tissue, allowed (file order); -1: none
};

}  // namespace trocar::step
