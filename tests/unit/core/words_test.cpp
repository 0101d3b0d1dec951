#include <gtest/gtest.h>

#include "core/words.hpp"

namespace trocar::core {
namespace {

TEST(Words, NearestNameIsTheLeastEdited)
{
  EXPECT_EQ(nearest("botom", {"top", "bottom", "front"}), "bottom");
  EXPECT_EQ(nearest("x", {}), "");
  EXPECT_EQ(split(" a, b ,,c", ','), (std::vector<std::string>{"a", "b", "", "c"}));
}

}  // namespace
}  // namespace trocar::core
