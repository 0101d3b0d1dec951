#pragma once

#include <variant>
#include <vector>

#include "constraint/set.hpp"
#include "contact/obstacle.hpp"
#include "contact/surface.hpp"

namespace trocar::contact {

/// What a slave surface may touch.
using Master = std::variant<Surface, Obstacle>;

/// Two surfaces, or a surface and an obstacle, that may touch.
struct Pair
{
  std::string name;
  Surface slave;
  Master master;
  double friction = 0.0;                                   ///< Coulomb's coefficient
  double shear = std::numeric_limits<double>::infinity();  ///< limit of the shear stress [Pa]
  double search = 0.0;       ///< farthest distance that is looked at [m]
  bool closed = false;       ///< see PairSettings::closed
  std::vector<bool> held{};  ///< slave corners that are prescribed, or slave of a pair before
};

/// The surroundings of a slave corner j, with its linear function φ_j over the covered part of the
/// slave surface. All means are weighted by φ_j.
struct Meeting
{
  int node;                          ///< file node of the corner
  constraint::Anchor slave, master;  ///< mean places; no master nodes: an obstacle
  double gap;                        ///< mean distance along the slave's normal [m]
  Vec3 normal;                       ///< out of the slave; into an obstacle
  double area;                       ///< covered ∫φ_j [m²]
  double least_gap;                  ///< least distance of a point around the corner [m]

  /// Counts an overlap of this size as closed.
  void open(double by)
  {
    gap += by;
    least_gap += by;
  }
};

/// The corners of a pair that have something within the search distance, in ascending order. Every
/// rank computes the same from the same numbers; not collective.
///
/// Segment to segment: each slave face is clipped with the master faces near it, and both sides are
/// integrated with the same points, projected along the interpolated slave normal. So the forces of
/// a multiplier on both sides add up to nothing. A held corner, or one covered below 1e-3 of
/// its ∫φ_j, joins its strongest neighbour.
std::vector<Meeting> meet(const Pair& pair, const Deformation& now);

/// True when the boxes of both sides, inflated by the search distance, meet. Cheap.
bool near(const Pair& pair, const Deformation& now);

}  // namespace trocar::contact
