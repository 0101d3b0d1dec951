#pragma once

#include <vector>

#include "insertion/deformed.hpp"
#include "law/problem.hpp"
#include "needle/shaft.hpp"

namespace trocar::insertion {

/// What resists the tip (docs/theory.md section 6).
struct TipSettings
{
  std::vector<double> cutting;  ///< f_cut by volume of the mesh [N]
  double radius = 0.0;          ///< of the tip's support [m]; never less than the local edge
  double friction = 1.0;  ///< lateral over axial force of the tip on a surface not yet punctured
};

/// How the tip stands to the tissue ahead of it.
struct TipState
{
  bool pressed = false;        ///< at the end of its channel: the tissue there resists
  double threshold = 0.0;      ///< f_p of the border the channel ends at [N], 0: none, or pierced
  bool wall = false;           ///< that border is the tissue's surface, outside or a void's
  double pierced_arc = -1.0;   ///< where along the path the last border was pierced [m]
  double pierced_force = 0.0;  ///< and its threshold [N]
  int tet = -1;                ///< holds the place it presses on
  constraint::Anchor hold;     ///< support of that place
  double radius = 0.0;         ///< of the support: that asked for, or the local edge there [m]
  Vec3 offset = Vec3::Zero();  ///< from the tip to the support's mean when the gap is closed [m]
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
    v("lambda", "N", self.lambda);
    v("punctures", "1", self.punctures);
  }
};

/// Rows the tip got in a set.
struct TipRows
{
  int axial = -1;      ///< -1: none
  int lateral = -1;    ///< first of two, on a surface
  double limit = 0.0;  ///< the axial force at which the tissue yields [N]
};

/// What came of the tip's rows.
enum class TipOutcome { holds, yields, slides, apart };

/// The iterate that rows of a needle are made at: deformed tissue and shaft. `body` is the needle's
/// index among the small bodies, `h` the step length [s], 0 when no time passes: dashpots are then
/// absent.
struct Iterate
{
  const needle::Shaft& shaft;
  const Deformed& tissue;
  int body;
  double h;
};

/// What a tip is held by.
struct TipLaw
{
  bool on_surface;
  double limit;     ///< axial force at which the tissue yields [N]
  double friction;  ///< lateral over axial force on a surface
};

/// Reference place that carries a tip, the tet that holds it, and how far around it.
struct Support
{
  Vec3 X;
  int tet;
  double radius;  ///< [m]
};

/// A mean over the tissue within the support's radius: uniform in the ball, or (`disc`) with
/// Hertz's pressure sqrt(1 - r²/R²) on the disc normal to the frame's first axis. Sample places lie
/// along the frame; they come in opposite pairs that are dropped together where one is outside, so
/// that the mean place stays X.
constraint::Anchor tip_support(const mesh::Mesh& mesh, const mesh::Locator& locator,
                               const Support& support, const core::Mat3& frame, bool disc);

/// A pressed tip's axial row: 0 <= λ <= limit on δ = m·(tissue - tip), m the tangent. Inside, m
/// has the bevel's lateral part. On a surface two lateral rows add Coulomb's cone.
TipRows add_tip_rows(const TipState& tip, const TipLaw& law, const Iterate& at,
                     constraint::Set& set);

/// Takes the multipliers back into the tip. `tolerance` is the gap below which it touches [m].
TipOutcome accept_tip(TipState& tip, const TipRows& rows, const law::Multipliers& multipliers,
                      double tolerance);

}  // namespace trocar::insertion
