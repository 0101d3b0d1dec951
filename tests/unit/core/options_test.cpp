#include <gtest/gtest.h>

#include "core/failure.hpp"
#include "core/options.hpp"

namespace trocar::core {
namespace {

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
