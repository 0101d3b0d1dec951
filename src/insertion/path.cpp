#include "insertion/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "insertion/clip.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::insertion {
namespace {

/// A tet that the line of a segment passes through, from t = low to high (segment: 0 to 1).
struct Passage
{
  int tet;
  double low, high;
  double tolerance;  ///< `arc_tolerance` over the length of the segment
};

std::vector<Passage> passages(const Field& field, const Vec3& P, const Vec3& Q)
{
  const mesh::Mesh& mesh = field.mesh;
  std::vector<Passage> found;
  const double length = (Q - P).norm();
  const Vec3 margin = Vec3::Constant(1e-9 + 1e-3 * length);
  for (int tet : field.locator.in_box(P.cwiseMin(Q) - margin, P.cwiseMax(Q) + margin)) {
    if (!field.has(tet)) continue;
    const auto span = clip_line(mesh::corners(mesh, tet), P, Q);
    const double tolerance = arc_tolerance(mesh, tet) / length;
    if (!span || span->high - span->low <= tolerance) continue;  // grazes a vertex or an edge
    if (span->high < -tolerance || span->low > 1.0 + tolerance) continue;
    found.push_back({tet, span->low, span->high, tolerance});
  }
  return found;
}

/// A face crossing on the segment, 0 <= t <= 1.
struct Crossing
{
  double t;
  double tolerance;
};

/// Distinct crossings in order. Both tets of a face report it, and many tets report a vertex.
std::vector<Crossing> crossings_of(const std::vector<Passage>& passages)
{
  std::vector<Crossing> all;
  for (const Passage& p : passages)
    for (double t : {p.low, p.high})
      if (t >= -p.tolerance && t <= 1.0 + p.tolerance)
        all.push_back({std::clamp(t, 0.0, 1.0), p.tolerance});
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  std::vector<Crossing> distinct;
  for (const Crossing& c : all)
    if (distinct.empty() ||
        c.t - distinct.back().t > std::min(c.tolerance, distinct.back().tolerance))
      distinct.push_back(c);
  return distinct;
}

int lowest_tet_at(const std::vector<Passage>& passages, double t, double slack_factor)
{
  for (const Passage& p : passages)  // ascending tets: the lowest wins a tie
    if (t >= p.low - slack_factor * p.tolerance && t <= p.high + slack_factor * p.tolerance)
      return p.tet;
  return -1;
}

void add_pieces(Path& path, const std::vector<Passage>& passages,
                const std::vector<Crossing>& crossings, double begin, double length)
{
  std::vector<double> cuts{0.0};
  for (const Crossing& c : crossings)
    // A crossing within the tolerance of the last cut or of the end would make a sliver: no cut.
    if (c.t > cuts.back() + c.tolerance && c.t < 1.0 - c.tolerance) cuts.push_back(c.t);
  cuts.push_back(1.0);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double middle = 0.5 * (cuts[i] + cuts[i + 1]);
    const double end = i + 2 == cuts.size() ? begin + length : begin + cuts[i + 1] * length;
    const double start = path.pieces.empty() ? begin : path.pieces.back().end;
    path.pieces.push_back({start, end, lowest_tet_at(passages, middle, 0.0)});
  }
}

void add_site(Path& path, const mesh::Mesh& mesh, int tet, double arc, const Vec3& X)
{
  path.sites.push_back({arc, tet, anchor_at(mesh, tet, X)});
}

/// A place where a site may stand, 0 <= t <= 1: a crossing or, in a quadratic tet, the middle of
/// the passage.
struct Candidate
{
  double t;
  int tet;
  double tolerance;
};

std::vector<Candidate> candidates(const mesh::Mesh& mesh, const std::vector<Passage>& passages,
                                  const std::vector<Crossing>& crossings)
{
  std::vector<Candidate> all;
  for (const Crossing& c : crossings)
    all.push_back({c.t, lowest_tet_at(passages, c.t, 1.0), c.tolerance});
  if (!mesh.quadratic()) return all;
  for (const Passage& p : passages) {
    const double middle = 0.5 * (p.low + p.high);
    if (middle >= -p.tolerance && middle <= 1.0 + p.tolerance)
      all.push_back({std::clamp(middle, 0.0, 1.0), p.tet, p.tolerance});
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return all;
}

}  // namespace

double local_edge(const mesh::Mesh& mesh, int tet)
{
  return (mesh.quadratic() ? 0.5 : 1.0) * mesh::mean_edge(mesh::corners(mesh, tet));
}

double arc_tolerance(const mesh::Mesh& mesh, int tet)
{
  return relative_tolerance * local_edge(mesh, tet);
}

void grow(Path& path, const Vec3& X, const Field& field)
{
  const mesh::Mesh& mesh = field.mesh;
  const PlacementSettings& settings = field.settings;
  if (path.empty()) {
    path.vertex.push_back(X);
    path.arc.push_back(0.0);
    return;
  }
  const Vec3 P = path.vertex.back();
  const double begin = path.length();
  const double length = (X - P).norm();
  if (!(length > 0.0)) return;
  const std::vector<Passage> tets = passages(field, P, X);
  const std::vector<Crossing> crossings = crossings_of(tets);
  add_pieces(path, tets, crossings, begin, length);
  path.vertex.push_back(X);
  path.arc.push_back(begin + length);

  for (const Crossing& c : crossings) {
    const double arc = begin + c.t * length;
    if (path.crossings.empty() || arc - path.crossings.back() > c.tolerance * length)
      path.crossings.push_back(arc);
  }
  for (const Candidate& c : candidates(mesh, tets, crossings)) {
    if (settings.placement != Placement::crossings) break;
    const double arc = begin + c.t * length;
    // Lowered by the tolerance, so that round-off does not decide an exact tie.
    const double shortest =
        std::max(settings.merge * local_edge(mesh, c.tet) * (1.0 - relative_tolerance),
                 c.tolerance * length);
    const bool other = !path.sites.empty() && !field.same_body(path.sites.back().tet, c.tet);
    if (path.sites.empty() || other || arc - path.sites.back().arc > shortest)
      add_site(path, mesh, c.tet, arc, P + c.t * (X - P));
  }
  if (settings.placement != Placement::spacing) return;
  const double d = settings.spacing;
  const auto first = static_cast<long>(std::floor(begin / d + 1e-9)) + (begin > 0.0 ? 1 : 0);
  const auto last = static_cast<long>(std::floor((begin + length) / d + 1e-9));
  for (long k = first; k <= last; ++k) {
    const double t = std::clamp((static_cast<double>(k) * d - begin) / length, 0.0, 1.0);
    const int tet = lowest_tet_at(tets, t, 1.0);
    if (tet >= 0) add_site(path, mesh, tet, static_cast<double>(k) * d, P + t * (X - P));
  }
}

void jump(Path& path, const Vec3& X, double gap)
{
  const double begin = path.length();
  if (gap > 0.0) path.pieces.push_back({begin, begin + gap, -1});
  path.jumps.push_back(static_cast<int>(path.vertex.size()));
  path.vertex.push_back(X);
  path.arc.push_back(begin + gap);
}

}  // namespace trocar::insertion
