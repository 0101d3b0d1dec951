#pragma once

#include <string>
#include <vector>

#include "driver/scenario.hpp"
#include "io/checkpoint.hpp"

namespace trocar::driver {

/// Reads -restart and -restart_from. With -restart, `output_folder` becomes the folder of the
/// checkpoint. Failure (64) when -output_dir names another one, or when a branch would write into
/// the folder of its checkpoint.
RestartSettings read_restart_settings(core::Options& options, std::string& output_folder);

/// The options as the run used them, with the FNV-1a of the contents of every file that they name.
/// Call on one rank only.
std::vector<io::Checkpoint::Option> options_with_hashes(
    const std::vector<core::ResolvedOption>& resolved, const mesh::Mesh& mesh);

/// Reads the checkpoint from which a scenario continues. It is complete on rank 0; other ranks have
/// its time and ledger only. Failure (65) when it cannot be read, (64) when an option differs that
/// must not: mesh, materials, loads, needles and steps stay the same. A branch may move the needles
/// differently. Collective.
io::Checkpoint read_restart(const Scenario& scenario,
                            const std::vector<core::ResolvedOption>& resolved,
                            const base::Comm& comm);

/// Sets the steps of a run that continues. The step length stays that of the checkpoint, so the run
/// ends with the first step at or after a new -time_end. Failure (64) when the new end lies before
/// the checkpoint. False when no step is left.
bool continue_time(const io::Checkpoint::Time& from, Scenario& scenario);

/// Throws Failure (64) when the base of a needle would jump at the checkpoint. A branch may change
/// how needles move, but only from where they are.
void refuse_jumps(const std::vector<needle::NeedleSettings>& needles, const step::State& state);

}  // namespace trocar::driver
