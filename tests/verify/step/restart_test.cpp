#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "step/archive.hpp"
#include "support/cavity.hpp"
#include "support/elements.hpp"
#include "support/scene.hpp"

// A checkpoint between any two steps of any kind of scene: a run that goes through with its caches
// dropped there, and a model that knows nothing but the archive, come to the same to the last bit.
namespace trocar::step {
namespace {

using core::Vec3;
using Change = std::function<void(Scene&)>;

/// Steps of these lengths, with a checkpoint before step `at` of the first run and after which the
/// second run goes on.
void expect_equal_from(const Scene& scene, const std::vector<double>& lengths, std::size_t at)
{
  Model through(scene, base::Comm(MPI_COMM_WORLD)), fresh(scene, base::Comm(MPI_COMM_WORLD));
  auto begun = initial_state(through);
  ASSERT_TRUE(begun) << begun.why();
  State a = std::move(begun->state), b;
  double t = 0.0;
  for (std::size_t n = 0; n < lengths.size(); ++n) {
    if (n == at) {
      b = restored(archived(a, through.space), fresh.space);
      through.drop_caches();
      through.ledger = fresh.ledger = {};
    }
    t += lengths[n];
    const core::TimeStep now{t, lengths[n], scene.time.is_static};
    const auto step = [&](Model& model, State& state) {
      auto next = now.is_static ? equilibrium(model, state, now) : advance(model, state, now);
      ASSERT_TRUE(next) << "step " << n << ": " << next.why();
      state = std::move(next->state);
    };
    step(through, a);
    if (n < at) continue;
    step(fresh, b);
    ASSERT_EQ(archived(a, through.space), archived(b, fresh.space)) << "step " << n;
    EXPECT_EQ(through.ledger.entries(), fresh.ledger.entries()) << "step " << n;
  }
}

/// Steps of 0.1 s, of which some are halved and some twice as long.
const std::vector<double> uneven{0.1, 0.1, 0.05, 0.05, 0.1, 0.2, 0.05, 0.05, 0.1};

/// A beam that goes into a small block.
Scene into_block(bool quadratic)
{
  test::BlockShape shape{4, 3, 3, Vec3(0.06, 0.04, 0.04), 0.2};
  shape.quadratic = quadratic;
  Scene scene = test::needle_scenario(shape);
  scene.needles[0].model = needle::Model::beam;
  scene.needles[0].section = {0.0004, 0.0, 5e10, 0.3};
  scene.needles[0].elements = 4;
  scene.tissue.lag_tolerance = 1e-8;  // the default of the program
  scene.tissue.boundary.gravity = Vec3(0, 0, -1.0);
  return scene;
}

// Every element with every law, exact and rotated tangents, steps of different lengths on both
// sides.
TEST(RestartOf, EveryElementAndLaw)
{
  for (const test::Kind& kind : test::kinds) {
    SCOPED_TRACE(kind.name);
    Scene scene = into_block(kind.quadratic);
    scene.tissue.dilatation = kind.dilatation;
    scene.tissue.model = kind.model;
    scene.tissue.tangent = kind.tangent;
    expect_equal_from(scene, uneven, 3);
    scene.tissue.tangent = tissue::Tangent::automatic;
    expect_equal_from(scene, uneven, 6);
  }
}

// Volumes of different laws.
TEST(RestartOf, AMixtureOfLaws)
{
  Scene scene = into_block(true);
  scene.mesh.volumes = {"fat", "muscle"};
  for (std::size_t t = 0; t < scene.mesh.region.size(); t += 2) scene.mesh.region[t] = 1;
  scene.tissue.materials.push_back(scene.tissue.materials[0]);
  scene.tissue.materials[1].model = tissue::Model::neo_hookean;
  scene.insertion.friction.push_back(scene.insertion.friction[0]);
  expect_equal_from(scene, uneven, 4);
}

// Every way to take a step, and scenes in which little or nothing happens.
TEST(RestartOf, EveryKindOfStep)
{
  const std::vector<std::pair<std::string, Change>> ways{
      {"nothing happens", [](Scene& s) { s.needles[0].motion.velocity = 0.0; }},
      {"no needle", [](Scene& s) { s.needles.clear(); }},
      {"no friction", [](Scene& s) { s.insertion.friction = test::same({}); }},
      {"viscous",
       [](Scene& s) {
         s.insertion.friction = test::same({0.0, 0.0, 40.0});
       }},
      {"stick and slip",
       [](Scene& s) {
         s.insertion.friction = test::same({30.0, 10.0, 1.0});
       }},
      {"eta", [](Scene& s) { s.insertion.eta = 0.5; }},
      {"cut and pierced",
       [](Scene& s) {
         s.insertion.tip.cutting = {0.05};
         s.insertion.puncture.volume = {0.1};
         s.needles[0].bevel = 0.4;
       }},
      {"withdrawn",
       [](Scene& s) {
         s.needles[0].motion.depth = 0.006;
         s.needles[0].motion.withdraw_velocity = 0.03;
       }},
      {"spacing",
       [](Scene& s) {
         s.insertion.placement.placement = insertion::Placement::spacing;
         s.insertion.placement.spacing = 0.002;
       }},
      {"along a line",
       [](Scene& s) { s.insertion.placement.placement = insertion::Placement::line; }},
      {"along a line, drawn back",
       [](Scene& s) {
         s.insertion.placement.placement = insertion::Placement::line;
         s.insertion.friction = test::same({5.0, 3.0, 20.0});
         s.needles[0].motion.depth = 0.009;
         s.needles[0].motion.withdraw_velocity = 0.03;
       }},
      {"static", [](Scene& s) { s.time.is_static = true; }},
      {"BDF2 with energy",
       [](Scene& s) {
         s.time.second_order = true;
         s.energy = true;
       }},
      {"one linearisation", [](Scene& s) { s.time.newton_max = 1; }},
      {"iterated", [](Scene& s) { s.time.newton_max = 20; }},
      {"stale", [](Scene& s) { s.tissue.reuse = solve::Reuse::stale; }},
      {"no reuse", [](Scene& s) { s.tissue.reuse = solve::Reuse::none; }},
      {"two needles", [](Scene& s) {
         s.needles.push_back(s.needles[0]);
         s.needles[1].name = "other";
         s.needles[1].motion.entry = Vec3(0, 0.0273, 0.0131);
       }}};
  for (const auto& [name, change] : ways) {
    SCOPED_TRACE(name);
    Scene scene = into_block(false);
    scene.tissue.model = tissue::Model::corotational;
    change(scene);
    expect_equal_from(scene, uneven, 4);
  }
}

// With the tissue's solver from PETSc the last bits are not promised, but 1e-9 is.
TEST(RestartOf, AnotherSolver)
{
  Scene scene = into_block(false);
  scene.tissue.model = tissue::Model::corotational;
  scene.tissue.provider = solve::Provider::ksp_block;
  Model through(scene, base::Comm(MPI_COMM_WORLD)), fresh(scene, base::Comm(MPI_COMM_WORLD));
  State a = initial_state(through)->state;
  const auto step = [](Model& model, const State& from, int n) {
    return advance(model, from, {0.1 * n, 0.1, false})->state;
  };
  for (int n = 1; n <= 4; ++n) a = step(through, a, n);
  State b = restored(archived(a, through.space), fresh.space);
  through.drop_caches();
  for (int n = 5; n <= 8; ++n) {
    a = step(through, a, n);
    b = step(fresh, b, n);
    EXPECT_LE((a.tissue.u.value - b.tissue.u.value).norm(), 1e-9 * a.tissue.u.value.norm());
  }
}

// A block that slides, and one that rests, on a rigid slope; with a needle in it.
TEST(RestartOf, Contact)
{
  for (const double friction : {0.0, 0.2, 0.9}) {
    SCOPED_TRACE(friction);
    Scene scene = into_block(false);
    scene.tissue.model = tissue::Model::corotational;
    scene.tissue.boundary.fixed.clear();
    scene.tissue.boundary.gravity = Vec3(3.0, 0, -9.0);
    scene.needles[0].motion.velocity = 0.01;
    scene.contact.obstacles = {{"floor"}};
    scene.contact.pairs = {{"floor", "z0", "floor", friction}};
    std::vector<double> lengths = uneven;
    for (double& h : lengths) h *= 0.1;
    expect_equal_from(scene, lengths, 4);
  }
}

// An obstacle that moves, begins inside the block and comes loose again; both time schemes, of
// which BDF2 repeats the steps where corners meet or part.
TEST(RestartOf, ContactWithAMovingObstacle)
{
  for (const bool second_order : {false, true}) {
    SCOPED_TRACE(second_order);
    Scene scene = into_block(false);
    scene.needles[0].motion.velocity = 0.01;
    scene.time.second_order = second_order;
    scene.energy = true;
    contact::Obstacle plate{"plate"};
    plate.normal = Vec3(0, 0, -1);
    plate.origin = Vec3(0, 0, 0.0397);
    plate.path = core::Csv{
        "path", {"time", "x", "y", "z"}, {{0, 0, 0, 0}, {0.4, 1e-4, 0, -5e-4}, {0.6, 0, 0, 1e-3}}};
    scene.contact.obstacles = {plate};
    scene.contact.pairs = {{"plate", "z1", "plate", 0.3}};
    expect_equal_from(scene, uneven, 4);
    const test::Run run = test::run(scene, uneven);
    EXPECT_FALSE(run.states[4].contact.pairs[0].overlapped.empty());
    EXPECT_FALSE(run.states[4].contact.pairs[0].touches.empty());
    EXPECT_TRUE(run.states.back().contact.pairs[0].touches.empty());
    EXPECT_EQ(run.ledger.repeated_steps > 0, second_order);
  }
}

// Bodies that contact alone holds, in quasi-static steps.
TEST(RestartOf, StaticsOfABodyOnAMovingFloor)
{
  for (const auto model : {tissue::Model::linear, tissue::Model::corotational}) {
    Scene scene;
    scene.mesh = test::block({3, 3, 2, Vec3(0.03, 0.03, 0.02)});
    scene.tissue.model = model;
    scene.tissue.materials = {{5000.0, 0.3, 1000.0, 0.0, 0.0}};
    scene.tissue.boundary.gravity = Vec3(1.0, 0, -9.0);
    contact::Obstacle floor{"floor"};
    floor.path = core::Csv{"path", {"time", "x", "y", "z"}, {{0, 0, 0, 0}, {1, 1e-3, 0, 2e-3}}};
    scene.contact.obstacles = {floor};
    scene.contact.pairs = {{"floor", "z0", "floor", 0.5}};
    scene.time.is_static = true;
    expect_equal_from(scene, uneven, 4);
  }
}

// Cavities of every model beside a needle, in linear tissue, which every model can be in.
TEST(RestartOf, EveryModelOfCavity)
{
  for (const auto model : {cavity::Model::follower, cavity::Model::linear, cavity::Model::frozen}) {
    Scene scene = test::cavity_scenario(4, 2, model);
    test::press(scene, 0.0005);
    test::add_needle(scene, 0.0061);
    expect_equal_from(scene, uneven, 4);
  }
}

}  // namespace
}  // namespace trocar::step
