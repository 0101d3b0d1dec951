#pragma once

#include "core/math.hpp"
#include "insertion/ground.hpp"
#include "insertion/path.hpp"

namespace trocar::insertion {

/// Radius of the shaft that a ring of the radius x edges stands for, in edges, and the ratio of
/// that across the axis to that along it. Fitted on meshes of one size (docs/theory.md section 13).
struct EffectiveRadius
{
  double offset, inverse;  ///< f(x) = x + offset + inverse/x
  double lateral;          ///< ratio at a ring of the least radius; 1 - ratio falls as 1/x²
};
/// Of linear or quadratic tets with this dilatation; `poisson`: ν of the tissue.
EffectiveRadius effective_radius(bool quadratic, tissue::Dilatation dilatation, double poisson);

/// Compliance between two hats that the mesh hides: what the tissue around a line of the effective
/// radius R, which the mesh resolves, is stiffer than that around the shaft [m/N]. The potential of
/// a line load along the path, Kelvin's with the distance √(d² + r²), less the same with R.
struct LineCompliance
{
  core::MatX axial, lateral;  ///< (hats, hats), symmetric and positive semidefinite
};
LineCompliance hidden_compliance(const Ground& ground, const Line& line, double tip, double radius);

/// The same between every hat and the place of the tip on the path: what a force on the hat moves
/// the tissue at the tip beyond what the mesh shows [m/N].
struct TipCompliance
{
  core::VecX axial, lateral;  ///< (hats)
};
TipCompliance hidden_at_tip(const Ground& ground, const Line& line, double tip, double radius);

/// A tip that advances by `moved` [m], as the mesh sees it. Friction of `density` [N/m] on the
/// piece that it passes moves the tissue before it on by more than that: the tip passes less.
struct TipMove
{
  Vec3 X;          ///< where the tip was [m] (reference)
  int tet;         ///< there
  double depth;    ///< length of path behind it [m]
  double moved;    ///< [m]
  double density;  ///< [N/m]
  double radius;   ///< of the shaft [m]
};
/// Length of path that the tip passes [m].
double length_passed(const Ground& ground, const TipMove& move);

/// ∬ f(s) g(s') D ds ds' over two intervals, f and g linear, for the kernels
///   along:  D₁ = 1/√(d²+r²) - 1/√(d²+R²),
///   across: D₁ + D₂,  D₂ = ½ [r²/(d²+r²)^{3/2} - R²/(d²+R²)^{3/2}],  d = s - s'.
struct LinearPart
{
  double begin, end;    ///< [m]
  double value, slope;  ///< f at `begin`, and f' [1/m]
};
struct Potential
{
  double along, across;  ///< [m] for two intervals
};
Potential potential(const LinearPart& f, const LinearPart& g, double r, double R);
/// ∫ g(s') D ds' at the place s, without unit.
Potential potential_at(double s, const LinearPart& g, double r, double R);

}  // namespace trocar::insertion
