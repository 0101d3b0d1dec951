#pragma once

#include <vector>

#include "core/math.hpp"
#include "tissue/material.hpp"

namespace trocar::insertion {

/// Compliance of the tissue next to a thin shaft that the mesh is too coarse to resolve
/// (docs/theory.md section 11). The displacement of a line load grows as the logarithm of the
/// distance (antiplane and plane strain; Love 1927, art. 148). Nodes h apart carry the load as if
/// the shaft's radius were fit · h instead of r. Over a length ℓ of the line the rows gain [m/N]
///   axial    ¼ ln(1 + (fit h / r)⁴) / (2π μ ℓ)
///   lateral  (3 - 4ν) / (4 (1 - ν)) of that:
/// ln(fit h / r) on coarse meshes, and a smooth fall to 0 where the mesh is finer than the shaft.
struct RadiusCorrection
{
  std::vector<double> radius;  ///< by needle [m]
  double fit = 1.0;            ///< factor for the kind of tets, see `radius_fit`

  struct Compliance
  {
    double axial = 0.0, lateral = 0.0;  ///< [m/N]
  };
  /// Compliance of rows that hold the length `length` of path [m]; `edge`: see `local_edge` [m].
  Compliance at(int needle, const tissue::Material& tissue, double edge, double length) const;
};

/// Compliance of a lateral row at the distance a from the only other place that holds a needle
/// [m/N] (docs/theory.md section 4). Tissue resists the rotation θ of a stiff line of length a
/// about its entry with the moment k a³/3 θ, k = 8πμ(1 - ν)/(3 - 4ν) (a line load between two radii
/// with the ratio e). A single row at the end of the line would do the same with the compliance
/// 3/(k a). A tet resists as if the line were `resolved` long, however short the line is, so the
/// row only gets the difference 3/k (1/a - 1/resolved); 0 for a >= resolved. Lengths in metres.
double lever_compliance(const tissue::Material& tissue, double a, double resolved);

/// `fit` of a kind of tets, fitted on three meshes (docs/theory.md section 11).
double radius_fit(bool quadratic, bool shared_dilatation);

}  // namespace trocar::insertion
