#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math.hpp"
#include "core/polar.hpp"

namespace trocar::core {
namespace {

TEST(Rotation, LogInvertsExpUpToHalfATurn)
{
  for (double angle : {1e-14, 1e-9, 1e-3, 1.0, 3.0, 3.14159}) {
    const Vec3 w = angle * Vec3(1, -2, 0.5).normalized();
    EXPECT_LT((rotation_log(rotation_exp(w)) - w).norm(), 1e-9 * std::max(angle, 1e-3));
  }
}

TEST(Rotation, PolarRecoversTheRotationOfAnyStretch)
{
  const Mat3 R = rotation_exp(Vec3(0.4, -1.1, 2.0));
  Mat3 U;
  U << 1.7, 0.2, -0.1, 0.2, 0.4, 0.05, -0.1, 0.05, 1.1;
  EXPECT_LT((polar_rotation(R * U) - R).norm(), 1e-13);
  // A nearly flat element still has a rotation.
  EXPECT_LT((polar_rotation(R * Vec3(1, 1, 1e-6).asDiagonal()) - R).norm(), 1e-8);
}

TEST(Rotation, PolarBatchEqualsOneByOne)
{
  PolarBatch batch;
  std::array<Mat3, PolarBatch::width> F;
  for (int lane = 0; lane < PolarBatch::width; ++lane) {
    // From hardly strained to nearly flat: lanes need different numbers of iterations.
    const Mat3 U = Vec3(1.0 + 0.3 * lane, 1.0, std::pow(10.0, -0.7 * lane)).asDiagonal();
    F[static_cast<std::size_t>(lane)] = rotation_exp(Vec3(0.4 * lane, -1.1, 0.2)) * U;
    batch.set(lane, F[static_cast<std::size_t>(lane)]);
  }
  batch.rotate();
  for (int lane = 0; lane < PolarBatch::width; ++lane) {
    const Mat3 R = batch.get(lane);
    EXPECT_LT((R - polar_rotation(F[static_cast<std::size_t>(lane)])).norm(), 1e-9);
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-13);
    // To the last bit whatever is beside it.
    PolarBatch others;
    for (int k = 0; k < PolarBatch::width; ++k) others.set(k, Mat3::Identity());
    others.set(lane, F[static_cast<std::size_t>(lane)]);
    others.rotate();
    EXPECT_EQ(others.get(lane), R);
  }
}

TEST(Rotation, FrameAlongIsOrthonormalForEveryDirection)
{
  for (const Vec3& t : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(1, 1, 1)}) {
    const Mat3 R = frame_along(t.normalized());
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-15);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-15);
    EXPECT_LT((R.col(0) - t.normalized()).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace trocar::core
