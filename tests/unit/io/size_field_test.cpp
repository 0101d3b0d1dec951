#include <gmsh.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "io/size_field.hpp"
#include "support/block.hpp"

namespace trocar::io {
namespace {

// Gmsh reads the edge lengths where they were meant: at the corners of every tet.
TEST(SizeField, IsWhatGmshReads)
{
  mesh::Mesh mesh = test::block({2, 1, 1, core::Vec3(0.2, 0.1, 0.1), 0.0});
  mesh.unit = 1e-3;  // a file in millimetres
  const core::VecX sizes = core::VecX::LinSpaced(mesh.node_count(), 0.01, 0.02);
  base::on_root(base::Comm(MPI_COMM_WORLD), [&] {
    std::filesystem::create_directories("sizes");
    write_size_field("sizes/next.pos", mesh, sizes);
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::merge("sizes/next.pos");
    std::vector<int> views;
    gmsh::view::getTags(views);
    ASSERT_EQ(views.size(), 1U);
    std::vector<std::string> types;
    std::vector<int> counts;
    std::vector<std::vector<double>> data;
    gmsh::view::getListData(views.front(), types, counts, data);
    gmsh::finalize();
    ASSERT_EQ(types, (std::vector<std::string>{"SS"}));
    ASSERT_EQ(counts.front(), mesh.tet_count());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (std::size_t a = 0; a < 4; ++a) {
        const double* tet = &data.front()[16 * t];  // x of four corners, y, z, values
        const int node = mesh.tets[t][a];
        const core::Vec3& x = mesh.x[static_cast<std::size_t>(node)];
        EXPECT_LT((1e-3 * core::Vec3(tet[a], tet[4 + a], tet[8 + a]) - x).norm(), 1e-9);
        EXPECT_NEAR(1e-3 * tet[12 + a], sizes[node], 1e-10);
      }
  });
}

TEST(SizeField, ThatCannotBeWrittenIsKnownBeforeTheRun)
{
  const base::Comm comm(MPI_COMM_WORLD);
  EXPECT_NO_THROW(base::on_root(comm, [] { require_size_field("later.pos"); }));
  base::on_root(comm, [] {
    EXPECT_FALSE(std::filesystem::exists("later.pos"));
    EXPECT_FALSE(std::filesystem::exists("later.pos.tmp"));
  });
  try {
    base::on_root(comm, [] { require_size_field("no_such_folder/later.pos"); });
    ADD_FAILURE() << "a folder that is not there was accepted";
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::output);
    EXPECT_NE(std::string(failure.what()).find("-error_size_field"), std::string::npos);
  }
}

}  // namespace
}  // namespace trocar::io
