#include <gmsh.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/failure.hpp"
#include "gmsh_oracle.hpp"
#include "io/msh_mesh.hpp"
#include "mesh/soundness.hpp"

namespace trocar {
namespace {

/// One rank reads.
class MshFile : public testing::Test
{
 protected:
  void SetUp() override
  {
    if (!base::Comm(MPI_COMM_WORLD).root()) GTEST_SKIP();
  }
};

struct Form
{
  double version;
  bool binary;
  int order;
};

/// A shipped geometry, meshed coarsely.
std::string written(const std::string& name, const Form& form)
{
  const std::string file = name + "_" + std::to_string(static_cast<int>(10 * form.version)) +
                           (form.binary ? "b" : "a") + std::to_string(form.order) + ".msh";
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::open(std::string(TROCAR_MESHES) + "/" + name + ".geo");
  gmsh::option::setNumber("Mesh.MeshSizeFactor", 2.0);
  gmsh::option::setNumber("Mesh.MshFileVersion", form.version);
  gmsh::option::setNumber("Mesh.Binary", form.binary);
  gmsh::model::mesh::generate(3);
  gmsh::model::mesh::setOrder(form.order);
  gmsh::write(file);
  gmsh::finalize();
  return file;
}

void expect_equal(const mesh::Mesh& ours, const mesh::Mesh& theirs)
{
  EXPECT_EQ(ours.node_tag, theirs.node_tag);
  EXPECT_EQ(ours.elem_tag, theirs.elem_tag);
  EXPECT_EQ(ours.tets, theirs.tets);
  EXPECT_EQ(ours.middles, theirs.middles);
  EXPECT_EQ(ours.region, theirs.region);
  EXPECT_EQ(ours.volumes, theirs.volumes);
  EXPECT_TRUE(ours.x == theirs.x);
  ASSERT_EQ(ours.surfaces.size(), theirs.surfaces.size());
  for (std::size_t s = 0; s < ours.surfaces.size(); ++s) {
    EXPECT_EQ(ours.surfaces[s].name, theirs.surfaces[s].name);
    EXPECT_EQ(ours.surfaces[s].faces, theirs.surfaces[s].faces);
  }
}

// To the bit: nodes, tets, volumes, surfaces, in all forms and both orders.
TEST_F(MshFile, ShippedMeshesAreWhatGmshMakesOfThem)
{
  for (const auto& entry : std::filesystem::directory_iterator(TROCAR_MESHES)) {
    if (entry.path().extension() != ".geo") continue;
    const std::string name = entry.path().stem();
    for (const Form& form :
         {Form{2.2, false, 2}, {2.2, true, 1}, {4.1, false, 1}, {4.1, true, 2}}) {
      const std::string file = written(name, form);
      SCOPED_TRACE(file);
      mesh::Mesh ours = io::mesh_of(io::read_msh(file), 1e-3);
      expect_equal(ours, test::read_with_gmsh(file, 1e-3));
      mesh::drop_repeated(ours);
      mesh::judge(ours);
      const bool two = name == "ball_on_block";  // bodies, of which the reader tells
      EXPECT_EQ(ours.remarks, two ? std::vector<std::string>{"the mesh has 2 separate parts"}
                                  : std::vector<std::string>());
    }
  }
}

/// Parts of a small file of two tets, each in its place; a test replaces one of them.
struct Parts
{
  std::string format = "4.1 0 8";
  std::string names = "2\n2 5 \"top\"\n3 1 \"body\"";
  std::string entities = "0 0 1 1\n9 0 0 0 1 1 1 1 5 0\n1 0 0 0 1 1 1 1 1 0";
  std::string nodes = "1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1";
  std::string elements = "2 3 1 3\n2 9 2 1\n1 2 3 5\n3 1 4 2\n2 1 2 3 4\n3 2 3 4 5";

