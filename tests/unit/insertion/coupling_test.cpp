#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "constraint/system.hpp"
#include "insertion/channel.hpp"
#include "insertion/coupling.hpp"
#include "support/block.hpp"
#include "support/problem.hpp"

namespace trocar::insertion {
namespace {

/// A needle 40 mm deep in a bar of cells of 1 cm, with a point every 12 mm.
struct Inserted
{
  explicit Inserted(const Friction& friction, double fit = 0.0)
      : mesh(test::block({6, 4, 4, Vec3(0.06, 0.04, 0.04), 0.0})),
        locator(mesh),
        u{core::VecX::Zero(3 * mesh.node_count())},
        tissue(mesh, locator, u),
        needle(settings()),
        ground(mesh, locator, laws(friction, fit), {{5600.0, 0.4}}),
        state(start(ground, needle))
  {
  }
  static needle::NeedleSettings settings()
  {
    needle::NeedleSettings settings;
    settings.model = needle::Model::rigid;
    settings.section = {0.0005, 0.0, 2e11, 0.3};
    settings.motion.entry = Vec3(0.0, 0.0171, 0.0223);
    settings.motion.length = 0.2;
    settings.motion.inserted = 0.04;
    return settings;
  }
  static InsertionSettings laws(const Friction& friction, double fit)
  {
    InsertionSettings laws{
        {Placement::spacing, 0.012, 0.3}, {TissueFriction{friction, friction}}, 0.0, 1e-9};
    if (fit > 0.0) laws.radius_correction = RadiusCorrection{{0.0005}, fit};
    return laws;
  }
  /// Compliance of the rows in tissue that gives way to every probe by itself [m/N], and the rows.
  law::Problem problem(double h)
  {
    constraint::Set set;
    const needle::Shaft shaft = needle.initial().shaft;
    rows = add_rows(ground, state, {shaft, tissue, 0, h}, set);
    const constraint::System system(set, {});
    const auto size = static_cast<Eigen::Index>(system.probes().size());
    return system.problem(system.compliance(1e-3 * core::MatX::Identity(size, size)),
                          core::VecX::Zero(size));
  }

  mesh::Mesh mesh;
  mesh::Locator locator;
  fem::GlobalField u;
  Deformed tissue;
  needle::Needle needle;
  Ground ground;
  InsertionState state;
  CouplingRows rows;
};

// Every point has the path that is nearer to it than to any other: 0, 12, 24 and 36 mm in 40 mm.
TEST(Tributary, BordersAreHalfWayBetweenThePoints)
{
  Inserted one({2.0, 1.0, 0.0});
  const core::VecX length = tributary_lengths(one.mesh, one.state).rowwise().sum();
  ASSERT_EQ(length.size(), 4);
  const Eigen::Vector4d expected(0.006, 0.012, 0.012, 0.01);
  EXPECT_LT((length - expected).norm(), 1e-12);
  law::Problem problem = one.problem(0.01);
  for (std::size_t k = 0; k < 4; ++k)  // at rest: the static limit
    EXPECT_NEAR(test::law_of(problem, one.rows.points[k].axial).upper,
                2.0 * expected[static_cast<Eigen::Index>(k)], 1e-12);
}

// A line load in a mesh much coarser than the shaft: along it ln(a h/r)/(2πμℓ), across it Kelvin's
// (3 - 4ν)/(4(1 - ν)) of that; where the mesh is finer than the shaft is thick nothing.
TEST(RadiusCorrection, IsTheLogarithmOfALineLoad)
{
  const double mu = 2000.0, nu = 0.4, r = 0.0005, length = 0.01;
  const RadiusCorrection correction{{r}, 0.5};
  const tissue::Material tissue{2.0 * mu * (1.0 + nu), nu};
  const auto coarse = correction.at(0, tissue, 100.0 * r, length);
  const double line = std::log(50.0) / (2.0 * std::numbers::pi * mu * length);
  EXPECT_NEAR(coarse.axial, line, 1e-6 * line);
  EXPECT_NEAR(coarse.lateral, line * 1.4 / 2.4, 1e-6 * line);
  EXPECT_LT(correction.at(0, tissue, 0.2 * r, length).axial, 1e-4 * line);
  EXPECT_EQ(correction.at(0, tissue, 100.0 * r, 0.0).axial, 0.0);
}

// Dashpot and dry friction act on the same piece of shaft: the tissue gives way to their sum, and
// with the correction for the needle's radius by more, alike for both.
TEST(RadiusCorrection, IsSharedByDashpotAndDryFriction)
{
  Inserted bare({2.0, 2.0, 50.0}), corrected({2.0, 2.0, 50.0}, 0.5);
  const double h = 0.01;
  const law::Problem without = bare.problem(h), with = corrected.problem(h);
  for (std::size_t k = 0; k < 4; ++k) {
    const int dry = corrected.rows.points[k].axial, viscous = corrected.rows.points[k].viscous;
    ASSERT_GE(std::min(dry, viscous), 0);
    const double alone = without.W(dry, dry);
    EXPECT_NEAR(without.W(viscous, dry), alone, 1e-12 * alone);
    EXPECT_GT(with.W(dry, dry), 1.001 * alone);
    EXPECT_NEAR(with.W(viscous, viscous), with.W(dry, dry), 1e-12 * alone);
    EXPECT_NEAR(with.W(viscous, dry), with.W(dry, dry), 1e-12 * alone);
  }
}

}  // namespace
}  // namespace trocar::insertion
