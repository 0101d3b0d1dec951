#pragma once

#include <optional>
#include <string>

#include "core/outcome.hpp"
#include "step/rows.hpp"

// Why a step is not taken, in words: where it is, and what may help.
namespace trocar::step {

/// An element of the tissue that is turned inside out (file tet).
std::string inverted_at(const Scene& scene, int tet);

/// What a row belongs to and where it is, when nothing can move it.
std::string place_of(const Scene& scene, const Solution& solution, int row);

/// Stiff parts round off what soft ones carry. Beyond what could be mended by iterating, supports
/// and loads differ.
std::optional<core::Refusal> cannot_stand(const Scene& scene, const core::TimeStep& now,
                                          const tissue::Balance& balance);

/// Walls that have gone through each other: nothing keeps them apart.
std::optional<core::Refusal> collapsed(const Scene& scene, const StepReport& report);

}  // namespace trocar::step
