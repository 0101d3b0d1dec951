#pragma once

#include <vector>

#include "insertion/path.hpp"
#include "insertion/tip.hpp"

namespace trocar::insertion {

/// `contact`: the tip presses on the surface, which is not punctured yet, and the path consists of
/// that one place. `withdrawn`: the tip has left its channel, which is kept.
enum class Phase { outside, contact, inserted, withdrawn };

/// State of one coupling point: a material place of the tissue held by the shaft. A point is born
/// when the tip passes its site, and counts as having slipped for the whole of that step.
struct CouplingPoint
{
  int site = 0;                ///< index in Path::sites; identifies the point
  double needle_arc = 0.0;     ///< place on the needle where it sticks [m]; changes only in slip
  bool stuck = true;           ///< true: no slip in the last step
  Vec3 lambda = Vec3::Zero();  ///< two lateral multipliers and the axial one [N]

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("site", "1", self.site);
    v("needle_arc", "m", self.needle_arc);
    v("stuck", "1", self.stuck);
    v("lambda", "N", self.lambda);
  }
};

/// How one needle sits in the tissue. A value, equal on every rank.
struct InsertionState
{
  Phase phase = Phase::outside;
  Path path;
  double tip_arc = 0.0;               ///< where the tip is along the path [m]
  bool withdrawing = false;           ///< the tip last moved backwards along the path
  std::vector<CouplingPoint> points;  ///< in order of site, all at or behind the tip
  TipState tip;

  bool touches() const { return tip.pressed || !points.empty(); }  ///< it needs rows

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("phase", "1", self.phase);
    v("path", "", self.path);
    v("tip_arc", "m", self.tip_arc);
    v("withdrawing", "1", self.withdrawing);
    v("point", "", self.points);
    v("tip", "", self.tip);
  }
};

}  // namespace trocar::insertion
