#include <gtest/gtest.h>

#include "core/csv.hpp"
#include "core/failure.hpp"

namespace trocar::core {
namespace {

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

}  // namespace
}  // namespace trocar::core