  std::string text() const
  {
    return "$MeshFormat\n" + format + "\n$EndMeshFormat\n$PhysicalNames\n" + names +
           "\n$EndPhysicalNames\n$Entities\n" + entities + "\n$EndEntities\n$Nodes\n" + nodes +
           "\n$EndNodes\n$Elements\n" + elements + "\n$EndElements\n";
  }
};

std::string saved(const std::string& text)
{
  std::ofstream("parts.msh", std::ios::binary) << text;
  return "parts.msh";
}

void expect_refused(const std::string& text, const std::string& words)
{
  try {
    io::mesh_of(io::read_msh(saved(text)), 1.0);
    ADD_FAILURE() << "read: " << words;
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::data);
    const std::string line = failure.what();
    EXPECT_EQ(line.rfind("parts.msh:", 0), 0U) << line;
    EXPECT_NE(line.find(words), std::string::npos) << line;
    for (char c : line) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << line;
  }
}

TEST_F(MshFile, SmallFileIsRead)
{
  const mesh::Mesh mesh = io::mesh_of(io::read_msh(saved(Parts().text())), 2.0);
  EXPECT_EQ(mesh.tets, (std::vector<mesh::Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(mesh.x[4], core::Vec3(2, 2, 2));
  EXPECT_EQ(mesh.volumes, std::vector<std::string>{"body"});
  EXPECT_EQ(mesh.surfaces.at(0).faces, (std::vector<mesh::Face>{{1, 2, 4}}));
}

// Spaces, line ends of other systems, signs and sections of others are nothing to stumble over.
TEST_F(MshFile, OtherWritingIsRead)
{
  Parts parts;
  parts.nodes = "1 5 1 5 3 1 0 5 1 2 3 4 5\t+0 0e-400 0. 1 0 0\r\n0 1 0 0 0 1 1 1 1";
  std::string text = parts.text();
  text += "$NodeData\n1\n\"$End\"\n$EndNodeDatum\n$EndNodeData\n\n \n";
  EXPECT_EQ(io::mesh_of(io::read_msh(saved(text)), 1.0).tets.size(), 2U);
  std::string crlf;
  for (char c : Parts().text()) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(io::mesh_of(io::read_msh(saved(crlf)), 1.0).tets.size(), 2U);
}

TEST_F(MshFile, LargeTagsAreRead)
{
  Parts parts;
  parts.nodes =
      "1 5 1 5\n3 1 0 5\n3000000001\n3000000002\n3\n9000000000000000000\n5\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1";
  parts.elements = "1 1 1 1\n3 1 4 1\n5000000000 3000000001 3000000002 3 9000000000000000000";
  const mesh::Mesh mesh = io::mesh_of(io::read_msh(saved(parts.text())), 1.0);
  EXPECT_EQ(mesh.node_tag,
            (std::vector<long long>{3, 3000000001, 3000000002, 9000000000000000000}));
  EXPECT_EQ(mesh.elem_tag, std::vector<long long>{5000000000});
}

TEST_F(MshFile, DamageIsNamedWithItsLine)
{
  const auto with = [](std::string Parts::*part, const std::string& text) {
    Parts parts;
    parts.*part = text;
    return parts.text();
  };
  expect_refused("Point(1) = {0, 0, 0};\nSystemCall \"touch x\";\n", ":1: 'Point(1)'");
  expect_refused("$Nodes\n0\n$EndNodes\n", "does not begin with $MeshFormat");
  expect_refused(with(&Parts::format, "4 0 8"), "MSH version '4'");
  expect_refused(with(&Parts::format, "4.1 0 4"), "numbers of 4 bytes");
  expect_refused(with(&Parts::format, "4.1 7 8"), "file type 7");
  expect_refused(with(&Parts::names, "1\n3 1 body"), ":6, in $PhysicalNames");
  expect_refused(with(&Parts::names, "2\n3 1 \"a\"\n3 1 \"b\""), "two names, 'a' and 'b'");
  expect_refused(with(&Parts::names, "1\n7 1 \"a\""), "dimension 7");
  expect_refused(with(&Parts::names, "-1"), "-1 of them are announced");
  expect_refused(with(&Parts::entities, "0 0 0 1\n1 0 0 0 1 1 x"), "'x' is no number");
  expect_refused(with(&Parts::nodes, "1 2 1 2\n3 1 0 2\n1\n1\n0 0 0\n1 0 0"),
                 "node 1 is there twice");
  expect_refused(with(&Parts::nodes, "1 1 1 1\n3 1 0 1\n0\n0 0 0"), "tags are positive");
  expect_refused(with(&Parts::nodes, "1 1 1 1\n3 1 0 1\n1\n0 0 nan"), "not finite");
  expect_refused(with(&Parts::nodes, "1 1 1 1\n3 1 0 1\n1\n0 0 1e999"), "too large");
  expect_refused(with(&Parts::nodes, "1 2 1 2\n3 1 0 1\n1\n0 0 0"), "its blocks have 1");
  expect_refused(with(&Parts::nodes, "1 99999999999999 1 2\n3 1 0 1\n1\n0 0 0"), "announced");
  expect_refused(with(&Parts::nodes, "1 1 1 1\n4 1 0 1\n1\n0 0 0"), "dimension 4");
  expect_refused(with(&Parts::nodes, "1 1 1 1\n3 1 2 1\n1\n0 0 0"), "parametric 2");
  expect_refused(with(&Parts::elements, "1 1 1 1\n3 1 4 1\n1 1 2 3 44"), "node 44");
  expect_refused(with(&Parts::elements, "1 1 1 1\n3 1 77 1\n1 1 2 3 4"), "type 77");
  expect_refused(with(&Parts::elements, "1 1 1 1\n2 9 4 1\n1 1 2 3 4"), "dimension 2");
  expect_refused(with(&Parts::elements, "1 1 1 1\n3 8 4 1\n1 1 2 3 4"), "entity 8");
  expect_refused(with(&Parts::elements, "1 1 1 1\n3 1 4 1\n1.5 1 2 3 4"), "'1.5' is no integer");
  expect_refused(with(&Parts::elements, "1 1 1 1\n3 1 5 1\n1 1 2 3 4 5 1 2 3"), "type 5");
  expect_refused(with(&Parts::elements, "1 2 1 1\n3 1 4 2\n1 1 2 3 4\n1 2 3 4 5"),
                 "two tetrahedra have the tag 1");
  expect_refused(with(&Parts::elements, "1 1 1 1\n3 1 4 1\n1 1 2 3 \x1b[31m"), "'\\x1b[31m'");
  const std::string whole = Parts().text();
  for (std::size_t end = 1; end + 13 < whole.size(); ++end) {
    SCOPED_TRACE(end);
    expect_refused(whole.substr(0, end), "parts.msh");
  }
  expect_refused(whole + "garbage", "'garbage'");
  expect_refused(whole + "$Nodes\n" + Parts().nodes + "\n$EndNodes\n", "twice");
  expect_refused(whole + "$PartitionedEntities\n$EndPartitionedEntities\n", "partitioned");
}

TEST_F(MshFile, OfVersionTwoIsReadWithItsGroupsAndRefusedInPartitions)
{
  const auto file = [](const std::string& elements) {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
           "4 0 0 1\n$EndNodes\n$Elements\n" +
           elements + "\n$EndElements\n";
  };
  const mesh::Mesh mesh = io::mesh_of(
      io::read_msh(saved(file("3\n1 2 2 8 1 1 2 3\n2 2 2 -9 1 1 2 3\n3 4 2 6 1 1 2 3 4"))), 1.0);
  ASSERT_EQ(mesh.surfaces.size(), 2U);
  EXPECT_EQ(mesh.surfaces[0].name, "surface_8");
  EXPECT_EQ(mesh.surfaces[1].name, "surface_9");
  EXPECT_EQ(mesh.surfaces[0].faces, mesh.surfaces[1].faces);
  EXPECT_EQ(mesh.volumes, std::vector<std::string>{"volume_6"});
  expect_refused(file("1\n3 4 4 6 1 1 1 1 2 3 4"), "partitioned");
  expect_refused(file("1\n3 4 -1 1 2 3 4"), "-1 tags");
  expect_refused(file("2\n3 4 2 6 1 1 2 3 4\n3 4 2 7 1 1 2 3 4"), "in two physical volumes");
  expect_refused(file("2\n3 4 2 0 1 1 2 3 4"), "'$EndElements' is no integer");
  expect_refused(file("1\n3 4 2 0 1 1 2 3 4"), "no tetrahedra in any physical volume");
}

}  // namespace
}  // namespace trocar
