#pragma once

#include <array>
#include <optional>

#include "core/math.hpp"

namespace trocar::insertion {

/// Part of the line through P (t = 0) and Q (t = 1) inside a tet.
struct Span
{
  double low, high;
};

/// Clips the infinite line P + t (Q - P) against a tet: the interval in which all barycentric
/// coordinates, linear in t, are non-negative. A coordinate that hardly changes along the line
/// (parallel to its face) only says yes or no, with room for round-off, so that a line in a face
/// plane belongs to the tets on both sides. Empty when the line misses the tet.
std::optional<Span> clip_line(const std::array<core::Vec3, 4>& corner, const core::Vec3& P,
                              const core::Vec3& Q);

}  // namespace trocar::insertion
