#include <gtest/gtest.h>

#include <functional>

#include "core/failure.hpp"
#include "support/block.hpp"

namespace trocar {
namespace {

TEST(Groups, UnknownNamesAreRefusedWithTheNearest)
{
  const mesh::Mesh mesh = test::block({});
  for (const auto& look : {std::function([&] { mesh::surface_group(mesh, "x9"); }),
                           std::function([&] { mesh::group_nodes(mesh, "zz"); })}) {
    try {
      look();
      ADD_FAILURE();
    } catch (const core::Failure& failure) {
      EXPECT_EQ(failure.code(), core::ExitCode::data);
      EXPECT_NE(std::string(failure.what()).find("did you mean"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace trocar
