#pragma once

#include <vector>

#include "step/scene.hpp"

namespace trocar::post {

/// dP/dV of every cavity over that with quadratic tets that do not lock (p2_bbar, which costs what
/// p2 costs), on the same mesh, in linear tissue at rest with the supports of the scene, each
/// cavity by itself. Costs a factor of each; no run's ledger counts them. Collective.
std::vector<double> locking_ratios(const step::Scene& scene, const base::Comm& comm);

}  // namespace trocar::post
