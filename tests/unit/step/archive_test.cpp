#include "step/archive.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "insertion/channel.hpp"
#include "support/scene.hpp"

// Archives of states: what is not one is refused, and runs branch from one.
namespace trocar::step {
namespace {

using core::Vec3;

/// A bending needle that goes in at 1 cm/s, in quasi-static steps.
Scene going_in()
{
  Scene scene = test::needle_scenario(test::distorted);
  scene.needles[0].model = needle::Model::beam;
  scene.needles[0].section = {0.0004, 0.0, 5e10, 0.3};
  scene.needles[0].bevel = 0.5;
  scene.needles[0].motion.velocity = 0.02;
  scene.needles[0].motion.depth = 0.1;
  scene.insertion.friction = test::same({4.0, 4.0, 60.0});
  scene.insertion.tip.cutting = {0.05};
  scene.time.is_static = true;
  return scene;
}

State advanced(Model& model, State state, int first, int last)
{
  for (int n = first; n <= last; ++n) {
    auto next = advance(model, state, {0.05 * n, 0.05, true});
    EXPECT_TRUE(next) << next.why();
    state = std::move(next->state);
  }
  return state;
}

/// The base moves otherwise after one second: at `factor` times its speed, turned by `roll`.
void move_on(Scene& scene, double factor, double roll)
{
  needle::BaseMotion& motion = scene.needles[0].motion;
  const Vec3 start = motion.start().x, then = motion.at(1.0).x;
  const Vec3 end = then + factor * motion.velocity * motion.direction;
  const auto row = [](double t, const Vec3& x, double turn) {
    return std::to_string(t) + "," + std::to_string(x.x()) + "," + std::to_string(x.y()) + "," +
           std::to_string(x.z()) + ",1,0,0," + std::to_string(turn) + "\n";
  };
  motion.trajectory = core::parse_csv("time,x,y,z,dx,dy,dz,roll\n" + row(0.0, start, 0.0) +
                                          row(1.0, then, 0.0) + row(2.0, end, roll),
                                      "on.csv");
}

// One insertion and its continuations: as before to the last bit, faster, withdrawn and turned. The
// state they begin with stays what it is.
TEST(Branches, ShareOneInsertion)
{
  const Scene scene = going_in();
  Model model(scene, base::Comm(MPI_COMM_WORLD));
  const State saved = advanced(model, initial_state(model)->state, 1, 20);
  const core::Archive archive = archived(saved, model.space);
  model.drop_caches();
  const State through = advanced(model, saved, 21, 30);
  const auto branch = [&](const std::function<void(Scene&)>& change) {
    Scene other = going_in();
    change(other);
    Model fresh(other, base::Comm(MPI_COMM_WORLD));
    return advanced(fresh, restored(archive, fresh.space), 21, 30);
  };
  const State same = branch([](Scene&) {});
  EXPECT_EQ(archived(same, model.space), archived(through, model.space));
  const State faster = branch([](Scene& other) { move_on(other, 3.0, 0.0); });
  const State back = branch([](Scene& other) { move_on(other, -1.0, 0.0); });
  const State turned = branch([](Scene& other) { move_on(other, 1.0, 3.14159); });
  const auto depth = [](const State& state) { return insertion::depth(state.insertions[0]); };
  EXPECT_NEAR(depth(faster) - depth(saved), 3.0 * (depth(through) - depth(saved)), 1e-3);
  EXPECT_NEAR(depth(back) - depth(saved), depth(saved) - depth(through),
              2e-3);  // the tissue goes along
  const auto friction = [](const State& state) {
    double sum = 0.0;
    for (const auto& point : state.insertions[0].points) sum += point.lambda[2];
    return sum / insertion::depth(state.insertions[0]);
  };
  EXPECT_LT(friction(faster) / friction(through), 2.0);
  EXPECT_GT(friction(faster) / friction(through), 1.2);  // of the dashpots
  EXPECT_LT(friction(back) * friction(through), 0.0);
  // The bevel pushes the tip on one way, or back.
  const auto aside = [&](const State& state) -> Vec3 {
    const Vec3 way = state.needles[0].shaft.tip() - saved.needles[0].shaft.tip();
    return {0.0, way.y(), way.z()};
  };
  EXPECT_GT(aside(through).norm(), 1e-5);
  EXPECT_LT(aside(turned).dot(aside(through)), 0.5 * aside(through).squaredNorm());
  EXPECT_EQ(archived(saved, model.space), archive);
}

// Archives that are not whole, or not of this mesh, are told with 65 on every rank.
TEST(Archive, ThatIsNoStateIsRefused)
{
  const Scene scene = going_in();
  Model model(scene, base::Comm(MPI_COMM_WORLD));
  const State state = advanced(model, initial_state(model)->state, 1, 10);
  const core::Archive good = archived(state, model.space);
  const auto refused = [&](const char* what, const std::function<void(core::Archive&)>& change) {
    core::Archive bad = good;
    if (model.space.comm().root()) change(bad);
    try {
      restored(bad, model.space);
      ADD_FAILURE() << what << ": was taken";
    } catch (const core::Failure& failure) {
      EXPECT_EQ(failure.code(), core::ExitCode::data) << what;
    }
  };
  EXPECT_NO_THROW(restored(good, model.space));
  refused("a name less", [](core::Archive& a) { a.names.pop_back(); });
  refused("another name", [](core::Archive& a) { a.names[3] = "colour [1]"; });
  refused("a name more", [](core::Archive& a) { a.names.emplace_back("colour [1]"); });
  refused("a number less", [](core::Archive& a) { a.real.pop_back(); });
  refused("a number more", [](core::Archive& a) { a.real.push_back(1.0); });
  refused("a count less", [](core::Archive& a) { a.whole.pop_back(); });
  refused("nothing", [](core::Archive& a) { a = {}; });
  refused("a field less", [](core::Archive& a) { a.fields.pop_back(); });
  refused("a short field", [](core::Archive& a) { a.fields[0].values.pop_back(); });
}

// Every count in turn becomes a size, a flag or an index that is far off: refused, or a state that
// can be looked at; never a list of a thousand millions.
TEST(Archive, WithAnOddCountIsRefusedOrSound)
{
  const Scene scene = going_in();
  Model model(scene, base::Comm(MPI_COMM_WORLD));
  const State state = advanced(model, initial_state(model)->state, 1, 10);
  const core::Archive good = archived(state, model.space);
  std::vector<int> counts{static_cast<int>(good.whole.size())};
  model.space.comm().broadcast(counts);
  int taken = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(counts[0]); ++i) {
    core::Archive bad = good;
    for (long long odd : {-7LL, 1LL << 40, 2147483647LL}) {
      if (model.space.comm().root()) bad.whole[i] = odd;
      try {
        const State odd_state = restored(bad, model.space);
        ++taken;
        for (const auto& point : odd_state.insertions.at(0).points)
          EXPECT_LT(point.site, static_cast<int>(odd_state.insertions[0].path.sites.size()));
      } catch (const core::Failure& failure) {
        EXPECT_EQ(failure.code(), core::ExitCode::data) << "count " << i;
      }
    }
  }
  EXPECT_LT(taken, counts[0]);  // of three times as many
}

}  // namespace
}  // namespace trocar::step
