#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::insertion {

/// What a needle's shaft gives way to before a mesh much coarser than it can: between its radius r
/// and the nodes around it, h away, the displacement of a line load goes as its logarithm
/// (antiplane and plane strain; Love 1927, art. 148), while nodes carry the load as if it were
/// spread over h / fit. Over a length ℓ of the line the rows gain [m/N]
///   axial    ¼ ln(1 + (fit h / r)⁴) / (2π μ ℓ)
///   lateral  (3 - 4ν) / (4 (1 - ν)) of that:
/// the logarithm, going to nothing where the mesh is finer than the shaft is thick.
struct RadiusCorrection
{
  std::vector<double> radius;   ///< of every needle [m]
  std::vector<double> shear;    ///< μ by volume of the mesh [Pa]
  std::vector<double> poisson;  ///< by volume of the mesh
  double fit = 1.0;             ///< of the kind of tets, see `radius_fit`

  struct Compliance
  {
    double axial = 0.0, lateral = 0.0;  ///< [m/N]
  };
  /// `length` of the line held by the row [m]; `edge`: see local_edge [m].
  Compliance at(int needle, int region, double edge, double length) const;
};

/// fit of a kind of tets, measured on three meshes (docs/verification.md).
double radius_fit(bool quadratic, bool shared_dilatation);

}  // namespace trocar::insertion
