#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "core/failure.hpp"
#include "driver/option_list.hpp"
#include "driver/program.hpp"

namespace trocar::driver {
namespace {

using core::OptionSpec;
using core::OptionType;

/// Reads an option by its type, as the program does.
void read(core::Options& options, const OptionSpec& spec)
{
  switch (spec.type) {
    case OptionType::real:
      options.real(spec.name, "any");
      break;
    case OptionType::integer:
      options.integer(spec.name, "any");
      break;
    case OptionType::flag:
      options.flag(spec.name, "any");
      break;
    case OptionType::names:
      options.names(spec.name, "any");
      break;
    case OptionType::vector:
      options.vector_or_free(spec.name, "any");
      break;
    default:
      options.text(spec.name, "any");
  }
}

TEST(OptionTable, DefaultsAreValuesOfTheirOwnOptions)
{
  core::Options options(option_table(), {});
  for (const OptionSpec& spec : option_table()) {
    EXPECT_NO_THROW(read(options, spec)) << spec.name;
    EXPECT_FALSE(spec.help.empty()) << spec.name;
  }
  EXPECT_NO_THROW(options.refuse_unread());
}

TEST(OptionTable, NamesEveryOptionOnceAndInLowerCase)
{
  std::set<std::string> names;
  for (const OptionSpec& spec : option_table()) {
    EXPECT_TRUE(names.insert(spec.name).second) << spec.name;
    EXPECT_EQ(spec.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_<>"), std::string::npos)
        << spec.name;
  }
}

// An option of one tissue, needle or cavity is read where the general one is: both are declared.
// Loads of a surface, ways for fluid and obstacles have no general one.
TEST(OptionTable, OverridesStandBesideTheGeneralOption)
{
  std::set<std::string> names;
  for (const OptionSpec& spec : option_table()) names.insert(spec.name);
  for (const std::string& name : names) {
    const auto open = name.find('<');
    if (open == std::string::npos) continue;
    if (name.rfind("boundary_", 0) == 0 || name.rfind("conduit_", 0) == 0 ||
        name.rfind("obstacle_", 0) == 0)
      continue;
    std::string general = name;
    general.erase(open, name.find('>') + 2 - open);
    EXPECT_TRUE(names.count(general)) << name;
  }
}

TEST(OptionTable, IsAllOfTheHelp)
{
  std::ostringstream help, markdown;
  print_help(help);
  print_markdown(markdown);
  for (const OptionSpec& spec : option_table()) {
    EXPECT_NE(help.str().find("-" + spec.name), std::string::npos) << spec.name;
    EXPECT_NE(markdown.str().find("-" + spec.name), std::string::npos) << spec.name;
  }
}

TEST(Questions, AreAnsweredWithoutAScene)
{
  const auto answered = [](std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    testing::internal::CaptureStdout();
    const bool done = answer_questions(static_cast<int>(argv.size()), argv.data());
    const std::string said = testing::internal::GetCapturedStdout();
    EXPECT_EQ(done, !said.empty());
    return said;
  };
  EXPECT_EQ(answered({"trocar", "-mesh", "help"}), "");
  EXPECT_EQ(answered({"trocar", "-quiet", "-version"}).rfind("trocar ", 0), 0U);
  EXPECT_NE(answered({"trocar", "-help"}).find("-tissue_young"), std::string::npos);
}

}  // namespace
}  // namespace trocar::driver
