#pragma once

#include "support/scene.hpp"

namespace trocar::test {

/// The distorted block with a needle that needs these forces [N] to pierce its surface and to cut
/// it.
step::Scene scene(double puncture, double cutting);

/// The block in two layers with their border at x = 3 cm.
step::Scene layered();

}  // namespace trocar::test
