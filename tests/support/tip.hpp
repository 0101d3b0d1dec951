#pragma once

#include "support/scene.hpp"

namespace trocar::test {

/// The distorted block with a needle that needs these forces [N] to pierce its surface and to cut
/// it.
driver::Scenario scene(double puncture, double cutting);

/// The block in two layers with their border at x = 3 cm.
driver::Scenario layered();

}  // namespace trocar::test
