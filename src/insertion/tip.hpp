#pragma once

#include <vector>

#include "insertion/deformed.hpp"
#include "law/problem.hpp"
#include "needle/shaft.hpp"

namespace trocar::insertion {

/// Settings of the tissue's resistance to the tip (docs/theory.md section 6).
struct TipSettings
{
  std::vector<double> cutting;  ///< f_cut by physical volume of the mesh [N]
  double radius = 0.0;    ///< of the tip's support [m]; a smaller one is raised to the local edge
  double friction = 1.0;  ///< Coulomb's coefficient, of a tip on a surface not yet punctured
};

/// State of the tip and of its contact with the tissue ahead. A border is a place where going on
/// needs a force: see `Ground::border`.
struct TipState
{
  bool pressed = false;        ///< the tip is at the end of its channel, and tissue resists there
  double threshold = 0.0;      ///< f_p of the border that ends the channel [N], 0: none, or pierced
  bool wall = false;           ///< that border is a surface of the tissue: its outside or a void's
  double pierced_arc = -1.0;   ///< arc on the path where the last border was pierced [m]
  double pierced_force = 0.0;  ///< threshold of the border that was pierced last [N]
  int tet = -1;                ///< tet of the place that the tip presses on; -1: none
  constraint::Anchor hold;     ///< support around that place
  double radius = 0.0;  ///< of the support: TipSettings::radius or, if larger, the local edge [m]
  Vec3 offset = Vec3::Zero();  ///< from the tip to the support's mean when the gap is closed [m]
  double hidden = 0.0;  ///< what `offset` counts of `hidden_motion_at_tip`, along the shaft [m]
  Vec3 lambda = Vec3::Zero();  ///< two lateral multipliers and the axial one [N]
  int punctures = 0;           ///< borders pierced so far

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("pressed", "1", self.pressed);
    v("threshold", "N", self.threshold);
    v("wall", "1", self.wall);
    v("pierced_arc", "m", self.pierced_arc);
    v("pierced_force", "N", self.pierced_force);
    v("tet", "1", self.tet);
    v("hold", "", self.hold);
    v("radius", "m", self.radius);
    v("offset", "m", self.offset);
    v("hidden", "m", self.hidden);
    v("lambda", "N", self.lambda);
    v("punctures", "1", self.punctures);
  }
};

/// Row numbers of the tip in a set.
struct TipRows
{
  int axial = -1;      ///< axial row, -1: none
  int lateral = -1;    ///< first of two lateral rows, on a surface only; -1: none
  double limit = 0.0;  ///< the axial force at which the tissue yields [N]
};

/// State of the tip's rows after the solve: see `accept_tip`.
enum class TipOutcome { holds, yields, slides, apart };

/// The iterate at which the rows of a needle are made: deformed tissue and shaft. `body` is the
/// needle's index among the small bodies. `h` is the step length [s]; 0 means that no time passes,
/// and then there are no dashpots.
struct Iterate
{
  const needle::Shaft& shaft;
  const Deformed& tissue;
  int body;
  double h;
};

/// Parameters of the law of a pressed tip.
struct TipLaw
{
  bool on_surface;
  double limit;     ///< axial force at which the tissue yields [N]
  double friction;  ///< Coulomb's coefficient on a surface
};

/// Reference place X that carries a tip, the tet that contains X, and the radius of the support.
struct Support
{
  Vec3 X;
  int tet;
  double radius;  ///< [m]
};

/// Weights of a mean over the tissue within the support's radius: uniform over the ball, or
/// (`disc`) with Hertz's pressure sqrt(1 - r²/R²) over the disc normal to the frame's first axis.
/// The samples are oriented by the frame and come in opposite pairs about X. Where one of a pair
/// lies outside the tissue both are dropped, so that the mean place stays X.
constraint::Anchor tip_support(const mesh::Mesh& mesh, const mesh::Locator& locator,
                               const Support& support, const core::Mat3& frame, bool disc);

/// Adds a pressed tip's axial row: 0 <= λ <= limit on δ = m·(x_tissue - x_tip), m the tangent.
/// Inside the tissue m has the bevel's lateral part too. On a surface two lateral rows and the
/// axial row share Coulomb's cone.
TipRows add_tip_rows(const TipState& tip, const TipLaw& law, const Iterate& at,
                     constraint::Set& set);

/// Stores the multipliers in the tip and tells what it did. `yields`: λ is at its limit and the tip
/// advanced. `apart`: the gap is open. `slides`: it moved along a surface. Else `holds`. Gaps up to
/// `tolerance` [m] count as closed.
TipOutcome accept_tip(TipState& tip, const TipRows& rows, const law::Multipliers& multipliers,
                      double tolerance);

}  // namespace trocar::insertion
