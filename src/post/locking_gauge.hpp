#pragma once

#include <vector>

#include "step/scene.hpp"

namespace trocar::post {

/// dP/dV of every cavity with the tets of the scene, divided by dP/dV with quadratic tets that do
/// not lock (p2_bbar, as expensive as p2) on the same mesh. Both are found in linear tissue at
/// rest, with the supports of the scene and pressure in one cavity at a time. Makes two factors,
/// which the ledger of the run does not count. Collective.
std::vector<double> locking_ratios(const step::Scene& scene, const base::Comm& comm);

}  // namespace trocar::post
