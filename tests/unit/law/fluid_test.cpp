#include "law/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace trocar {
namespace {

using core::VecX;
using law::FluidLaw;

FluidLaw law_of(FluidLaw::Kind kind)
{
  FluidLaw law;
  law.kind = kind;
  law.bulk_modulus = 5e4;
  law.ambient = 1e5;
  law.table =
      law::MonotoneSpline({-2000, -500, 0, 800, 3000}, {4e-6, 3.5e-6, 3.4e-6, 3.4e-6, 2e-6});
  return law;
}

// Volumes take their amount at the reference pressure, fall with the pressure, and D is -dV/dp.
TEST(FluidLaws, VolumeAndCompliance)
{
  for (auto kind : {FluidLaw::Kind::constant_volume, FluidLaw::Kind::bulk, FluidLaw::Kind::gas,
                    FluidLaw::Kind::table}) {
    const FluidLaw law = law_of(kind);
    const double V = 3e-6, reference = 300.0;
    EXPECT_NEAR(law.at(reference, V, reference).volume, V, 1e-18);
    for (double p : {-2.5e5, -99e3, -1500.0, -200.0, 50.0, 400.0, 2000.0, 5000.0}) {
      const double h = 1e-2;
      const auto here = law.at(p, V, reference);
      const double slope =
          (law.at(p + h, V, reference).volume - law.at(p - h, V, reference).volume) / (2.0 * h);
      EXPECT_GE(here.compliance, 0.0);
      EXPECT_NEAR(-slope, here.compliance, 1e-6 * here.compliance + 1e-18) << p;
      const double per_amount = (law.at(p, 2.0 * V, reference).volume - here.volume) / V;
      EXPECT_NEAR(per_amount, here.per_amount, 1e-12 * std::abs(per_amount));
    }
  }
}

TEST(FluidLaws, GasObeysBoyle)
{
  const FluidLaw law = law_of(FluidLaw::Kind::gas);
  for (double p : {-5e4, 0.0, 2e5})
    EXPECT_NEAR(law.at(p, 2e-6, 500.0).volume * (p + 1e5), 2e-6 * (500.0 + 1e5), 1e-12);
}

// No wiggles: between points with falling values the spline falls.
// An amount is volume times density, whatever the pressure.
TEST(FluidLaws, DensityIsThatOfTheAmount)
{
  law::FluidLaw gas{law::FluidLaw::Kind::gas, 0.0, 1e4}, bulk{law::FluidLaw::Kind::bulk, 3e4, 0.0};
  for (const law::FluidLaw& fluid : {gas, bulk})
    for (double p : {-4000.0, 0.0, 2500.0, 9000.0})
      EXPECT_NEAR(fluid.at(p, 2e-6, 1000.0).volume * fluid.density(p), 2e-6 * fluid.density(1000.0),
                  1e-20);
  EXPECT_EQ(law::FluidLaw{}.density(5000.0), 1.0);
  EXPECT_TRUE(gas.mixes_with(gas));
  EXPECT_FALSE(gas.mixes_with(bulk));
  EXPECT_FALSE(gas.mixes_with(law::FluidLaw{}));
  EXPECT_TRUE(gas.mixes_with({law::FluidLaw::Kind::pressure}));
}

TEST(MonotoneSpline, KeepsMonotony)
{
  const law::MonotoneSpline spline({0, 1, 1.1, 2, 5, 5.01, 9}, {5, 4.9, 1, 0.9, 0.9, 0.2, -3});
  double last = spline.at(-1.0).y;
  for (double x = -1.0; x < 10.0; x += 1e-3) {
    EXPECT_LE(spline.at(x).y, last + 1e-14);
    last = spline.at(x).y;
  }
  EXPECT_EQ(spline.at(1.1).y, 1.0);
}

TEST(Network, FlowsAndTheirDerivative)
{
  const std::vector<law::Conduit> conduits{{0, 1, 2.0, false, 0.0},
                                           {1, -1, 0.5, false, 0.3},
                                           {2, 0, 1.0, true, 0.0},
                                           {-1, 2, 3.0, true, 0.0},
                                           {-1, 0, 0.0, false, 0.7}};
  const VecX p = Eigen::Vector3d(3.0, -1.0, 2.0);
  const law::Flows flows = law::network_flows(conduits, p);
  EXPECT_DOUBLE_EQ(flows.conduit[0], 8.0);
  EXPECT_DOUBLE_EQ(flows.conduit[1], -0.2);
  EXPECT_DOUBLE_EQ(flows.conduit[2], 0.0);  // valve against the drop
  EXPECT_DOUBLE_EQ(flows.conduit[3], 0.0);
  EXPECT_DOUBLE_EQ(flows.inflow[0], -8.0 + 0.7);
  EXPECT_DOUBLE_EQ(flows.inflow.sum(), -(-0.2) + 0.7);  // what goes outside and comes from there
  for (int j = 0; j < 3; ++j) {
    VecX q = p;
    q[j] += 1e-6;
    const VecX slope = (law::network_flows(conduits, q).inflow - flows.inflow) / 1e-6;
    EXPECT_LT((slope + flows.conductance.col(j)).norm(), 1e-8);
  }
  EXPECT_LT((flows.conductance - flows.conductance.transpose()).norm(), 1e-15);
}

// What flows is as dense as where it comes from: that much leaves there and arrives.
TEST(Network, CarriesTheDensityItComesWith)
{
  const law::Conduit tube{0, 1, 2.0, false, 0.0, 1.5, 0.8};
  for (double drop : {3.0, -3.0}) {
    const VecX p = Eigen::Vector2d(drop, 0.0);
    const law::Flows flows = law::network_flows({tube}, p);
    const double density = drop > 0.0 ? 1.5 : 0.8;
    EXPECT_DOUBLE_EQ(flows.conduit[0], 2.0 * drop);
    EXPECT_DOUBLE_EQ(flows.inflow[0], -density * 2.0 * drop);
    EXPECT_DOUBLE_EQ(flows.inflow[1], density * 2.0 * drop);
    EXPECT_DOUBLE_EQ(flows.conductance(0, 0), density * 2.0);
  }
}

}  // namespace
}  // namespace trocar
