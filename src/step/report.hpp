#pragma once

#include <optional>
#include <string>
#include <vector>

#include "law/compare.hpp"
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
struct StepReport
{
  std::vector<NeedleReport> needles;
  std::vector<cavity::CavityReport> cavities;
  tissue::HolderForces holders;            ///< of prescribed displacements and supports
  int pressure_updates = 0;                ///< of frozen cavities
  int rows = 0, rank = 0, iterations = 0;  ///< of the last constraint problem; iterations summed
  double residual = 0.0;                   ///< worst of the step [m]
  double unbalanced = 0.0;                 ///< tissue::Balance::worst at the end of the step
  int folded = -1;                         ///< tet that linear tissue was allowed to fold; -1: none
  double condition = 0.0;                  ///< see law::Multipliers
  int outer = 0;                           ///< most solves that state-dependent bounds took
  double contraction = 0.0;                ///< worst ratio of their last two changes
  bool nonunique = false;
  std::vector<law::Trial> trials;      ///< of the solvers compared
  solve::ComplianceReport compliance;  ///< sums over the step's linearisations
  int linearisations = 0;
  double leftover_gap = 0.0;  ///< what the laws with a stale compliance leave of the gaps [m]
  double stale_error = 0.0;   ///< worst displacement error of that, on request [m]
  int passes = 0;  ///< sweeps with the laws behind them: one each, more with an older factor
};

/// An accepted new state, or why the step was rejected. Agreed by all ranks.
struct StepResult
{
  std::optional<State> state;
  StepReport report;
  std::string why;

  static StepResult rejected(const std::string& why) { return {std::nullopt, {}, why}; }
};

}  // namespace trocar::step
