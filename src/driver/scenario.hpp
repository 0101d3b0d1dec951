#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/comm.hpp"
#include "cavity/settings.hpp"
#include "core/options.hpp"
#include "insertion/insertion.hpp"
#include "law/compare.hpp"
#include "mesh/mesh.hpp"
#include "needle/needle.hpp"
#include "tissue/tissue.hpp"

namespace trocar::driver {

enum class Analysis { dynamic, equilibrium, pv_curve };

struct TimeSettings
{
  Analysis analysis = Analysis::dynamic;
  double step = 0.01;   ///< h [s]: T over a whole number
  double end = 0.0;     ///< T [s]
  double asked = 0.01;  ///< h as it was asked for [s]
  bool start_in_equilibrium = false;
  bool second_order = false;  ///< BDF2 instead of backward Euler
  int newton_max = 0;         ///< linearisations per dynamic step; 0: as many as it takes
  int direction_max = 1;      ///< updates of the constraint directions per linearisation
};

/// Number of steps to the end.
long step_count(const TimeSettings& time);

/// A P-V curve: equilibria with a cavity held at volumes between two parts of that of the mesh.
struct PvSettings
{
  int cavity = 0;
  double low = 0.7, high = 1.3;
  int points = 25;
  int pieces = 4;  ///< of the second fit
};

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

struct OutputSettings
{
  std::string folder;
  int every = 1;
  bool displacement = true;
  bool velocity = false;
  StressOutput stress;
  bool energy = false;  ///< keep the energy account
  bool error_estimate = false;
  double error_target = 0.0;  ///< of the energy norm, 0: none
  std::string size_field;     ///< file for the sizes of the next mesh; empty: none
  bool locking_gauge = false;
  bool stale_error = false;  ///< solve stale steps exactly as well
  bool quiet = false;
};

/// Everything a run is told, in SI units. Made once from the options; nothing reads an option
/// later.
struct Scenario
{
  mesh::Mesh mesh;
  TimeSettings time;
  tissue::TissueSettings tissue;
  std::vector<needle::NeedleSettings> needles;
  insertion::InsertionSettings insertion;
  cavity::Settings cavities;
  PvSettings pv;
  law::Settings laws;
  std::vector<law::Contender> compare;  ///< solvers to be timed beside it
  OutputSettings output;
  bool check_only = false;
  std::vector<std::string> warnings;  ///< for the log
};

/// Reads and checks all options and the files they name. Throws Failure (64 or 65) on every rank.
/// Collective.
Scenario read_scenario(core::Options& options, const base::Comm& comm);

}  // namespace trocar::driver
