#include "insertion/ring.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "insertion/clip.hpp"

namespace trocar::insertion {
namespace {

constexpr double touch = 1e-6;  ///< of the way: spans closer than this touch

/// The way from the axis to a point of the ring.
struct Way
{
  struct Passage
  {
    Span span;
    int tet;
  };
  std::vector<Passage> passages;  ///< by ascending tet
  double reach = 0.0;             ///< largest part, at most 1, that lies in the body without a gap
};

Way way_of(const Ground& ground, const Vec3& X, int tet, const Vec3& offset)
{
  const Vec3 end = X + offset;
  const Vec3 margin = Vec3::Constant(touch * offset.norm());
  Way way;
  for (int other : ground.locator.in_box(X.cwiseMin(end) - margin, X.cwiseMax(end) + margin)) {
    if (ground.body(other) != ground.body(tet)) continue;
    const auto span = clip_line(mesh::corners(ground.mesh, other), X, end);
    if (span && span->high > 0.0 && span->low < 1.0) way.passages.push_back({*span, other});
  }
  std::vector<Span> spans;
  for (const Way::Passage& passage : way.passages) spans.push_back(passage.span);
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.low < b.low; });
  for (const Span& span : spans) {
    if (span.low > way.reach + touch) break;
    way.reach = std::max(way.reach, span.high);
  }
  way.reach = std::min(way.reach, 1.0);
  return way;
}

/// The place at a part of the way. On a face the displacement is the same in both tets.
constraint::Anchor place_on(const Ground& ground, const Way& way, double part, const Vec3& X,
                            int tet)
{
  for (const Way::Passage& passage : way.passages)
    if (part >= passage.span.low - touch && part <= passage.span.high + touch)
      return anchor_at(ground.mesh, passage.tet, X);
  return anchor_at(ground.mesh, tet, X);
}

}  // namespace

constraint::Anchor ring_around(const Ground& ground, const Vec3& X, int tet, const Vec3& axis,
                               const Ring& ring)
{
  constexpr double phase = 0.3;  // keeps points off the planes of structured meshes
  const Vec3 across = axis.unitOrthogonal();
  const Vec3 other = axis.cross(across);
  const int pairs = ring.points / 2;
  std::map<int, double> weight;
  for (int k = 0; k < pairs; ++k) {
    const double angle = phase + std::numbers::pi * k / pairs;
    const Vec3 offset = ring.radius * (std::cos(angle) * across + std::sin(angle) * other);
    const Way there = way_of(ground, X, tet, offset), back = way_of(ground, X, tet, -offset);
    const double part = std::min(there.reach, back.reach);
    for (const auto& [way, sign] : {std::pair(&there, 1.0), std::pair(&back, -1.0)}) {
      const constraint::Anchor at = place_on(ground, *way, part, X + sign * part * offset, tet);
      for (std::size_t a = 0; a < at.node.size(); ++a)
        if (const double w = at.weight[static_cast<Eigen::Index>(a)]; w != 0.0)
          weight[at.node[a]] += 0.5 * w / pairs;
    }
  }
  return constraint::anchor_of(weight);
}

}  // namespace trocar::insertion
