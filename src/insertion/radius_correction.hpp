#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::insertion {

/// A tissue's at rest.
struct Elasticity
{
  double shear = 0.0;    ///< μ [Pa]
  double poisson = 0.0;  ///< ν
};

/// What a needle's shaft gives way to before a mesh much coarser than it can: between its radius r
/// and the nodes around it, h away, the displacement of a line load goes as its logarithm
/// (antiplane and plane strain; Love 1927, art. 148), while nodes carry the load as if it were
/// spread over h / fit. Over a length ℓ of the line the rows gain [m/N]
///   axial    ¼ ln(1 + (fit h / r)⁴) / (2π μ ℓ)
///   lateral  (3 - 4ν) / (4 (1 - ν)) of that:
/// the logarithm, going to nothing where the mesh is finer than the shaft is thick.
struct RadiusCorrection
{
  std::vector<double> radius;  ///< of every needle [m]
  double fit = 1.0;            ///< of the kind of tets, see `radius_fit`

  struct Compliance
  {
    double axial = 0.0, lateral = 0.0;  ///< [m/N]
  };
  /// `length` of the line held by the row [m]; `edge`: see local_edge [m].
  Compliance at(int needle, const Elasticity& tissue, double edge, double length) const;
};

/// What a row at the end of a lever of length a gives way by [m/N] beside what a tet does. A stiff
/// line from the surface to depth a, turned by θ about its entry, is held by the moment k a³/3 θ,
/// k = 8πμ(1 - ν)/(3 - 4ν) (a line load between two radii one e apart): one row at its end gives
/// way by 3/(k a). A tet holds it as if it were `resolved` long, however short it is: the row gives
/// way by the difference, 0 from there on. Lengths in metres.
double lever_compliance(const Elasticity& tissue, double a, double resolved);

/// fit of a kind of tets, measured on three meshes (docs/verification.md).
double radius_fit(bool quadratic, bool shared_dilatation);

}  // namespace trocar::insertion
