#include "driver/recorder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/hdf5.hpp"
#include "support/scene.hpp"

namespace trocar::driver {
namespace {

using core::Vec3;
namespace fs = std::filesystem;

/// A small block with a needle in it already, ready to be stepped, and its results.
struct Recorded
{
  explicit Recorded(const std::string& folder, const OutputSettings& output = {},
                    bool energy = false)
      : comm(MPI_COMM_WORLD), scenario(scene(folder, output, energy)), simulation(scenario, comm)
  {
    std::error_code nothing_there;
    if (comm.root()) fs::remove_all(folder, nothing_there);
    step::prepare(simulation);
  }
  static Scenario scene(const std::string& folder, const OutputSettings& output, bool energy)
  {
    Scenario scenario{test::needle_scenario({3, 2, 2, Vec3(0.06, 0.04, 0.04), 0.1})};
    scenario.output = output;
    scenario.energy = energy;
    scenario.output.folder = folder;
    scenario.tissue.boundary.displacements = {{"z1", Vec3(0, 0, 0.001), std::nullopt, {}}};
    scenario.needles[0].motion.inserted = 0.03;
    return scenario;
  }

  base::Comm comm;
  Scenario scenario;
  step::Model simulation;
};

/// Two steps from the start, with fields after every other one.
void run_two_steps(Recorded& one, Recorder& recorder)
{
  step::Outcome<step::Accepted> result = step::initial_state(one.simulation);
  for (int n = 0; n <= 2; ++n) {
    if (n > 0) result = step::advance(one.simulation, result->state, {0.02 * n, 0.02, false});
    ASSERT_TRUE(result) << result.why();
    recorder.record(result->state, result->report, n, 0.5, n % 2 == 0);
  }
  recorder.close();
}

TEST(Recorder, WritesARowOfEveryHistoryInEveryStep)
{
  Recorded one("recorder_history");
  Recorder recorder(one.simulation, one.scenario, {{"trocar", "-check"}, "", "", {}, {}},
                    {{"time_step", "0.02", "s", "command line"}});
  run_two_steps(one, recorder);
  base::on_root(one.comm, [&] {
    const test::H5Reader run("recorder_history/run.h5");
    const std::vector<double> time = run.dataset("/history/time").values;
    ASSERT_EQ(time.size(), 3U);
    EXPECT_EQ(time[2], 0.04);
    for (const char* name :
         {"depth", "travel", "punctures", "points", "slipping", "shaft_friction"})
      EXPECT_EQ(run.dataset(std::string("/history/needle/needle/") + name).shape[0], 3U) << name;
    const test::Dataset tip = run.dataset("/history/needle/needle/tip");
    EXPECT_EQ(tip.shape, (std::vector<std::size_t>{3, 3}));
    EXPECT_NEAR(tip.values[0], 0.03, 1e-12);
    EXPECT_NEAR(tip.values[6], 0.03 + 0.02 * 0.04, 1e-12);  // at its velocity
    EXPECT_NEAR(run.dataset("/history/needle/needle/travel").values[2], 0.02 * 0.04, 1e-15);
    EXPECT_EQ(run.dataset("/history/boundary/z1/force").units, "N");
    const test::Dataset support = run.dataset("/history/fix/z0/force");
    EXPECT_EQ(support.shape, (std::vector<std::size_t>{3, 3}));
    EXPECT_EQ(support.units, "N");
    EXPECT_LT(support.values[8], 0.0);  // the tissue is pulled upwards
    EXPECT_EQ(run.dataset("/history/step_seconds").values.back(), 0.5);
    EXPECT_GT(run.dataset("/history/constraint/rows").values.back(), 3.0);
    EXPECT_GT(
        run.count_attribute("/ledger", "solves") + run.count_attribute("/ledger", "half_sweeps"),
        0);
    EXPECT_EQ(run.words("/provenance/command_line").front(), "trocar -check");
    EXPECT_EQ(run.words("/provenance/options/value").front(), "0.02");
    EXPECT_EQ(run.words("/provenance/mpi_ranks").front(), std::to_string(one.comm.size()));
    EXPECT_FALSE(run.has("/history/energy"));
  });
}

// Displacements come out node by node as they are, whichever rank owns the nodes.
TEST(Recorder, WritesTheFieldsThatAreAskedFor)
{
  OutputSettings output;
  output.velocity = true;
  Recorded one("recorder_fields", output, true);
  Recorder recorder(one.simulation, one.scenario, {}, {});
  step::Outcome<step::Accepted> result = step::initial_state(one.simulation);
  result = step::advance(one.simulation, result->state, {0.02, 0.02, false});
  ASSERT_TRUE(result) << result.why();
  recorder.record(result->state, result->report, 7, 0.0, true);
  recorder.close();
  const fem::GlobalField u = one.simulation.space.gather(result->state.tissue.u);
  const auto& points = result->state.insertions[0].points;
  EXPECT_GT(points.size(), 1U);
  base::on_root(one.comm, [&] {
    const test::H5Reader step("recorder_fields/fields/step_000007.h5");
    const test::Dataset field = step.dataset("/displacement");
    EXPECT_EQ(field.values, std::vector<double>(u.value.data(), u.value.data() + u.value.size()));
    EXPECT_EQ(step.dataset("/velocity").units, "m/s");
    EXPECT_FALSE(step.has("/von_mises"));
    EXPECT_EQ(step.dataset("/coupling/id").values.size(), points.size());
    EXPECT_EQ(step.dataset("/coupling/lambda").shape, (std::vector<std::size_t>{points.size(), 3}));
    EXPECT_EQ(step.dataset("/needle/needle/axis").shape[0], 13U);  // nodes of 12 elements
    EXPECT_EQ(step.dataset("/needle/needle/radius").values, (std::vector<double>(13, 0.0005)));
    EXPECT_EQ(test::H5Reader("recorder_fields/run.h5").dataset("/history/energy/rest").shape[0],
              1U);
  });
}

TEST(Recorder, MakesNoFieldFileWhenNoneIsAskedFor)
{
  OutputSettings output;
  output.displacement = false;
  Recorded one("recorder_none", output);
  Recorder recorder(one.simulation, one.scenario, {}, {});
  run_two_steps(one, recorder);
  base::on_root(one.comm, [] {
    EXPECT_TRUE(fs::is_empty("recorder_none/fields"));
    EXPECT_FALSE(fs::exists("recorder_none/run.xdmf"));
  });
}

TEST(Recorder, FieldsComeWhenTheyAreDue)
{
  Recorded one("recorder_due");
  Recorder recorder(one.simulation, one.scenario, {}, {});
  run_two_steps(one, recorder);
  base::on_root(one.comm, [] {
    EXPECT_TRUE(fs::exists("recorder_due/fields/step_000000.h5"));
    EXPECT_FALSE(fs::exists("recorder_due/fields/step_000001.h5"));
    EXPECT_TRUE(fs::exists("recorder_due/fields/step_000002.h5"));
  });
}

TEST(Recorder, AFolderThatCannotBeMadeIsRefusedOnEveryRank)
{
  Recorded one("recorder_file/below");
  base::on_root(one.comm, [] { std::ofstream("recorder_file") << "in the way"; });
  try {
    const Recorder recorder(one.simulation, one.scenario, {}, {});
    ADD_FAILURE() << "made a folder below a file";
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::output);
    EXPECT_NE(std::string(failure.what()).find("recorder_file"), std::string::npos);
  }
}

}  // namespace
}  // namespace trocar::driver
