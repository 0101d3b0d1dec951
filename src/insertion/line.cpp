#include "insertion/line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "insertion/ground.hpp"
#include "insertion/path.hpp"
#include "insertion/ring.hpp"

namespace trocar::insertion {
namespace {

constexpr double no_end = std::numeric_limits<double>::max();

/// Abscissae of the Gauss rule with two points on [0, 1], exact for cubics; the weights are 1/2.
const std::array<double, 2> gauss{0.5 - 0.5 / std::numbers::sqrt3, 0.5 + 0.5 / std::numbers::sqrt3};

/// Extends grid and segments along the pieces of the path.
class Extension
{
 public:
  Extension(const Ground& ground, const Path& path, Line& line, double radius)
      : ground_(&ground), path_(&path), line_(&line), radius_(radius)
  {
  }

  void run()
  {
    const double covered = begin_of_tail();
    const auto first =
        std::upper_bound(path_->pieces.begin(), path_->pieces.end(), covered,
                         [](double arc, const Piece& piece) { return arc < piece.end; });
    for (auto piece = first; piece != path_->pieces.end(); ++piece) take(*piece);
  }

 private:
  bool open() const { return !line_->stretches.empty() && line_->stretches.back().end == no_end; }
  /// Arc up to which there are segments, or where the open stretch begins.
  double begin_of_tail() const
  {
    const double segments = line_->segments.empty() ? 0.0 : line_->segments.back().end;
    return open() ? std::max(segments, line_->stretches.back().begin) : segments;
  }

  void take(const Piece& piece)
  {
    if (open() && !goes_on(piece.tet)) {
      fill(piece.begin);
      line_->stretches.back().end = piece.begin;
    }
    if (piece.tet < 0) return;
    if (!open()) begin_stretch(std::max(piece.begin, begin_of_tail()), piece.tet);
    const int tail = tail_tet();
    if (ground_->region(tail) != ground_->region(piece.tet)) fill(piece.begin);
    fill_whole(piece.end);
  }

  /// A tet in which the open stretch goes on: of the same body, with the same friction.
  bool goes_on(int tet) const
  {
    const int from = line_->stretches.back().tet;
    return tet >= 0 && ground_->body(from) == ground_->body(tet) &&
           ground_->settings.friction[ground_->region(from)] ==
               ground_->settings.friction[ground_->region(tet)];
  }

  void begin_stretch(double arc, int tet)
  {
    line_->stretches.push_back({arc, no_end, tet, line_->hats()});
    add_node(arc, tet);
    add_node(arc + spacing(), tet);
  }
  void add_node(double arc, int tet)
  {
    const double end = run_at(*path_, line_->stretches.back().begin).end;
    const double edge = ground_->edges->at(tet, place_before(*path_, std::min(arc, end)));
    line_->nodes.push_back({arc, edge, static_cast<int>(line_->stretches.size()) - 1});
  }
  /// Length of the cell that begins at the last node.
  double spacing() const
  {
    const LineSettings& line = ground_->settings.line;
    return line.spacing > 0.0 ? line.spacing : line.kappa * line_->nodes.back().edge;
  }

  int tail_tet() const
  {
    const int tet = tet_after(*path_, begin_of_tail());
    return tet >= 0 ? tet : line_->stretches.back().tet;
  }
  /// Where the segment that begins at the tail ends when it is whole.
  double whole_end()
  {
    const double begin = begin_of_tail();
    const int tet = tail_tet();
    const double edge = ground_->edges->at(tet, place_at(*path_, begin));
    const double node = line_->nodes.back().arc;
    // A rest shorter than half a segment joins it.
    const double end = begin + 0.25 * edge;
    return end > node - 0.125 * edge ? node : end;
  }
  void fill_whole(double arc)
  {
    for (double end = whole_end(); end <= arc; end = whole_end()) {
      add_segment(end);
      if (end < line_->nodes.back().arc) continue;
      const double node = line_->nodes.back().arc;
      const int tet = tet_before(*path_, node);
      line_->nodes.back().edge = ground_->edges->at(tet, place_before(*path_, node));
      add_node(node + spacing(), tet);
    }
  }
  /// Fills the stretch up to `arc` with a last segment that may be shorter.
  void fill(double arc)
  {
    fill_whole(arc);
    if (arc > begin_of_tail()) add_segment(arc);
  }
  void add_segment(double end)
  {
    const int stretch = static_cast<int>(line_->stretches.size()) - 1;
    line_->segments.push_back({begin_of_tail(), end, stretch, tail_tet()});
    add_stations(line_->segments.back(), end, line_->stations);
  }

