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
  const double edges = (Q - P).norm() / mesh::longest_edge(corner);
  Span span{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int a = 0; a < 4; ++a) {
    // Relative to the line's length in edges: how steeply it leaves the face's plane. Up to 1e-6
    // of an edge outside counts as inside.
    if (std::abs(slope[a]) <= 1e-9 * edges) {
      if (at_P[a] < -1e-6) return std::nullopt;
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
