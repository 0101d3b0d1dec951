#include "core/option_text.hpp"

#include <gtest/gtest.h>

#include "core/failure.hpp"

namespace trocar::core {
namespace {

std::string refusal(const std::string& text)
{
  try {
    for (const WrittenOption& one : parse_option_text(text, "f.opts"))
      value_of(one, one.name == "gravity");
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::options);
    return failure.what();
  }
  return "accepted";
}

TEST(OptionText, AnyNumberOfOptionsStandsOnALine)
{
  const auto all = parse_option_text(
      "\xef\xbb\xbf-mesh a.msh # -fix b\n\n  -check -time_end 1\r\n#-quiet\n\t-fix x0,z1:xz -e "
      "-1e-3",
      "f.opts");
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[0].name, "mesh");
  EXPECT_EQ(value_of(all[0], false), "a.msh");
  EXPECT_EQ(all[1].name, "check");
  EXPECT_EQ(value_of(all[1], false), "");
  EXPECT_EQ(all[2].place, "f.opts:3");
  EXPECT_EQ(value_of(all[2], false), "1");
  EXPECT_EQ(value_of(all[3], false), "x0,z1:xz");
  EXPECT_EQ(value_of(all[4], false), "-1e-3");
}

TEST(OptionText, VectorsMayHaveBlanksAndTextsQuotes)
{
  const auto all = parse_option_text(
      "-gravity 0, 0 ,-9.81 -gravity 0 0 -9.81 -mesh \"my file.msh\" -fields \"\" -fix x0, z1",
      "f.opts");
  EXPECT_EQ(value_of(all[0], true), "0,0,-9.81");
  EXPECT_EQ(value_of(all[1], true), "0,0,-9.81");
  EXPECT_EQ(value_of(all[2], false), "my file.msh");
  EXPECT_EQ(value_of(all[3], false), "\"\"");
  EXPECT_EQ(value_of(all[4], false), "x0,z1");
}

TEST(OptionText, StrayWordsAreRefusedWithTheirLine)
{
  EXPECT_EQ(refusal("-check\ntissue_young 5\n"),
            "f.opts:2: 'tissue_young' belongs to no option: options begin with one dash");
  EXPECT_EQ(refusal("--check"),
            "f.opts:1: '--check' belongs to no option: options begin with one dash");
  EXPECT_EQ(refusal("-fix z0 z1"), "option -fix (f.opts:1): 'z1' behind 'z0' belongs to nothing");
  EXPECT_EQ(refusal("-gravity 0,0,-9.81\n-time_end 1 // s"),
            "option -time_end (f.opts:2): '//' behind '1' belongs to nothing");
  EXPECT_EQ(refusal("-mesh \"a b"), "f.opts:1: a quote does not end");
  EXPECT_EQ(refusal(std::string("-mesh a\0b", 9)), "f.opts:1: this is no text");
  EXPECT_EQ(refusal("\x1b[31m"),
            "f.opts:1: '\\x1b[31m' belongs to no option: options begin with one dash");
}

TEST(OptionText, WordsGivenByHandHaveNoPlace)
{
  const auto all = parse_option_words({"-a", "1", "-b"}, "");
  EXPECT_EQ(label_of(all[0]), "option -a");
  EXPECT_THROW(parse_option_words({"a", "-b"}, ""), Failure);
}

}  // namespace
}  // namespace trocar::core
