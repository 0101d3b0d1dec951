#include <gtest/gtest.h>

#include "support/cavity.hpp"

namespace trocar {
namespace {

using cavity::Model;
using cavity::Solver;
using core::Vec3;
using test::solved;

// The fluid's weight rests on its wall, ρ g V in all, and the support below carries it.
TEST(Gravity, WeightOfTheFluidArrives)
{
  for (Model model : {Model::linear, Model::frozen, Model::follower}) {
    step::Scene scenario = test::cavity_scenario(5, 3, model, Solver::exact);
    scenario.tissue.boundary.fixed.clear();
    scenario.tissue.boundary.displacements = {{"z0", Vec3::Zero(), std::nullopt}};
    scenario.cavities.cavities[0].weight = Vec3(0.0, 0.0, -9810.0);
    const step::StepReport report = solved(scenario);
    // Only a follower's weight is that of the deformed cavity; of constant volume they are the
    // same.
    const double weight = 9810.0 * 2.7e-5;
    EXPECT_NEAR(report.holders.tools[0].z(), weight, 1e-6 * weight);
    EXPECT_NEAR(report.holders.tools[0].x(), 0.0, 1e-6 * weight);
  }
}

}  // namespace
}  // namespace trocar
