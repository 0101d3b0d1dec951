#include <gmsh.h>
#include <gtest/gtest.h>
#include <petscdmplex.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/petsc.hpp"
#include "core/failure.hpp"
#include "io/gmsh_reader.hpp"
#include "mesh/quadratic.hpp"

namespace trocar {
namespace {

using core::Vec3;

/// Two joined boxes of different volumes with named surfaces and a point, written by Gmsh.
std::string write_gmsh(double version, bool binary)
{
  const std::string file =
      "mesh_test_" + std::to_string(static_cast<int>(10 * version)) + (binary ? "b" : "a") + ".msh";
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1, 1);
  gmsh::model::occ::addBox(1, 0, 0, 0.5, 1, 1, 2);
  gmsh::vectorpair out;
  std::vector<gmsh::vectorpair> map;
  gmsh::model::occ::fragment({{3, 1}}, {{3, 2}}, out, map);
  gmsh::model::occ::synchronize();
  gmsh::model::addPhysicalGroup(3, {1}, 11);
  gmsh::model::setPhysicalName(3, 11, "skin");
  gmsh::model::addPhysicalGroup(3, {2}, 7);
  gmsh::model::setPhysicalName(3, 7, "fat");
  gmsh::vectorpair faces;
  gmsh::model::getEntitiesInBoundingBox(-0.01, -0.01, -0.01, 0.01, 1.01, 1.01, faces, 2);
  gmsh::model::addPhysicalGroup(2, {faces[0].second}, 3);
  gmsh::model::setPhysicalName(2, 3, "left side");
  gmsh::model::addPhysicalGroup(0, {1}, 5);
  gmsh::model::setPhysicalName(0, 5, "corner");
  gmsh::option::setNumber("Mesh.CharacteristicLengthMax", 0.3);
  gmsh::option::setNumber("Mesh.MshFileVersion", version);
  gmsh::option::setNumber("Mesh.Binary", binary);
  gmsh::model::mesh::generate(3);
  gmsh::write(file);
  gmsh::finalize();
  return file;
}

/// Made by rank 0, read by all.
std::string shared_file(const base::Comm& comm, double version, bool binary)
{
  std::string file;
  base::on_root(comm, [&] { file = write_gmsh(version, binary); });
  comm.broadcast(file);
  return file;
}

double area(const mesh::Mesh& mesh, const mesh::SurfaceGroup& group)
{
  double sum = 0.0;
  for (const auto& f : group.faces) {
    const Vec3& a = mesh.x[static_cast<std::size_t>(f[0])];
    sum += 0.5 * (mesh.x[static_cast<std::size_t>(f[1])] - a)
                     .cross(mesh.x[static_cast<std::size_t>(f[2])] - a)
                     .norm();
  }
  return sum;
}

TEST(GmshReader, EveryFormatGivesTheSameMesh)
{
  const base::Comm comm(MPI_COMM_WORLD);
  mesh::Mesh first;
  for (const auto& [version, binary] :
       {std::pair{2.2, false}, {2.2, true}, {4.1, false}, {4.1, true}}) {
    const mesh::Mesh mesh = io::read_gmsh(shared_file(comm, version, binary), 1e-2, comm);
    EXPECT_NEAR(mesh::quality(mesh).volume, 1.5e-6, 1e-15);
    EXPECT_EQ(mesh.volumes, (std::vector<std::string>{"fat", "skin"}));
    EXPECT_NEAR(area(mesh, mesh::surface_group(mesh, "left side")), 1e-4, 1e-14);
    EXPECT_EQ(mesh::group_nodes(mesh, "corner").size(), 1U);
    if (first.tets.empty()) first = mesh;
    EXPECT_EQ(mesh.tets, first.tets);
    EXPECT_EQ(mesh.region, first.region);
    EXPECT_EQ(mesh.node_tag, first.node_tag);
    for (int i = 0; i < mesh.node_count(); ++i)
      EXPECT_LT((mesh.x[static_cast<std::size_t>(i)] - first.x[static_cast<std::size_t>(i)]).norm(),
                1e-15);
  }
}

/// A unit cube with one edge along x as physical curve; another has the name of a surface.
std::string write_curves(int order)
{
  const std::string file = "curves_" + std::to_string(order) + ".msh";
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1, 1);
  gmsh::model::occ::synchronize();
  const auto name = [](int dim, const std::vector<double>& high, const std::string& text) {
    gmsh::vectorpair found;
    gmsh::model::getEntitiesInBoundingBox(-0.01, -0.01, -0.01, high[0] + 0.01, high[1] + 0.01,
                                          high[2] + 0.01, found, dim);
    gmsh::model::setPhysicalName(dim, gmsh::model::addPhysicalGroup(dim, {found[0].second}), text);
  };
  name(3, {1, 1, 1}, "cube");
  name(2, {1, 1, 0}, "floor");
  name(1, {1, 0, 0}, "edge");
  name(1, {0, 1, 0}, "floor");
  gmsh::option::setNumber("Mesh.CharacteristicLengthMax", 0.3);
  gmsh::model::mesh::generate(3);
  gmsh::model::mesh::setOrder(order);
  gmsh::write(file);
  gmsh::finalize();
  return file;
}

