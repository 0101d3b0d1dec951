#include <gtest/gtest.h>

#include "core/csv.hpp"
#include "core/failure.hpp"
#include "core/math.hpp"
#include "core/options.hpp"
#include "core/polar.hpp"
#include "core/words.hpp"

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

TEST(Words, NearestNameIsTheLeastEdited)
{
  EXPECT_EQ(nearest("botom", {"top", "bottom", "front"}), "bottom");
  EXPECT_EQ(nearest("x", {}), "");
  EXPECT_EQ(split(" a, b ,,c", ','), (std::vector<std::string>{"a", "b", "", "c"}));
}

TEST(Csv, InterpolatesLinearlyAndHoldsTheEnds)
{
  const Csv table = parse_csv("time,f\n# note\n0,1\n\n2,5\n", "t.csv");
  EXPECT_EQ(interpolate(table, 1, -1.0), 1.0);
  EXPECT_EQ(interpolate(table, 1, 0.5), 2.0);
  EXPECT_EQ(interpolate(table, 1, 9.0), 5.0);
}

TEST(Csv, NamesLineAndColumnOfABadCell)
{
  for (const char* text : {"time,f\n0,nan\n", "time,f\n0,inf\n", "time,f\n0,\n", "time,f\n0\n",
                           "time,f\n", "", "time,f\n0,1x\n"}) {
    try {
      parse_csv(text, "t.csv");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::data);
      EXPECT_NE(std::string(failure.what()).find("t.csv"), std::string::npos);
    }
  }
  EXPECT_THROW(require_time_column(parse_csv("time,f\n1,0\n1,0\n", "t.csv")), Failure);
}

class OptionsTest : public ::testing::Test
{
 protected:
  std::vector<OptionSpec> table{
      {"young", OptionType::real, "5", "Pa", "", 0.0, 1e9, true, false},
      {"mat_<volume>_young", OptionType::real, "5", "Pa", "", 0.0, 1e9, true, false},
      {"mat_young", OptionType::real, "7", "Pa", "", 0.0, 1e9, true, false},
      {"names", OptionType::names, "\"\"", "", ""},
      {"g", OptionType::vector, "0,0,0", "m", ""},
      {"n", OptionType::integer, "3", "1", "", 1.0, 10.0},
      {"law", OptionType::choice, "a", "", "", 0, 0, false, false, {"a", "bee"}},
      {"f", OptionType::flag, "false", "", ""}};
  Options with(std::map<std::string, OptionValue> given)
  {
    return Options(table, std::move(given));
  }
};

TEST_F(OptionsTest, OverridesFallBackToTheGeneralOption)
{
  Options options = with({{"mat_young", {"11", "file"}}, {"mat_liver_young", {"13", "file"}}});
  EXPECT_EQ(options.real("mat_<volume>_young", "liver"), 13.0);
  EXPECT_EQ(options.real("mat_<volume>_young", "skin"), 11.0);
  EXPECT_NO_THROW(options.refuse_unread());
  EXPECT_EQ(options.resolved().size(), 2U);
}

TEST_F(OptionsTest, AnOverrideOfNothingIsRefused)
{
  Options options = with({{"mat_livr_young", {"13", "file"}}});
  options.real("mat_<volume>_young", "liver");
  EXPECT_THROW(options.refuse_unread(), Failure);
}

TEST_F(OptionsTest, BadValuesAreRefusedWithTheOptionsName)
{
  const auto refuses = [&](const std::string& name, const std::string& value, auto read) {
    Options options = with({{name, {value, "file"}}});
    try {
      read(options);
      ADD_FAILURE() << name << " accepted " << value;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::options);
      EXPECT_NE(std::string(failure.what()).find("-" + name), std::string::npos);
    }
  };
  for (const char* bad : {"-1", "0", "nan", "inf", "2e9", "", "5 Pa", "1e"})
    refuses("young", bad, [](Options& o) { o.real("young"); });
  for (const char* bad : {"0", "11", "2.5", "x"})
    refuses("n", bad, [](Options& o) { o.integer("n"); });
  for (const char* bad : {"1,2", "1,2,3,4", "1,,3", "a,b,c", "free,0,0"})
    refuses("g", bad, [](Options& o) { o.vector("g"); });
  refuses("names", "a,,b", [](Options& o) { o.names("names"); });
  refuses("names", "a,a", [](Options& o) { o.names("names"); });
  refuses("law", "be", [](Options& o) { o.text("law"); });
  refuses("f", "maybe", [](Options& o) { o.flag("f"); });
}

}  // namespace
}  // namespace trocar::core
