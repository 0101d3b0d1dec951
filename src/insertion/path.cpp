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

std::vector<Passage> passages(const mesh::Mesh& mesh, const mesh::Locator& locator, const Vec3& P,
                              const Vec3& Q)
{
  std::vector<Passage> found;
  const double length = (Q - P).norm();
  const Vec3 margin = Vec3::Constant(1e-9 + 1e-3 * length);
  for (int tet : locator.in_box(P.cwiseMin(Q) - margin, P.cwiseMax(Q) + margin)) {
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

void grow(Path& path, const Vec3& X, const mesh::Mesh& mesh, const mesh::Locator& locator,
          const PlacementSettings& settings)
{
  if (path.empty()) {
    path.vertex.push_back(X);
    path.arc.push_back(0.0);
    return;
  }
  const Vec3 P = path.vertex.back();
  const double begin = path.length();
  const double length = (X - P).norm();
  if (!(length > 0.0)) return;
  const std::vector<Passage> tets = passages(mesh, locator, P, X);
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
    if (path.sites.empty() || arc - path.sites.back().arc > shortest)
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

std::optional<Site> site_at(const Path& path, const mesh::Mesh& mesh, double arc)
{
  const Piece* in = nullptr;
  for (const Piece& piece : path.pieces)
    if (piece.tet >= 0 && piece.begin < arc) in = &piece;
  if (!in) return std::nullopt;
  const double here = std::min(arc, in->end);
  return Site{here, in->tet, anchor_at(mesh, in->tet, place_at(path, here))};
}

constraint::Anchor anchor_at(const mesh::Mesh& mesh, int tet, const Vec3& X)
{
  const mesh::TetNodes nodes = mesh::nodes_of(mesh, tet);
  constraint::Anchor anchor{{nodes.begin(), nodes.end()}, {}};
  Eigen::Vector4d at = mesh::local_coordinates(mesh::positions(mesh, tet), X);
  for (int a = 0; a < 4; ++a)
    if (at[a] < relative_tolerance) at[a] = 0.0;  // X is on the face: nodes off it get no weight
  anchor.weight = mesh::node_weights(mesh, at / at.sum());
  return anchor;
}

Vec3 place_at(const Path& path, double arc)
{
  const auto end = std::upper_bound(path.arc.begin() + 1, path.arc.end() - 1, arc);
  const auto i = static_cast<std::size_t>(end - path.arc.begin());
  const double part = (arc - path.arc[i - 1]) / (path.arc[i] - path.arc[i - 1]);
  return path.vertex[i - 1] + part * (path.vertex[i] - path.vertex[i - 1]);
}

int tet_before(const Path& path, double arc)
{
  const auto at = std::lower_bound(path.pieces.begin(), path.pieces.end(), arc,
                                   [](const Piece& piece, double s) { return piece.end < s; });
  return at == path.pieces.end() ? -1 : at->tet;
}

int tet_after(const Path& path, double arc)
{
  const auto at = std::upper_bound(path.pieces.begin(), path.pieces.end(), arc,
                                   [](double s, const Piece& piece) { return s < piece.end; });
  return at == path.pieces.end() ? -1 : at->tet;
}

double tissue_length(const Path& path, double arc)
{
  double length = 0.0;
  for (const Piece& piece : path.pieces)
    if (piece.tet >= 0) length += std::max(0.0, std::min(piece.end, arc) - piece.begin);
  return length;
}

int first_tet(const Path& path)
{
  for (const Piece& piece : path.pieces)
    if (piece.tet >= 0) return piece.tet;
  return -1;
}

int last_tet(const Path& path)
{
  for (auto piece = path.pieces.rbegin(); piece != path.pieces.rend(); ++piece)
    if (piece->tet >= 0) return piece->tet;
  return -1;
}

bool straight(const Path& path)
{
  if (path.vertex.size() < 3) return true;
  const Vec3 chord = (path.vertex.back() - path.vertex.front()).normalized();
  return std::all_of(path.vertex.begin(), path.vertex.end(), [&](const Vec3& X) {
    return (X - path.vertex.front()).cross(chord).norm() <= 1e-9 * path.length();
  });
}

double arc_nearest(const Path& path, const Vec3& X)
{
  double best = std::numeric_limits<double>::infinity();
  double arc = 0.0;
  const std::size_t segments = path.vertex.size() - 1;
  for (std::size_t i = 0; i < segments; ++i) {
    const Vec3 d = path.vertex[i + 1] - path.vertex[i];
    const double low = i == 0 ? -std::numeric_limits<double>::infinity() : 0.0;
    const double high = i + 1 == segments ? std::numeric_limits<double>::infinity() : 1.0;
    const double t = std::clamp((X - path.vertex[i]).dot(d) / d.squaredNorm(), low, high);
    const double distance = (path.vertex[i] + t * d - X).squaredNorm();
    if (distance < best) {
      best = distance;
      arc = path.arc[i] + t * d.norm();
    }
  }
  return arc;
}

double distance(const Path& path, const Vec3& X)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < path.vertex.size(); ++i) {
    const Vec3 d = path.vertex[i + 1] - path.vertex[i];
    const double t = std::clamp((X - path.vertex[i]).dot(d) / d.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (path.vertex[i] + t * d - X).norm());
  }
  return nearest;
}

}  // namespace trocar::insertion
