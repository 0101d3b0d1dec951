#pragma once

#include <limits>
#include <vector>

#include "constraint/set.hpp"
#include "tissue/elements.hpp"

// A needle coupled along a line: multipliers are densities of force along the path, combined of
// hat functions φ on a grid that is fixed in the tissue (docs/theory.md section 13).
namespace trocar::insertion {

using core::Vec3;
struct Ground;
struct Path;

/// Placement `line`. Lengths in whole mean edges of the tets around the path.
struct LineSettings
{
  double kappa = 1.4;    ///< distance of the grid's nodes [edges]
  double ring = 0.35;    ///< least radius of the ring [edges]
  double spacing = 0.0;  ///< > 0: distance of the grid's nodes instead of kappa [m]
  tissue::Dilatation dilatation = tissue::Dilatation::pointwise;  ///< of the elements
};

/// A node of the grid. Fixed for ever once the tip has passed the node before; the last node of a
/// stretch lies ahead of the tip. Its index is its identity.
struct LineNode
{
  double arc;   ///< along the path [m]
  double edge;  ///< mean edge of the tets around it [m]
  int stretch;

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("arc", "m", self.arc);
    v("edge", "m", self.edge);
    v("stretch", "1", self.stretch);
  }
};

/// A part of the path in one body with one friction law, with a grid of its own.
struct Stretch
{
  double begin, end;  ///< arcs [m]; the last stretch may have no end yet
  int tet;            ///< in which it begins
  int first;          ///< its first node

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("begin", "m", self.begin);
    v("end", "m", self.end);
    v("tet", "1", self.tet);
    v("first", "1", self.first);
  }
};

/// A point of the quadrature along the path: the mean place of the tissue around it.
struct Station
{
  double arc;     ///< [m]
  double length;  ///< weight: the length of path it stands for [m]
  int stretch, tet;
  constraint::Anchor ring;

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("arc", "m", self.arc);
    v("length", "m", self.length);
    v("stretch", "1", self.stretch);
    v("tet", "1", self.tet);
    v("ring", "", self.ring);
  }
};

/// A part of a stretch between two nodes, at most a quarter of an edge long, with two stations.
struct Segment
{
  double begin, end;  ///< arcs [m]
  int stretch, tet;

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("begin", "m", self.begin);
    v("end", "m", self.end);
    v("stretch", "1", self.stretch);
    v("tet", "1", self.tet);
  }
};

/// The grid along a path and its quadrature. A value; part of a Path.
struct Line
{
  std::vector<LineNode> nodes;
  std::vector<Stretch> stretches;
  std::vector<Segment> segments;  ///< as long as they will ever be
  std::vector<Station> stations;  ///< two for every segment
  std::vector<Station> open;      ///< of the part of a segment behind the tip
  int behind = 0;                 ///< stations of segments wholly behind the tip

  int hats() const { return static_cast<int>(nodes.size()); }

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("node", "", self.nodes);
    v("stretch", "", self.stretches);
    v("segment", "", self.segments);
    v("station", "", self.stations);
    v("open", "", self.open);
    v("behind", "1", self.behind);
  }
};

/// Extends the grid to the end of the path.
void extend(const Ground& ground, const Path& path, Line& line, double radius);

/// Takes the stations between the begin of the path and the tip at `arc` [m]; `radius` of the shaft
/// [m].
void take_stations(const Ground& ground, const Path& path, Line& line, double arc, double radius);

/// The stations behind the tip, in order of arc.
template <class Visit>
void each_station(const Line& line, const Visit& visit)
{
  for (int q = 0; q < line.behind; ++q) visit(line.stations[static_cast<std::size_t>(q)]);
  for (const Station& station : line.open) visit(station);
}

/// Hat function of a node at a station's arc, 0 in other stretches.
double hat(const Line& line, int node, int stretch, double arc);

/// ∫ φ ds and ∫ φ s ds of a node's hat between two arcs [m, m²].
struct HatMoments
{
  double length = 0.0, arc = 0.0;
};
HatMoments moments(const Line& line, int node, double from, double to);

/// First hat and number of hats that share their rows, because one alone holds too short a piece.
struct HatGroup
{
  int first, count;
};
/// The groups behind a tip at `arc` [m], in order. `kappa`: see LineSettings.
std::vector<HatGroup> groups(const Line& line, double arc);

}  // namespace trocar::insertion
