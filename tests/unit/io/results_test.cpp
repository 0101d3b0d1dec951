#include "io/results.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "results_support.hpp"
#include "support/body.hpp"
#include "support/files.hpp"
#include "support/hdf5.hpp"

namespace trocar::io {
namespace {

TEST(Results, HoldTheMeshInTheOrderOfItsFile)
{
  mesh::Mesh mesh = test::block({2, 2, 1, core::Vec3(0.2, 0.2, 0.1), 0.2});
  mesh.volumes = {"skin", "fat"};
  for (std::size_t t = 0; t < mesh.region.size(); t += 3) mesh.region[t] = 1;
  with_results("results_mesh", mesh, [&](Results&) {});
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    const test::H5Reader run("results_mesh/run.h5");
    EXPECT_EQ(run.dataset("/mesh/coordinates").values, as_numbers(mesh.x));
    EXPECT_EQ(run.dataset("/mesh/coordinates").units, "m");
    const test::Dataset tets = run.dataset("/mesh/tets");
    EXPECT_EQ(tets.shape, (std::vector<std::size_t>{mesh.tets.size(), 4}));
    EXPECT_TRUE(tets.integer);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (std::size_t a = 0; a < 4; ++a) EXPECT_EQ(tets.values[4 * t + a], mesh.tets[t][a]);
    const std::vector<double> region = run.dataset("/mesh/region").values;
    EXPECT_EQ(std::vector<int>(region.begin(), region.end()), mesh.region);
    EXPECT_EQ(run.words("/mesh/volumes"), mesh.volumes);
    EXPECT_EQ(run.dataset("/mesh/node_tag").values.back(), mesh.node_count());
    EXPECT_EQ(run.words("/provenance/program").front(), "a test");
    EXPECT_EQ(run.words("/provenance/options/name"), (std::vector<std::string>{"b", "a"}));
    EXPECT_EQ(run.text_attribute("/", "schema"), "trocar-1");
  });
}

TEST(Results, OfAQuadraticMeshHaveTenNodesPerTet)
{
  test::BlockShape shape{1, 1, 1};
  shape.quadratic = true;
  const mesh::Mesh mesh = test::block(shape);
  with_results("results_quadratic", mesh,
               [&](Results& results) { results.write_fields(0, 0.0, {}, {}, {}); });
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    const test::Dataset tets = test::H5Reader("results_quadratic/run.h5").dataset("/mesh/tets");
    EXPECT_EQ(tets.shape, (std::vector<std::size_t>{6, 10}));
    EXPECT_EQ(tets.values[4], mesh.middle_of(mesh.tets[0][0], mesh.tets[0][1]));
    EXPECT_NE(test::file_text("results_quadratic/run.xdmf").find("Tetrahedron_10"),
              std::string::npos);
  });
}

TEST(Results, HistoriesGrowByARowOfEverySeriesWithTheWorkDone)
{
  with_results("results_history", test::block({1, 1, 1}), [](Results& results) {
    core::Ledger ledger;
    for (int n = 0; n < 3; ++n) {
      ledger.solves = 10 * n;
      results.append_history({{0.1 * n}, {1.0 * n, 2.0, -1.0 * n}}, ledger);
    }
    results.write_table("/tables/sizes", {3.0, 1.0}, "m");
  });
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    const test::H5Reader run("results_history/run.h5");
    EXPECT_EQ(run.dataset("/history/time").values, (std::vector<double>{0.0, 0.1, 0.2}));
    const test::Dataset tip = run.dataset("/history/needle/tip");
    EXPECT_EQ(tip.shape, (std::vector<std::size_t>{3, 3}));
    EXPECT_EQ(tip.values, (std::vector<double>{0, 2, 0, 1, 2, -1, 2, 2, -2}));
    EXPECT_EQ(run.count_attribute("/ledger", "solves"), 20);
    EXPECT_EQ(run.count_attribute("/ledger", "steps"), 0);
    EXPECT_EQ(run.dataset("/tables/sizes").values, (std::vector<double>{3.0, 1.0}));
  });
}

// More rows than there is room for: the file is made anew with all it held.
TEST(Results, HistoriesOutgrowTheirRoom)
{
  const mesh::Mesh mesh = test::block({1, 1, 1});
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    std::vector<double> times;
    {
      fs::remove_all("results_room");
      Results results("results_room", mesh, {{{"program", "a test"}}, {}},
                      {{"time", 0, "s"}, {"tip", 3, "m"}}, 3);
      results.write_table("/before", {7.0}, "1");
      core::Ledger ledger;
      for (int n = 0; n < 50; ++n) {
        times.push_back(0.25 * n);
        ledger.solves = n;
        results.append_history({{times.back()}, {1.0 * n, 0.0, -1.0 * n}}, ledger);
        if (n != 2 && n != 3 && n != 20) continue;
        // As a reader finds it in mid-run.
        const test::H5Reader run("results_room/run.h5");
        EXPECT_EQ(run.dataset("/history/time").values, times);
        EXPECT_EQ(run.dataset("/history/tip").values.back(), -1.0 * n);
        EXPECT_EQ(run.count_attribute("/ledger", "solves"), n);
      }
      results.write_table("/after", {8.0}, "1");
      results.close();
    }
    const test::H5Reader run("results_room/run.h5");
    EXPECT_EQ(run.dataset("/history/time").values, times);
    EXPECT_EQ(run.dataset("/before").values, std::vector<double>{7.0});
    EXPECT_EQ(run.dataset("/after").values, std::vector<double>{8.0});
    EXPECT_EQ(run.words("/provenance/program").front(), "a test");
    EXPECT_EQ(run.dataset("/mesh/coordinates").values, as_numbers(mesh.x));
    EXPECT_EQ(run.text_attribute("/", "schema"), "trocar-1");
    EXPECT_EQ(files_of("results_room"), (std::vector<std::string>{"fields", "run.h5"}));
  });
}

