#include <gtest/gtest.h>

#include "core/polar.hpp"
#include "tissue/energy.hpp"

namespace trocar {
namespace {

// First Piola stress of a law in its own terms.
core::Mat3 stress_of(tissue::Model model, const tissue::Material& m, const core::Mat3& F)
{
  const core::Mat3 R =
      model == tissue::Model::linear ? core::Mat3::Identity() : core::polar_rotation(F);
  return m.mu() * tissue::energy::shear_gradient(model, R, F - core::Mat3::Identity()) +
         m.lambda() * tissue::energy::dilatation(model, R, F - core::Mat3::Identity()) *
             tissue::energy::dilatation_gradient(model, R, F - core::Mat3::Identity());
}

double energy_of(tissue::Model model, const tissue::Material& m, const core::Mat3& F)
{
  const core::Mat3 R =
      model == tissue::Model::linear ? core::Mat3::Identity() : core::polar_rotation(F);
  const double theta = tissue::energy::dilatation(model, R, F - core::Mat3::Identity());
  return m.mu() * tissue::energy::shear(model, R, F - core::Mat3::Identity()) +
         0.5 * m.lambda() * theta * theta;
}

// A turned body answers as the unturned one does in its own axes; stress is the derivative of the
// energy; near F = I every law is Hooke's.
TEST(Material, StressIsObjectiveAndTheDerivativeOfTheEnergy)
{
  const tissue::Material m{4000.0, 0.3, 1000.0, 0.0, 0.0};
  const core::Mat3 Q = core::rotation_exp(core::Vec3(1.0, -0.4, 0.3));
  core::Mat3 F;
  F << 1.1, 0.2, 0.0, -0.1, 0.95, 0.05, 0.02, 0.1, 1.2;
  const core::Mat3 e = 0.5 * (F + F.transpose()) - core::Mat3::Identity();
  const core::Mat3 hooke = 2.0 * m.mu() * e + m.lambda() * e.trace() * core::Mat3::Identity();
  for (const auto model :
       {tissue::Model::linear, tissue::Model::corotational, tissue::Model::neo_hookean}) {
    const core::Mat3 P = stress_of(model, m, F);
    if (model != tissue::Model::linear) {
      EXPECT_LT((stress_of(model, m, Q * F) - Q * P).norm(), 1e-10 * P.norm());
    }
    const double little = 1e-7;
    const core::Mat3 near = core::Mat3::Identity() + little * (F - core::Mat3::Identity());
    EXPECT_LT((stress_of(model, m, near) / little - hooke).norm(), 1e-5 * hooke.norm());
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        core::Mat3 d = core::Mat3::Zero();
        d(i, j) = 1e-6;
        EXPECT_NEAR((energy_of(model, m, F + d) - energy_of(model, m, F - d)) / 2e-6, P(i, j),
                    1e-6 * P.norm());
      }
  }
}

}  // namespace
}  // namespace trocar
