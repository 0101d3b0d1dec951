#pragma once

#include <optional>
#include <vector>

#include "insertion/membranes.hpp"
#include "insertion/radius_correction.hpp"
#include "insertion/tip.hpp"

namespace trocar::insertion {

/// Shaft friction per length of one tissue in one direction (docs/theory.md section 5).
struct Friction
{
  double static_limit = 0.0;   ///< F/ℓ of a point that stuck at the start of the step [N/m]
  double dynamic_limit = 0.0;  ///< F/ℓ of a slipping point [N/m]
  double viscous = 0.0;        ///< b: force per length and slip velocity [N s/m²]
};

/// Friction of one tissue while the needle advances and while it is withdrawn.
struct TissueFriction
{
  Friction advance, withdraw;
};

struct InsertionSettings
{
  PlacementSettings placement;
  std::vector<TissueFriction> friction;  ///< by volume of the mesh
  double eta = 0.0;  ///< > 0: the axial force is η times that of sticking, instead of all friction
  double stick_tolerance = 1e-9;  ///< |δ| below which a point has stuck [m]
  TipSettings tip{};
  PunctureSettings puncture{};
  std::optional<RadiusCorrection> radius_correction{};
};

/// What needles go into: the mesh, and what it does to them. Borrows mesh and locator. Nothing of
/// this room is collective: every rank computes the same from the same.
struct Ground
{
  /// `tissues`: by volume of the mesh.
  Ground(const mesh::Mesh& mesh, const mesh::Locator& locator, InsertionSettings settings,
         std::vector<Elasticity> tissues);

  /// f_cut of the tissue a tet belongs to [N]; 0 in none (-1).
  double cutting(int tet) const;
  const Elasticity& elasticity(int tet) const;  ///< of the tissue a tet belongs to
  /// Force it takes to go at X from one tet into another (-1: none) [N]: a membrane's threshold,
  /// and what is cut with a force is not entered without it.
  double border(int from, int to, const Vec3& X) const;

  const mesh::Mesh& mesh;
  const mesh::Locator& locator;
  InsertionSettings settings;
  std::vector<Elasticity> tissues;  ///< by volume of the mesh
  Membranes membranes;
  bool resists = false;  ///< some border or tissue resists the tip
};

}  // namespace trocar::insertion