TEST(GmshReader, CurvesAreGroupsOfPointsWithTheirMiddles)
{
  const base::Comm comm(MPI_COMM_WORLD);
  for (int order : {1, 2}) {
    std::string file;
    base::on_root(comm, [&] { file = write_curves(order); });
    comm.broadcast(file);
    mesh::Mesh mesh = io::read_gmsh(file, 1.0, comm);
    mesh::make_quadratic(mesh);
    const std::vector<int> all = mesh::group_nodes(mesh, "edge");
    std::vector<int> on_line, on_floor;
    for (int i = 0; i < mesh.node_count(); ++i) {
      const Vec3& x = mesh.x[static_cast<std::size_t>(i)];
      if (x.tail<2>().norm() < 1e-12) on_line.push_back(i);
      if (std::abs(x[2]) < 1e-12) on_floor.push_back(i);
    }
    EXPECT_EQ(all, on_line);
    EXPECT_EQ(mesh::group_nodes(mesh, "floor"), on_floor);
    mesh::make_linear(mesh);
    EXPECT_EQ(2 * mesh::group_nodes(mesh, "edge").size(), all.size() + 1);
  }
}

// PETSc's own reader as an independent witness.
TEST(GmshReader, AgreesWithDmplex)
{
  const base::Comm comm(MPI_COMM_WORLD);
  const std::string file = shared_file(comm, 4.1, true);
  const mesh::Mesh mesh = io::read_gmsh(file, 1.0, comm);
  DM dm = nullptr;
  TROCAR_PETSC(DMPlexCreateFromFile(PETSC_COMM_SELF, file.c_str(), "test", PETSC_TRUE, &dm));
  PetscInt begin = 0, end = 0, nodes_begin = 0, nodes_end = 0;
  TROCAR_PETSC(DMPlexGetHeightStratum(dm, 0, &begin, &end));
  TROCAR_PETSC(DMPlexGetDepthStratum(dm, 0, &nodes_begin, &nodes_end));
  EXPECT_EQ(end - begin, mesh.tet_count());
  EXPECT_EQ(nodes_end - nodes_begin, mesh.node_count());
  std::vector<double> theirs, ours;
  for (PetscInt c = begin; c < end; ++c) {
    double volume = 0.0, centroid[3], normal[3];
    TROCAR_PETSC(DMPlexComputeCellGeometryFVM(dm, c, &volume, centroid, normal));
    theirs.push_back(volume);
  }
  for (int t = 0; t < mesh.tet_count(); ++t) ours.push_back(mesh::tet_volume(mesh, t));
  std::sort(theirs.begin(), theirs.end());
  std::sort(ours.begin(), ours.end());
  for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(ours[i], theirs[i], 1e-14);
  TROCAR_PETSC(DMDestroy(&dm));
}

TEST(GmshReader, RefusesWhatCannotBeUsedOnEveryRank)
{
  const base::Comm comm(MPI_COMM_WORLD);
  const auto refuses = [&](const std::string& text, const std::string& words) {
    base::on_root(comm, [&] { std::ofstream("bad_test.msh") << text; });
    try {
      io::read_gmsh("bad_test.msh", 1.0, comm);
      ADD_FAILURE() << "accepted a mesh with " << words;
    } catch (const core::Failure& failure) {
      EXPECT_EQ(failure.code(), core::ExitCode::data);
      EXPECT_NE(std::string(failure.what()).find(words), std::string::npos) << failure.what();
    }
  };
  const auto tet = [](const std::string& apex, const std::string& corners) {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"a\"\n$EndPhysicalNames\n"
           "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 " +
           apex + "\n$EndNodes\n$Elements\n1\n77 4 2 1 1 " + corners + "\n$EndElements\n";
  };
  refuses("", "empty");
  refuses(tet("0 0 1", "1 3 2 4"), "tetrahedron 77 is inverted");
  refuses(tet("1 1 0", "1 2 3 4"), "tetrahedron 77 is flat");
  refuses(tet("0 0 nan", "1 2 3 4"), "bad_test.msh");
  refuses("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "the file has no $Nodes");
  const std::string whole = tet("0 0 1", "1 2 3 4");
  refuses(whole.substr(0, whole.size() - 60), "bad_test.msh");
  EXPECT_THROW(io::read_gmsh("no_such_file.msh", 1.0, comm), core::Failure);
}

}  // namespace
}  // namespace trocar
