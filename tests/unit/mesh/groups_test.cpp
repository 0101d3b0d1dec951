#include <gtest/gtest.h>

#include <functional>

#include "core/failure.hpp"
#include "mesh/hollow.hpp"
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

// Supports and loads take surfaces: one that names a volume is told which there are.
TEST(Groups, AVolumeInTheirPlaceIsAnsweredWithAllOfThem)
{
  mesh::Mesh mesh = test::block({});
  mesh.points.push_back({"pin", {0}, {}});
  const auto line = [&](const std::function<void()>& look) -> std::string {
    try {
      look();
    } catch (const core::Failure& failure) {
      EXPECT_EQ(failure.code(), core::ExitCode::data);
      return failure.what();
    }
    return "nothing failed";
  };
  const std::string surface = line([&] { mesh::surface_group(mesh, "beam"); });
  const std::string any = line([&] { mesh::group_nodes(mesh, "beam"); });
  for (const std::string& text : {surface, any}) {
    EXPECT_NE(text.find("'beam' is a volume"), std::string::npos) << text;
    for (const mesh::SurfaceGroup& group : mesh.surfaces)
      EXPECT_NE(text.find(group.name), std::string::npos) << text;
  }
  EXPECT_EQ(surface.find("pin"), std::string::npos) << surface;
  EXPECT_NE(any.find("pin"), std::string::npos) << any;
  mesh.surfaces.clear();
  EXPECT_NE(line([&] { mesh::surface_group(mesh, "beam"); }).find("there is none"),
            std::string::npos);
}

// What is left of a mesh without one of its volumes is in the same unit, from the same file, and
// has the same remarks.
TEST(Hollow, KeepsWhatTheMeshIs)
{
  mesh::Mesh mesh = test::block({2, 2, 2, core::Vec3(0.2, 0.2, 0.2)});
  mesh.file = "a.msh";
  mesh.hash = "00ff";
  mesh.unit = 1e-3;
  mesh.remarks = {"a remark"};
  mesh.volumes = {"tissue", "fluid"};
  for (std::size_t t = 0; t < mesh.region.size(); t += 2) mesh.region[t] = 1;
  const mesh::Mesh rest = mesh::hollow(mesh, "fluid");
  EXPECT_EQ(rest.tet_count(), mesh.tet_count() / 2);
  EXPECT_EQ(rest.file, mesh.file);
  EXPECT_EQ(rest.hash, mesh.hash);
  EXPECT_EQ(rest.unit, mesh.unit);
  EXPECT_EQ(rest.remarks, mesh.remarks);
}

}  // namespace
}  // namespace trocar
