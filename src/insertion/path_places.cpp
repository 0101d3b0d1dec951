#include <algorithm>
#include <cmath>
#include <limits>

#include "insertion/path.hpp"
#include "mesh/quadratic.hpp"

// Places on a path, and what lies where along it.
namespace trocar::insertion {

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

std::vector<PathRun> runs(const Path& path)
{
  std::vector<PathRun> found;
  std::size_t first = 0;
  const auto add = [&](std::size_t next) {
    if (next > first) found.push_back({first, next - 1, path.arc[first], path.arc[next - 1]});
    first = next;
  };
  for (int jump : path.jumps) add(static_cast<std::size_t>(jump));
  add(path.vertex.size());
  return found;
}

PathRun run_at(const Path& path, double arc)
{
  const std::vector<PathRun> all = runs(path);
  auto run = all.begin();
  while (run + 1 != all.end() && arc > run->end) ++run;
  if (run + 1 != all.end() && arc == (run + 1)->begin) ++run;
  return *run;
}

Vec3 place_at(const Path& path, double arc)
{
  const auto end = std::upper_bound(path.arc.begin() + 1, path.arc.end() - 1, arc);
  const auto i = static_cast<std::size_t>(end - path.arc.begin());
  const double length = path.arc[i] - path.arc[i - 1];
  if (!(length > 0.0)) return path.vertex[i];
  const double part = (arc - path.arc[i - 1]) / length;
  return path.vertex[i - 1] + part * (path.vertex[i] - path.vertex[i - 1]);
}

Vec3 place_before(const Path& path, double arc)
{
  for (int jump : path.jumps)
    if (const auto end = static_cast<std::size_t>(jump) - 1; path.arc[end] == arc)
      return path.vertex[end];
  return place_at(path, arc);
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

int first_tet(const Path& path, const PathRun& run)
{
  for (const Piece& piece : path.pieces)
    if (piece.tet >= 0 && piece.begin >= run.begin && piece.begin < run.end) return piece.tet;
  return -1;
}

int last_tet(const Path& path, const PathRun& run)
{
  for (auto piece = path.pieces.rbegin(); piece != path.pieces.rend(); ++piece)
    if (piece->tet >= 0 && piece->end <= run.end && piece->end > run.begin) return piece->tet;
  return -1;
}

bool straight(const Path& path)
{
  const auto one_line = [&](const PathRun& run) {
    const Vec3& begin = path.vertex[run.first];
    const Vec3 chord = (path.vertex[run.last] - begin).normalized();
    for (std::size_t i = run.first + 1; i < run.last; ++i)
      if ((path.vertex[i] - begin).cross(chord).norm() > 1e-9 * path.length()) return false;
    return true;
  };
  const std::vector<PathRun> all = runs(path);
  return std::all_of(all.begin(), all.end(), one_line);
}

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// Arc of the place on a run nearest to X, and the square of their distance.
struct Nearest
{
  double arc, square;
};

/// `before`, `after`: the run's first and last segment are extended.
Nearest nearest_on(const Path& path, const PathRun& run, const Vec3& X, bool before, bool after)
{
  Nearest best{run.begin,
               run.first == run.last ? (path.vertex[run.first] - X).squaredNorm() : endless};
  for (std::size_t i = run.first; i < run.last; ++i) {
    const Vec3 d = path.vertex[i + 1] - path.vertex[i];
    const double low = i == run.first && before ? -endless : 0.0;
    const double high = i + 1 == run.last && after ? endless : 1.0;
    const double t = std::clamp((X - path.vertex[i]).dot(d) / d.squaredNorm(), low, high);
    const double square = (path.vertex[i] + t * d - X).squaredNorm();
    if (square < best.square) best = {path.arc[i] + t * d.norm(), square};
  }
  return best;
}

}  // namespace

double arc_nearest(const Path& path, const Vec3& X)
{
  Nearest best{0.0, endless};
  for (const PathRun& run : runs(path)) {
    const bool after = run.last + 1 == path.vertex.size();
    const Nearest found = nearest_on(path, run, X, run.first == 0, after);
    if (found.square < best.square) best = found;
  }
  return best.arc;
}

double arc_nearest(const Path& path, const PathRun& run, const Vec3& X)
{
  const double low = run.first == 0 ? -endless : path.arc[run.first - 1];
  const double high = run.last + 1 == path.vertex.size() ? endless : path.arc[run.last + 1];
  return std::clamp(nearest_on(path, run, X, true, true).arc, low, high);
}

double distance(const Path& path, const Vec3& X)
{
  double nearest = endless;
  for (const PathRun& run : runs(path))
    nearest = std::min(nearest, nearest_on(path, run, X, false, false).square);
  return std::sqrt(nearest);
}

}  // namespace trocar::insertion
