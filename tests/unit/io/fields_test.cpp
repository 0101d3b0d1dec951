#include <gtest/gtest.h>

#include <fstream>

#include "results_support.hpp"
#include "support/body.hpp"
#include "support/files.hpp"
#include "support/hdf5.hpp"

// Field files and what ParaView is shown of them.
namespace trocar::io {
namespace {

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

}  // namespace
}  // namespace trocar::io
