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

TEST(Words, MessagesShowNoControlCharacters)
{
  EXPECT_EQ(printable("a\nb\t\x1b[31m\x7f"), "a\\nb\\t\\x1b[31m\\x7f");
  EXPECT_EQ(printable("µm – é 漢 \U0001f489"), "µm – é 漢 \U0001f489");
  EXPECT_EQ(printable("\xc3(\xff\xe2\x80"), "\\xc3(\\xff\\xe2\\x80");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\xc2\\x9b2J");  // a control character of one byte elsewhere
  EXPECT_EQ(printable("\u202ecba"), "\\xe2\\x80\\xaecba");  // writes from right to left
  EXPECT_EQ(printable(std::string(5000, 'x') + "end", 10), "xxxxx...xxend");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(listed({3, 1, 2}), "3, 1, 2");
  EXPECT_EQ(listed({1, 2, 3, 4, 5, 6}), "1, 2, 3, 4, 5, ...");
}

}  // namespace
}  // namespace trocar::core
