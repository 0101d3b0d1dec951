#include "insertion/radius_correction.hpp"

#include <cmath>
#include <numbers>

namespace trocar::insertion {
double radius_fit(bool quadratic, bool shared_dilatation)
{
  if (quadratic) return 0.33;
  return shared_dilatation ? 0.4 : 0.54;
}

RadiusCorrection::Compliance RadiusCorrection::at(int needle, const tissue::Material& tissue,
                                                  double edge, double length) const
{
  const double r = radius[static_cast<std::size_t>(needle)];
  if (!(length > 0.0)) return {};
  // A smooth form of max(ln q, 0). With a corner at q = 1, rows without compliance would take over
  // the load of compliant rows beside them (docs/theory.md section 11).
  const double q = fit * edge / r;
  const double drop = 0.25 * std::log1p(q * q * q * q);
  const double axial = drop / (2.0 * std::numbers::pi * tissue.mu() * length);
  const double nu = tissue.poisson;
  return {axial, axial * (3.0 - 4.0 * nu) / (4.0 * (1.0 - nu))};
}

double lever_compliance(const tissue::Material& tissue, double a, double resolved)
{
  if (a >= resolved) return 0.0;
  const double nu = tissue.poisson;
  const double k = 8.0 * std::numbers::pi * tissue.mu() * (1.0 - nu) / (3.0 - 4.0 * nu);
  return 3.0 / k * (1.0 / a - 1.0 / resolved);
}

}  // namespace trocar::insertion
