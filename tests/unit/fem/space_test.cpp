#include <gtest/gtest.h>

#include "support/body.hpp"

namespace trocar {
namespace {

const test::BlockShape distorted{4, 3, 3, core::Vec3(1.2, 1.0, 0.8), 0.25};

TEST(Space, EveryNodeHasOneOwnerAndGhostsArrive)
{
  const test::Body body(distorted);
  EXPECT_EQ(body.comm.sum(static_cast<long long>(body.space.owned())), body.mesh.node_count());
  fem::OwnedField x = body.space.zero();
  for (int i = 0; i < body.space.owned(); ++i)
    x.node(i) = body.mesh.x[static_cast<std::size_t>(body.space.file_node(i))];
  const auto ghosted = body.space.with_ghosts(x);
  for (int i = 0; i < body.space.local(); ++i)
    EXPECT_EQ(core::Vec3(ghosted.node(i)),
              body.mesh.x[static_cast<std::size_t>(body.space.file_node(i))]);
  const auto global = body.space.gather(x);
  for (int i = 0; i < body.mesh.node_count(); ++i)
    EXPECT_EQ(core::Vec3(global.node(i)), body.mesh.x[static_cast<std::size_t>(i)]);
  EXPECT_EQ(body.space.restrict_to_owned(global).value, x.value);
}

TEST(Space, RanksWithoutTetsAreAllowed)
{
  const test::Body body({1, 1, 1});
  EXPECT_EQ(body.comm.sum(static_cast<long long>(body.space.owned())), 8);
  EXPECT_EQ(body.space.gather(body.space.zero()).value.size(), 24);
}

}  // namespace
}  // namespace trocar
