#include "insertion/clip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/mesh.hpp"

namespace trocar::insertion {

std::optional<Span> clip_line(const std::array<core::Vec3, 4>& corner, const core::Vec3& P,
                              const core::Vec3& Q)
{
  const Eigen::Vector4d at_P = mesh::barycentric(corner, P);
  const Eigen::Vector4d at_Q = mesh::barycentric(corner, Q);
  const Eigen::Vector4d slope = at_Q - at_P;
  constexpr double in_plane = 1e-6, parallel = 1e-15;
  Span span{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int a = 0; a < 4; ++a) {
    // A segment with both ends within 1e-6 of a height from the face lies in the face: where it
    // crosses would be round-off. A line parallel to the face is only tested for its side.
    const bool in_face = std::abs(at_P[a]) <= in_plane && std::abs(at_Q[a]) <= in_plane;
    if (in_face || std::abs(slope[a]) <= parallel) {
      if (at_P[a] < -in_plane) return std::nullopt;
      continue;
    }
    const double t = -at_P[a] / slope[a];
    if (slope[a] > 0.0)
      span.low = std::max(span.low, t);
    else
      span.high = std::min(span.high, t);
  }
  if (!(span.low <= span.high)) return std::nullopt;
  return span;
}

}  // namespace trocar::insertion
