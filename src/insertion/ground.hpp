#pragma once

#include <optional>
#include <vector>

#include "insertion/line.hpp"
#include "insertion/membranes.hpp"
#include "insertion/path.hpp"
#include "insertion/radius_correction.hpp"
#include "insertion/tip.hpp"
#include "mesh/smoothed_edges.hpp"

namespace trocar::insertion {

/// Shaft friction per length in one tissue and direction of motion (docs/theory.md section 5).
struct Friction
{
  double static_limit = 0.0;   ///< bound F/ℓ of a point stuck at the start of the step [N/m]
  double dynamic_limit = 0.0;  ///< bound F/ℓ of a slipping point [N/m]
  double viscous = 0.0;        ///< b: force per length and slip velocity [N s/m²]

  bool operator==(const Friction&) const = default;
};

/// Friction of one tissue while the needle advances and while it is withdrawn.
struct TissueFriction
{
  Friction advance, withdraw;

  bool operator==(const TissueFriction&) const = default;
};

struct InsertionSettings
{
  PlacementSettings placement;
  std::vector<TissueFriction> friction;  ///< by physical volume of the mesh
  double eta = 0.0;  ///< > 0 replaces all friction: the axial force is η times that of sticking
  double stick_tolerance = 1e-9;  ///< |δ| up to which a point counts as stuck [m]
  TipSettings tip{};
  PunctureSettings puncture{};
  std::optional<RadiusCorrection> radius_correction{};
  LineSettings line{};  ///< for `Placement::line`
};

/// What needles go into: the mesh with its resistance to tips and shafts. Borrows mesh and locator.
/// Nothing in this room is collective: every rank computes the same results from the same numbers.
struct Ground
{
  /// `materials`: by physical volume of the mesh.
  Ground(const mesh::Mesh& mesh, const mesh::Locator& locator, InsertionSettings settings,
         std::vector<tissue::Material> materials);

  /// f_cut of the tissue that a tet belongs to [N]; 0 outside the tissue (tet -1).
  double cutting(int tet) const;
  const tissue::Material& material(int tet) const;  ///< of the tissue that a tet belongs to
  /// Force that a tip needs to go from one tet into another (-1: no tissue) at the reference place
  /// X [N]: the membrane's threshold, and at least f_cut of `to` unless `from` is cut with a force
  /// too.
  double border(int from, int to, const Vec3& X) const;

  std::size_t region(int tet) const  ///< index of the physical volume of a tet
  {
    return static_cast<std::size_t>(mesh.region[static_cast<std::size_t>(tet)]);
  }
  /// Number of the connected body that a tet belongs to.
  int body(int tet) const { return field().body_of(tet); }
  /// What a path grows through: the tets of one body, or of all (-1).
  Field field(int body = -1) const
  {
    return {mesh, locator, settings.placement, body_of_node, body};
  }
  /// The lowest tet at the reference place X that belongs to the body of `near`, or `near` itself.
  int tet_at(const Vec3& X, int near) const;
  bool along_line() const { return settings.placement.placement == Placement::line; }

  const mesh::Mesh& mesh;
  const mesh::Locator& locator;
  InsertionSettings settings;
  std::vector<tissue::Material> materials;  ///< by physical volume of the mesh
  Membranes membranes;
  std::optional<mesh::SmoothedEdges> edges;  ///< for `Placement::line`
  std::vector<int> body_of_node;             ///< number of the connected body of every node
  int bodies = 0;
  bool resists = false;  ///< some membrane or tissue of the mesh resists the tip
};

}  // namespace trocar::insertion
