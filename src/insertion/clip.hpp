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

/// Clips the infinite line P + t (Q - P) against a tet: returns the interval of t in which all
/// barycentric coordinates are non-negative; nothing when the line misses the tet. A line parallel
/// to a face is tested for its side with a tolerance of 1e-6 of the height. So a line in the plane
/// of a face belongs to the tets on both sides.
std::optional<Span> clip_line(const std::array<core::Vec3, 4>& corner, const core::Vec3& P,
                              const core::Vec3& Q);

}  // namespace trocar::insertion
