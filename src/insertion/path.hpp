#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "constraint/set.hpp"
#include "insertion/line.hpp"
#include "mesh/locator.hpp"

namespace trocar::insertion {

using core::Vec3;

enum class Placement { crossings, spacing, line };

struct PlacementSettings
{
  Placement placement = Placement::crossings;
  double spacing = 0.005;  ///< of points along the path, for `Placement::spacing` [m]
  double merge = 0.3;      ///< of two points closer than merge · local edge the newer is dropped
};

/// A stretch of the path in one tet, or outside the tissue (also in a void).
struct Piece
{
  double begin, end;  ///< arc length along the path [m]
  int tet;            ///< -1: not in the tissue

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("begin", "m", self.begin);
    v("end", "m", self.end);
    v("tet", "1", self.tet);
  }
};

/// A material place on the path where a coupling point may stand. Path::first_id plus the index in
/// Path::sites identifies a site for the whole run.
struct Site
{
  double arc;  ///< [m] from the start of the path
  int tet;
  constraint::Anchor anchor;  ///< of a site on a face, nodes off the face have weight exactly 0

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("arc", "m", self.arc);
    v("tet", "1", self.tet);
    v("anchor", "", self.anchor);
  }
};

/// The channel that the tip has cut, in *reference* coordinates: a path does not move when the
/// tissue does. A value; a path only grows at its end. Between two bodies it jumps: its runs, one
/// in every body, have nothing in common but the arc length.
struct Path
{
  std::vector<Vec3> vertex;       ///< polyline [m]
  std::vector<int> jumps;         ///< vertices at which a run in the next body begins
  std::vector<double> arc;        ///< arc length at each vertex [m]
  std::vector<Piece> pieces;      ///< in order, covering 0 .. length()
  std::vector<double> crossings;  ///< arcs of all face crossings, before merging [m]
  std::vector<Site> sites;        ///< in order of arc
  Line line;                      ///< for `Placement::line`; a site belongs to every node then
  int first_id = 0;               ///< number of sites[0]; a new channel continues the numbering

  bool empty() const { return vertex.empty(); }
  double length() const { return arc.empty() ? 0.0 : arc.back(); }

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("vertex", "m", self.vertex);
    v("jump", "1", self.jumps);
    v("arc", "m", self.arc);
    v("piece", "", self.pieces);
    v("crossing", "m", self.crossings);
    v("site", "", self.sites);
    v("line", "", self.line);
    v("first_id", "1", self.first_id);
  }
};

/// The tets that a path grows through. Borrows everything.
struct Field
{
  const mesh::Mesh& mesh;
  const mesh::Locator& locator;
  const PlacementSettings& settings;
  std::span<const int> body_of_node{};  ///< number of the connected body of every node
  int body = -1;                        ///< only tets of this body; -1: of all

  int body_of(int tet) const
  {
    const auto corner = static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(tet)][0]);
    return body_of_node[corner];
  }
  bool has(int tet) const { return body < 0 || body_of(tet) == body; }
  bool same_body(int a, int b) const { return body_of_node.empty() || body_of(a) == body_of(b); }
};

/// Appends the straight segment from the end of the path to X (reference), finds the faces that the
/// segment crosses and places sites. An empty path takes X as its first vertex. Predicates use
/// half-open intervals with a tolerance of 1e-6 of the local edge, so that neither round-off nor
/// the number of ranks decides a tie: a crossing up to the tolerance beyond X counts as reached.
void grow(Path& path, const Vec3& X, const Field& field);

/// Goes on at the reference place X on the surface of the next body, `gap` [m] farther along the
/// needle.
void jump(Path& path, const Vec3& X, double gap);

/// A run of the path: its first and last vertex, and their arcs [m].
struct PathRun
{
  std::size_t first, last;
  double begin, end;
};
std::vector<PathRun> runs(const Path& path);
/// The run that contains `arc`; between two runs the later one.
PathRun run_at(const Path& path, double arc);

/// The material place on the path at `arc` [m]. Where the path lies outside the tissue there, the
/// last place before `arc` that lies in tissue; nothing when there is none.
std::optional<Site> site_at(const Path& path, const mesh::Mesh& mesh, double arc);

/// Weights of the nodes of a tet at the place X in it. Nodes off a face that X lies on get no
/// weight.
constraint::Anchor anchor_at(const mesh::Mesh& mesh, int tet, const Vec3& X);

/// The place on the path at `arc`, between 0 and its length [m]. Where a run ends and the next
/// begins at the same arc, `place_at` is in the next and `place_before` in the one that ends.
Vec3 place_at(const Path& path, double arc);
Vec3 place_before(const Path& path, double arc);

/// Tet of the piece that ends at `arc` or contains it, and of the piece that begins there or
/// contains it; -1: none.
int tet_before(const Path& path, double arc);
int tet_after(const Path& path, double arc);

/// Length of the path up to `arc` that lies in tissue [m].
double tissue_length(const Path& path, double arc);

/// True when the vertices of every run lie on one line, to 1e-9 of the path's length.
bool straight(const Path& path);

/// Arc length of the point of the path nearest to X [m]. The first and the last segment are
/// extended beyond the ends of the path, so the result may be negative or exceed the length.
double arc_nearest(const Path& path, const Vec3& X);
/// The same on one run, extended at both ends up to its neighbours.
double arc_nearest(const Path& path, const PathRun& run, const Vec3& X);

/// Distance of X from the path, not extended beyond its ends [m].
double distance(const Path& path, const Vec3& X);

/// First and last tet that the path passes through, all of it or between two arcs; -1: none.
int first_tet(const Path& path);
int last_tet(const Path& path);
int first_tet(const Path& path, const PathRun& run);
int last_tet(const Path& path, const PathRun& run);

/// Places closer than this part of the local edge count as one.
inline constexpr double relative_tolerance = 1e-6;

/// The local edge [m]: the mean edge of a tet, halved when the tet is quadratic.
double local_edge(const mesh::Mesh& mesh, int tet);

/// Distance along the path below which two places count as one [m].
double arc_tolerance(const mesh::Mesh& mesh, int tet);

}  // namespace trocar::insertion