TEST(Results, BelongToOneRunAtATime)
{
  const mesh::Mesh mesh = test::block({1, 1, 1});
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    fs::remove_all("results_lock");
    {
      Results first("results_lock", mesh, {}, {{"time", 0, "s"}});
      first.append_history({{1.0}}, {});
      first.write_fields(0, 0.0, {}, {}, {});
      EXPECT_TRUE(first.remarks().empty());
      EXPECT_THROW(Results("results_lock", mesh, {}, {}), core::Failure);
      EXPECT_EQ(files_of("results_lock"),
                (std::vector<std::string>{"fields", "run.h5", "run.lock", "run.xdmf"}));
      EXPECT_EQ(test::H5Reader("results_lock/run.h5").dataset("/history/time").values,
                std::vector<double>{1.0});
    }
    EXPECT_FALSE(fs::exists("results_lock/run.lock"));
    std::ofstream("results_lock/run.lock") << "host elsewhere\nprocess 7\nsince then\n";
    EXPECT_THROW(Results("results_lock", mesh, {}, {}), core::Failure);
    EXPECT_TRUE(fs::exists("results_lock/fields/step_000000.h5"));
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    std::ofstream("results_lock/run.lock") << "host " << name << "\nprocess 7\nsince then\n";
    Results second("results_lock", mesh, {}, {});
    ASSERT_EQ(second.remarks().size(), 1U);
    EXPECT_NE(second.remarks()[0].find("taken over (host"), std::string::npos);
    EXPECT_FALSE(fs::exists("results_lock/fields/step_000000.h5"));
  });
}

// Links are not followed, and what is not ours stays.
TEST(Results, TouchNothingThatIsNotTheirs)
{
  const mesh::Mesh mesh = test::block({1, 1, 1});
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    fs::remove_all("results_links");
    fs::remove_all("results_victim");
    fs::create_directories("results_victim/fields");
    fs::create_directories("results_links/fields");
    std::ofstream("results_victim/a") << "secret";
    std::ofstream("results_victim/fields/step_000001.h5") << "theirs";
    const auto expect_refused = [&](const std::string& name) {
      EXPECT_THROW(Results("results_links", mesh, {}, {}), core::Failure) << name;
      EXPECT_EQ(test::file_text("results_victim/a"), "secret");
      EXPECT_EQ(test::file_text("results_victim/fields/step_000001.h5"), "theirs");
      fs::remove_all("results_links/" + name);
    };
    for (const char* name : {"run.h5", "run.xdmf", "run.lock"}) {
      fs::create_symlink("../results_victim/a", std::string("results_links/") + name);
      expect_refused(name);
      std::ofstream(std::string("results_links/") + name) << "a diary";
      expect_refused(name);
    }
    fs::remove_all("results_links/fields");
    fs::create_symlink("../results_victim/fields", "results_links/fields");
    expect_refused("fields");
    fs::create_directory("results_links/fields");
    for (const char* name : {"step_by_step.txt", "step_1.h5", "step_000001.h5.bak", "mine.h5"})
      std::ofstream(std::string("results_links/fields/") + name) << "mine";
    fs::create_symlink("../../results_victim/a", "results_links/fields/step_000002.h5");
    std::ofstream("results_links/fields/step_000003.h5") << "of an earlier run";
    std::ofstream("results_links/.trocar-abcdef") << "half of one";
    Results results("results_links", mesh, {}, {});
    EXPECT_EQ(files_of("results_links/fields"),
              (std::vector<std::string>{"mine.h5", "step_000001.h5.bak", "step_000002.h5",
                                        "step_1.h5", "step_by_step.txt"}));
    EXPECT_FALSE(fs::exists("results_links/.trocar-abcdef"));
    results.write_fields(2, 0.0, {}, {}, {});  // replaces the link, not what it points at
    EXPECT_EQ(test::file_text("results_victim/a"), "secret");
    EXPECT_THROW(Results("", mesh, {}, {}), core::Failure);
  });
}

// A run that cannot begin leaves the last one's results as they are.
TEST(Results, OfAnEarlierRunStayUntilTheNewOnesAreThere)
{
  const mesh::Mesh mesh = test::block({1, 1, 1});
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    fs::remove_all("results_full");
    {
      Results results("results_full", mesh, {}, {{"time", 0, "s"}});
      results.append_history({{1.0}}, {});
      results.write_fields(0, 0.0, {}, {}, {});
    }
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{1000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(Results("results_full", mesh, {}, {{"time", 0, "s"}}), core::Failure);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(files_of("results_full"), (std::vector<std::string>{"fields", "run.h5", "run.xdmf"}));
    EXPECT_EQ(files_of("results_full/fields"), std::vector<std::string>{"step_000000.h5"});
    EXPECT_EQ(test::H5Reader("results_full/run.h5").dataset("/history/time").values,
              std::vector<double>{1.0});
  });
}

/// Rank 0's failure to write, thrown on every rank, has the exit code 74.
void expect_output_failure(const std::function<void()>& work)
{
  try {
    base::on_root(base::Comm(MPI_COMM_WORLD), work);
    ADD_FAILURE() << "nothing failed";
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::output) << failure.what();
  }
}

TEST(Results, ThatCannotBeWrittenAreRefused)
{
  const mesh::Mesh mesh = test::block({1, 1, 1});
  expect_output_failure([&] {
    std::ofstream("a_file") << "in the way";
    Results("a_file/below", mesh, {}, {});
  });
  expect_output_failure([] { base::replace_file("no_such_folder/text", "words"); });
}

}  // namespace
}  // namespace trocar::io
