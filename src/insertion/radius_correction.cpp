#include "insertion/radius_correction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trocar::insertion {
double radius_fit(bool quadratic, bool shared_dilatation)
{
  if (quadratic) return 0.35;
  return shared_dilatation ? 0.39 : 0.52;
}

RadiusCorrection::Softness RadiusCorrection::at(int needle, int region, double edge,
                                                double length) const
{
  const auto volume = static_cast<std::size_t>(region);
  const double r = radius[static_cast<std::size_t>(needle)];
  if (!(length > 0.0)) return {};
  const double axial =
      std::max(0.0, std::log(fit * edge / r)) / (2.0 * std::numbers::pi * shear[volume] * length);
  const double nu = poisson[volume];
  return {axial, axial * (3.0 - 4.0 * nu) / (4.0 * (1.0 - nu))};
}

}  // namespace trocar::insertion
