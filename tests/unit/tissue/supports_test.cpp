#include <gtest/gtest.h>

#include "core/failure.hpp"
#include "support/body.hpp"
#include "tissue/bodies.hpp"

namespace trocar {
namespace {

TEST(Supports, FloatingBodiesAreRefusedInStatics)
{
  const auto refused = [](std::vector<tissue::BoundaryConditions::Fixed> fixed) {
    tissue::TissueSettings settings;
    settings.boundary.fixed = std::move(fixed);
    test::Body body({2, 2, 2}, settings);
    try {
      tissue::require_supports(body.tissue.fixed(), body.mesh);
      return false;
    } catch (const core::Failure& failure) {
      return failure.code() == core::ExitCode::options;
    }
  };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused({{"z0", 4}}));
  EXPECT_TRUE(refused({{"z0", 4}, {"x0", 1}}));
  EXPECT_FALSE(refused({{"z0", 4}, {"x0", 1}, {"y0", 2}}));
  EXPECT_FALSE(refused({{"z0", 7}}));
}

}  // namespace
}  // namespace trocar
