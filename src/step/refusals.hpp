#pragma once

#include <optional>
#include <string>

#include "core/outcome.hpp"
#include "step/rows.hpp"

// Reasons why a step is refused, as messages with the place and with what may help.
namespace trocar::step {

/// Message about an inverted element of the tissue. `tet`: its index in file order.
std::string inverted_at(const Scene& scene, int tet);

/// Message about bodies that supports leave free in statics, and that no contact holds.
std::string not_held(const Model& model);

/// For a row that nothing can move: names its needle or cavity, and the place.
std::string place_of(const Scene& scene, const Solution& solution, int row);

/// Refuses an equilibrium in which supports and loads differ by more than 1e-6 of the forces, if
/// the contrast of stiffness explains it. Rounding errors of stiff volumes are then larger than
/// 1e-6 of the forces in soft ones, and more iterations do not help.
std::optional<core::Refusal> cannot_stand(const Scene& scene, const core::TimeStep& now,
                                          const tissue::Balance& balance);

/// Refuses a state with a cavity whose volume is not positive: its walls went through each other,
/// because contact of walls is not modelled.
std::optional<core::Refusal> collapsed(const Scene& scene, const StepReport& report);

}  // namespace trocar::step
