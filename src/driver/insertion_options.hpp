#pragma once

#include "driver/scenario.hpp"

namespace trocar::driver {

/// Reads friction, placement, tip and puncture. Throws Failure (64) for options of one placement
/// that are given with another.
insertion::InsertionSettings read_insertion(core::Options& options, const mesh::Mesh& mesh);

/// Adds the correction for thin shafts, by the elements and needles of the scenario.
void add_radius_correction(Scenario& scenario);

}  // namespace trocar::driver
