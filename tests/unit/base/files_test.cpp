#include "base/files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>

#include "base/comm.hpp"
#include "support/files.hpp"

namespace trocar::base {
namespace {

namespace fs = std::filesystem;

TEST(Files, AreReplacedAsAWhole)
{
  on_root(Comm(MPI_COMM_WORLD), [] {
    fs::create_directories("atomic");
    replace_file("atomic/text", "the first, longer one\n");
    replace_file("atomic/text", "the second\n");
    EXPECT_EQ(test::file_text("atomic/text"), "the second\n");
    const fs::directory_iterator all("atomic");
    EXPECT_EQ(std::distance(begin(all), end(all)), 1);  // nothing temporary is left
  });
}

// The folder of a bare name is "": the working folder is meant.
TEST(Files, MayLieInTheWorkingFolder)
{
  on_root(Comm(MPI_COMM_WORLD), [] {
    EXPECT_NO_THROW(replace_file("bare_name", "words"));
    EXPECT_EQ(test::file_text("bare_name"), "words");
  });
}

}  // namespace
}  // namespace trocar::base
