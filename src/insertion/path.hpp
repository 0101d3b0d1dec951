#pragma once

#include <array>
#include <optional>
#include <vector>

#include "constraint/set.hpp"
#include "mesh/locator.hpp"

namespace trocar::insertion {

using core::Vec3;

enum class Placement { crossings, spacing };

struct PlacementSettings
{
  Placement placement = Placement::crossings;
  double spacing = 0.005;  ///< [m]
  double merge = 0.3;      ///< pieces shorter than merge · local edge drop the newer point
};

/// A stretch of the path in one tet, or in none (outside, a void).
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

/// A material place on the path where a coupling point may stand. `first_id` of the path plus its
/// index is its identity for the whole run.
struct Site
{
  double arc;  ///< [m] from the start of the path
  int tet;
  constraint::Anchor anchor;  ///< weights of faces' opposite nodes are exactly 0

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("arc", "m", self.arc);
    v("tet", "1", self.tet);
    v("anchor", "", self.anchor);
  }
};

/// The channel the tip has cut, in *reference* coordinates: it does not move when the tissue does.
/// A value; it only grows at its end.
struct Path
{
  std::vector<Vec3> vertex;       ///< polyline [m]
  std::vector<double> arc;        ///< arc length at each vertex [m]
  std::vector<Piece> pieces;      ///< in order, covering 0 .. length()
  std::vector<double> crossings;  ///< arcs of all face crossings, before merging
  std::vector<Site> sites;        ///< by arc
  int first_id = 0;               ///< identity of sites[0]; a new channel goes on counting

  bool empty() const { return vertex.empty(); }
  double length() const { return arc.empty() ? 0.0 : arc.back(); }

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("vertex", "m", self.vertex);
    v("arc", "m", self.arc);
    v("piece", "", self.pieces);
    v("crossing", "m", self.crossings);
    v("site", "", self.sites);
    v("first_id", "1", self.first_id);
  }
};

/// Appends the straight segment from the end of the path to X (reference), finds the faces it
/// crosses and places sites. Predicates use half-open intervals with a tolerance of 1e-6 of the
/// local edge, so that neither round-off nor the number of ranks decides about a tie: a crossing
/// up to the tolerance beyond X counts as reached. A path starts as its first vertex.
void grow(Path& path, const Vec3& X, const mesh::Mesh& mesh, const mesh::Locator& locator,
          const PlacementSettings& settings);

/// The material place of the path at `arc`, or where it last was in tissue before that; nothing
/// when it never was.
std::optional<Site> site_at(const Path& path, const mesh::Mesh& mesh, double arc);

/// Length of the path up to `arc` that lies in tissue [m].
double tissue_length(const Path& path, double arc);

/// True when all vertices lie on one line, to 1e-9 of the length.
bool straight(const Path& path);

/// Arc length of the point of the path nearest to X; the first and last segments go on beyond
/// their ends, so that the result may be negative or more than the length.
double arc_nearest(const Path& path, const Vec3& X);

/// Distance of X from the path itself [m].
double distance(const Path& path, const Vec3& X);

/// First and last tet of the path, where the needle goes in and where its end is; -1: in none.
int first_tet(const Path& path);
int last_tet(const Path& path);

/// Part of the local edge below which two places are one.
inline constexpr double relative_tolerance = 1e-6;

/// Mean edge of a tet [m], of a quadratic one half of it: the measure of everything "local".
double local_edge(const mesh::Mesh& mesh, int tet);

/// Arc tolerance below which two places are one [m].
double arc_tolerance(const mesh::Mesh& mesh, int tet);

}  // namespace trocar::insertion