 public:
  /// Adds two stations for the part of a segment up to `end`.
  void add_stations(const Segment& segment, double end, std::vector<Station>& stations) const
  {
    const double length = end - segment.begin;
    for (double t : gauss) {
      const double arc = segment.begin + t * length;
      const Vec3 X = place_at(*path_, arc);
      const int found = tet_before(*path_, arc);
      const int tet = found >= 0 ? found : segment.tet;
      const double edge = ground_->edges->at(tet, X);
      const double radius = std::max(radius_, ground_->settings.line.ring * edge);
      // Points at most 0.7 edges apart, six at least.
      const int pairs = static_cast<int>(std::ceil(std::numbers::pi * radius / (0.7 * edge)));
      const Ring ring{radius, 2 * std::max(3, pairs)};
      stations.push_back({arc, 0.5 * length, segment.stretch, tet,
                          ring_around(*ground_, X, tet, axis_at(arc, edge), ring)});
    }
  }
  /// Adds the stations behind a tip that stands between two ends of segments.
  void add_open(double arc)
  {
    const auto next =
        std::upper_bound(line_->segments.begin(), line_->segments.end(), arc,
                         [](double tip, const Segment& segment) { return tip < segment.end; });
    line_->behind = 2 * static_cast<int>(next - line_->segments.begin());
    line_->open.clear();
    if (next != line_->segments.end()) {
      if (arc > next->begin) add_stations(*next, arc, line_->open);
    } else if (open() && arc > begin_of_tail()) {
      const int stretch = static_cast<int>(line_->stretches.size()) - 1;
      add_stations({begin_of_tail(), arc, stretch, tail_tet()}, arc, line_->open);
    }
  }

 private:
  /// Direction of the path around `arc`: that of a chord of a quarter of an edge, so that the
  /// jitter of short steps does not turn it.
  Vec3 axis_at(double arc, double edge) const
  {
    const PathRun run = run_at(*path_, arc);
    const double from = std::max(arc - 0.125 * edge, run.begin);
    const double to = std::min(arc + 0.125 * edge, run.end);
    return (place_before(*path_, to) - place_at(*path_, from)).normalized();
  }

  const Ground* ground_;
  const Path* path_;
  Line* line_;
  double radius_;
};

/// Cell between a node and the next: what of it lies in the stretch and before `to`.
struct Cell
{
  double begin, end;  ///< the part
};
Cell cell_of(const Line& line, int node, double from, double to)
{
  const LineNode& at = line.nodes[static_cast<std::size_t>(node)];
  const Stretch& stretch = line.stretches[static_cast<std::size_t>(at.stretch)];
  const double end = line.nodes[static_cast<std::size_t>(node) + 1].arc;
  return {std::max(at.arc, from), std::min({end, stretch.end, to})};
}

bool same_stretch(const Line& line, int a, int b)
{
  return a >= 0 && b < line.hats() &&
         line.nodes[static_cast<std::size_t>(a)].stretch ==
             line.nodes[static_cast<std::size_t>(b)].stretch;
}

}  // namespace

void extend(const Ground& ground, const Path& path, Line& line, double radius)
{
  Extension(ground, path, line, radius).run();
}

void take_stations(const Ground& ground, const Path& path, Line& line, double arc, double radius)
{
  Extension(ground, path, line, radius).add_open(arc);
}

double hat(const Line& line, int node, int stretch, double arc)
{
  const LineNode& at = line.nodes[static_cast<std::size_t>(node)];
  if (at.stretch != stretch) return 0.0;
  const int other = arc < at.arc ? node - 1 : node + 1;
  if (!same_stretch(line, std::min(node, other), std::max(node, other)))
    return arc == at.arc ? 1.0 : 0.0;
  const double away = line.nodes[static_cast<std::size_t>(other)].arc - at.arc;
  return std::max(0.0, 1.0 - (arc - at.arc) / away);
}

HatMoments moments(const Line& line, int node, double from, double to)
{
  HatMoments sum;
  const int stretch = line.nodes[static_cast<std::size_t>(node)].stretch;
  for (int first : {node - 1, node}) {
    if (!same_stretch(line, first, first + 1)) continue;
    const Cell cell = cell_of(line, first, from, to);
    const double length = cell.end - cell.begin;
    if (!(length > 0.0)) continue;
    for (double t : gauss) {
      const double arc = cell.begin + t * length;
      const double weight = 0.5 * length * hat(line, node, stretch, arc);
      sum.length += weight;
      sum.arc += weight * arc;
    }
  }
  return sum;
}

std::vector<HatGroup> groups(const Line& line, double arc)
{
  constexpr double shortest_stretch = 0.3, shortest_hat = 1e-6;
  std::vector<HatGroup> found;
  for (int node = 0; node < line.hats(); ++node) {
    const double held = moments(line, node, 0.0, arc).length;
    if (!(held > 0.0)) continue;
    const LineNode& at = line.nodes[static_cast<std::size_t>(node)];
    const Stretch& stretch = line.stretches[static_cast<std::size_t>(at.stretch)];
    const double cell = line.nodes[static_cast<std::size_t>(stretch.first) + 1].arc - stretch.begin;
    const bool stub = std::min(arc, stretch.end) - stretch.begin < shortest_stretch * cell;
    const bool joins = node > stretch.first && (stub || held < shortest_hat * at.edge);
    if (joins)
      ++found.back().count;
    else
      found.push_back({node, 1});
  }
  return found;
}

}  // namespace trocar::insertion
