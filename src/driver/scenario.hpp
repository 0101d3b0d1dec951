#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/comm.hpp"
#include "core/options.hpp"
#include "post/pv_curve.hpp"
#include "post/stress_fields.hpp"
#include "step/scene.hpp"

namespace trocar::driver {

struct OutputSettings
{
  std::string folder;
  int every = 1;
  bool displacement = true;
  bool velocity = false;
  post::StressOutput stress;
  bool error_estimate = false;
  double error_target = 0.0;  ///< of the energy norm, 0: none
  std::string size_field;     ///< file for the sizes of the next mesh; empty: none
  bool locking_gauge = false;
  bool quiet = false;
};

/// When checkpoints are made, and what a run may take.
struct CheckpointSettings
{
  int every = 0;         ///< steps, 0: never
  double seconds = 0.0;  ///< wall time between two [s], 0: never
  double wall = 0.0;     ///< wall time after which the run ends with one [s], 0: never
};

/// The checkpoint a run goes on from.
struct RestartSettings
{
  std::string folder;   ///< with the checkpoint; empty: the run begins at the start
  bool branch = false;  ///< the results go to another folder
};

/// Everything a run is told: a scene, and what is to be done with it. Made once from the options;
/// nothing reads an option later.
struct Scenario : step::Scene
{
  std::optional<post::PvSettings> pv{};  ///< instead of a run through time
  OutputSettings output{};
  CheckpointSettings checkpoint{};
  RestartSettings restart{};
  bool check_only = false;
  std::vector<std::string> warnings{};  ///< for the log
};

/// Reads and checks all options and the files they name. Throws Failure (64 or 65) on every rank.
/// Collective.
Scenario read_scenario(core::Options& options, const base::Comm& comm);

}  // namespace trocar::driver
