#pragma once

#include <string>
#include <vector>

#include "driver/scenario.hpp"
#include "io/checkpoint.hpp"

namespace trocar::driver {

/// Reads where a run goes on from. One that goes on in a folder has that for its results. Failure
/// (64) where a branch would write into the folder that it begins with.
RestartSettings read_restart_settings(core::Options& options, std::string& output_folder);

/// Options as they were used, with what was in the files that they name. For one rank alone.
std::vector<io::Checkpoint::Option> options_with_hashes(
    const std::vector<core::ResolvedOption>& resolved);

/// The checkpoint that a scenario goes on from, complete on rank 0; its time and ledger on every
/// rank. Failure (65) where it cannot be read, (64) where an option differs that may not: what a
/// run goes on with is the same mesh, the same materials and the same needles. A branch may move
/// these otherwise. Collective.
io::Checkpoint read_restart(const Scenario& scenario,
                            const std::vector<core::ResolvedOption>& resolved,
                            const base::Comm& comm);

/// Keeps the checkpoint's step length: a new end is met by the first step at or after it. False
/// when no step is left.
bool continue_time(const io::Checkpoint::Time& from, Scenario& scenario);

/// A branch may move needles otherwise, but from where they are: Failure (64).
void refuse_jumps(const std::vector<needle::NeedleSettings>& needles, const step::State& state);

}  // namespace trocar::driver
