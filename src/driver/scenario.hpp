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
  bool contact = false;  ///< gap, pressure, traction and state at the corners of slave surfaces
  post::StressOutput stress;
  bool error_estimate = false;
  double error_target = 0.0;  ///< target of the error relative to the energy norm; 0: none
  std::string size_field;     ///< file for the sizes of the next mesh; empty: none
  bool locking_gauge = false;
  bool quiet = false;

  bool fields() const { return displacement || velocity || contact || stress.any(); }
};

/// When checkpoints are written, and how long a run may take.
struct CheckpointSettings
{
  int every = 0;         ///< steps from one checkpoint to the next; 0: no such checkpoints
  double seconds = 0.0;  ///< wall time from one checkpoint to the next [s]; 0: no such checkpoints
  double wall = 0.0;  ///< wall time after which the run writes a checkpoint and ends [s]; 0: none
};

/// The checkpoint from which a run continues.
struct RestartSettings
{
  std::string folder;   ///< folder of the checkpoint; empty: the run begins at the start
  bool branch = false;  ///< the results go to `output_dir`, not to `folder`
};

/// All input of a run: a scene, and what to compute and write. Made once from the options; no
/// option is read later.
struct Scenario : step::Scene
{
  std::optional<post::PvSettings> pv{};  ///< if set, a P-V sweep replaces the run through time
  OutputSettings output{};
  CheckpointSettings checkpoint{};
  RestartSettings restart{};
  bool check_only = false;
  std::vector<std::string> warnings{};  ///< lines for the log
};

/// Reads and checks all options and the files they name. Throws Failure (64 or 65) on every rank.
/// Collective.
Scenario read_scenario(core::Options& options, const base::Comm& comm);

}  // namespace trocar::driver
