#include "insertion/clip.hpp"

#include <gtest/gtest.h>

namespace trocar::insertion {
namespace {

using core::Vec3;

const std::array<Vec3, 4> corner_of_a_cube{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),
                                           Vec3(0, 0, 1)};

/// Where the line along x at these y and z is in the tet, from x = -1 on in lengths of 4.
std::optional<Span> along_x(double y, double z)
{
  return clip_line(corner_of_a_cube, Vec3(-1.0, y, z), Vec3(3.0, y, z));
}

TEST(Clip, LeavesTheStretchInsideTheTet)
{
  const auto span = along_x(0.2, 0.3);
  ASSERT_TRUE(span.has_value());
  EXPECT_NEAR(span->low, 0.25, 1e-15);
  EXPECT_NEAR(span->high, 0.25 + 0.5 / 4.0, 1e-15);
  EXPECT_FALSE(along_x(0.6, 0.5).has_value());
}

// Beside a face that it is parallel to, a line is inside up to a millionth of an edge.
TEST(Clip, BesideAParallelFaceIsOutside)
{
  EXPECT_TRUE(along_x(0.2, 0.0).has_value());
  EXPECT_TRUE(along_x(0.2, -5e-7).has_value());
  EXPECT_FALSE(along_x(0.2, -5e-6).has_value());
  EXPECT_FALSE(along_x(-0.05, 0.2).has_value());
}

}  // namespace
}  // namespace trocar::insertion
