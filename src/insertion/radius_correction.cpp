#include "insertion/radius_correction.hpp"

#include <cmath>
#include <numbers>

namespace trocar::insertion {
double radius_fit(bool quadratic, bool shared_dilatation)
{
  if (quadratic) return 0.33;
  return shared_dilatation ? 0.4 : 0.54;
}

RadiusCorrection::Compliance RadiusCorrection::at(int needle, int region, double edge,
                                                  double length) const
{
  const auto volume = static_cast<std::size_t>(region);
  const double r = radius[static_cast<std::size_t>(needle)];
  if (!(length > 0.0)) return {};
  // ln q where q > 1, and down to nothing without a corner: rows of no compliance beside soft ones
  // would take the load of these.
  const double q = fit * edge / r;
  const double drop = 0.25 * std::log1p(q * q * q * q);
  const double axial = drop / (2.0 * std::numbers::pi * shear[volume] * length);
  const double nu = poisson[volume];
  return {axial, axial * (3.0 - 4.0 * nu) / (4.0 * (1.0 - nu))};
}

}  // namespace trocar::insertion
