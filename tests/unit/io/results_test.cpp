#include "io/results.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "support/body.hpp"
#include "support/files.hpp"
#include "support/hdf5.hpp"

namespace trocar::io {
namespace {

namespace fs = std::filesystem;

/// Runs on rank 0 alone, where results live, with the folder gone before.
void with_results(const std::string& folder, const mesh::Mesh& mesh,
                  const std::function<void(Results&)>& work)
{
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    fs::remove_all(folder);
    Results results(folder, mesh, {{{"program", "a test"}}, {{"options/name", {"b", "a"}}}},
                    {{"time", 0, "s"}, {"needle/tip", 3, "m"}});
    work(results);
    results.close();
  });
}

std::vector<std::string> files_of(const std::string& folder)
{
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<double> as_numbers(const std::vector<core::Vec3>& points)
{
  std::vector<double> numbers;
  for (const core::Vec3& x : points) numbers.insert(numbers.end(), x.data(), x.data() + 3);
  return numbers;
}

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

/// How often a text stands in another.
int count(const std::string& text, const std::string& piece)
{
  int found = 0;
  for (auto at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1)) ++found;
  return found;
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
      EXPECT_TRUE(first.remark().empty());
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
    EXPECT_NE(second.remark().find("taken over (host"), std::string::npos) << second.remark();
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

TEST(Results, ShowFramesAtACostThatGrowsWithThem)
{
  const mesh::Mesh mesh = test::block({1, 1, 1});
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    fs::remove_all("results_frames");
    Results results("results_frames", mesh, {}, {});
    int behind = 0;
    for (int n = 0; n < 300; ++n) {
      results.write_fields(n, 1.0 * n, {}, {}, {});
      const int shown = count(test::file_text("results_frames/run.xdmf"), "<Time ");
      if (n < 64) {
        EXPECT_EQ(shown, n + 1);
      }
      EXPECT_GE(9 * shown, 8 * (n + 1));
      behind += shown == n + 1 ? 0 : 1;
    }
    EXPECT_GT(behind, 200);
    results.close();
    EXPECT_EQ(count(test::file_text("results_frames/run.xdmf"), "<Time "), 300);
  });
}

// A field that several ranks own comes out as the mesh has its nodes.
TEST(Results, FieldsAreInTheOrderOfTheMesh)
{
  const test::Body body({4, 3, 2, core::Vec3(0.4, 0.3, 0.2), 0.2});
  const fem::GlobalField X =
      body.space.gather(test::nodal(body, [](const core::Vec3& x) { return x; }));
  const std::vector<double> values(X.value.data(), X.value.data() + X.value.size());
  with_results("results_fields", body.mesh, [&](Results& results) {
    results.write_fields(3, 0.25,
                         {{"/displacement", 3, "m", values, true, false, false},
                          {"/von_mises", 0, "Pa", std::vector<double>(body.mesh.tets.size(), 2.0),
                           false, false, true},
                          {"/coupling/id", 0, "1", {1e6, 7.0}, false, true, false}},
                         {}, {"lambda_nonunique"});
  });
  base::on_root(body.comm, [&] {
    const test::H5Reader step("results_fields/fields/step_000003.h5");
    EXPECT_EQ(step.dataset("/displacement").values, as_numbers(body.mesh.x));
    EXPECT_EQ(step.dataset("/time").values, (std::vector<double>{0.25}));
    EXPECT_TRUE(step.dataset("/coupling/id").integer);
    EXPECT_EQ(step.count_attribute("/", "lambda_nonunique"), 1);
    EXPECT_EQ(files_of("results_fields/fields"), std::vector<std::string>{"step_000003.h5"});
    const std::string shown = test::file_text("results_fields/run.xdmf");
    EXPECT_NE(shown.find("fields/step_000003.h5:/displacement"), std::string::npos);
    EXPECT_NE(shown.find("fields/step_000003.h5:/von_mises"), std::string::npos);
    EXPECT_EQ(shown.find("/coupling/id"), std::string::npos);  // neither of nodes nor of tets
    EXPECT_NE(shown.find("<Time Value=\"0.25\"/>"), std::string::npos);
  });
}

// A curve is a collection of its own beside the tissue, at the same times.
TEST(Results, ShowCurvesBesideTheTissue)
{
  with_results("results_curves", test::block({1, 1, 1}), [](Results& results) {
    for (int n : {0, 4})
      results.write_fields(n, 0.5 * n, {},
                           {{"/needle/left", {0, 0, 0, 0.1 * n, 0, 0, 1, 0, 0}, 0.002},
                            {"/needle/right", {0, 1, 0, 1, 1, 0}, 0.001}},
                           {});
  });
  base::on_root(base::Comm(MPI_COMM_WORLD), [] {
    const test::H5Reader step("results_curves/fields/step_000004.h5");
    const test::Dataset axis = step.dataset("/needle/left/axis");
    EXPECT_EQ(axis.shape, (std::vector<std::size_t>{3, 3}));
    EXPECT_EQ(axis.values[3], 0.4);
    EXPECT_EQ(axis.units, "m");
    EXPECT_EQ(step.dataset("/needle/left/radius").values, (std::vector<double>(3, 0.002)));
    const std::string shown = test::file_text("results_curves/run.xdmf");
    for (const char* name : {"tissue", "needle_left", "needle_right"})
      EXPECT_EQ(count(shown, std::string("<Grid Name=\"") + name + "\" GridType=\"Collection\""), 1)
          << name;
    EXPECT_EQ(count(shown, "<Time Value=\"2\"/>"), 3);
    EXPECT_EQ(count(shown, "\"Polyline\" NodesPerElement=\"3\" NumberOfElements=\"1\""), 2);
    EXPECT_EQ(count(shown, "fields/step_000004.h5:/needle/left/axis"), 1);
    EXPECT_EQ(count(shown, "fields/step_000000.h5:/needle/right/radius"), 1);
    EXPECT_EQ(count(shown, ">0 1 2</DataItem>"), 2);
  });
}

TEST(Results, DoNotMixWithFieldsOfAnEarlierRun)
{
  const mesh::Mesh mesh = test::block({1, 1, 1});
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    fs::remove_all("results_again");
    for (int last : {2, 0}) {
      Results results("results_again", mesh, {}, {{"time", 0, "s"}});
      for (int step = 0; step <= last; ++step) results.write_fields(step, 0.1 * step, {}, {}, {});
      std::ofstream("results_again/fields/notes.txt") << "of the user";
    }
    EXPECT_TRUE(fs::exists("results_again/fields/step_000000.h5"));
    EXPECT_FALSE(fs::exists("results_again/fields/step_000002.h5"));
    EXPECT_TRUE(fs::exists("results_again/fields/notes.txt"));
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

TEST(Files, AreReplacedAsAWhole)
{
  base::on_root(base::Comm(MPI_COMM_WORLD), [] {
    fs::create_directories("atomic");
    base::replace_file("atomic/text", "the first, longer one\n");
    base::replace_file("atomic/text", "the second\n");
    EXPECT_EQ(test::file_text("atomic/text"), "the second\n");
    EXPECT_EQ(files_of("atomic"), std::vector<std::string>{"text"});
  });
}

// Not yet: the folder of a bare name is "", which cannot be synced.
TEST(Files, MayLieInTheWorkingFolder)
{
  base::on_root(base::Comm(MPI_COMM_WORLD), [] {
    EXPECT_NO_THROW(base::replace_file("bare_name", "words"));
    EXPECT_EQ(test::file_text("bare_name"), "words");
  });
}

}  // namespace
}  // namespace trocar::io
