#include "cavity/wall.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/body.hpp"
#include "support/cavity.hpp"

namespace trocar::cavity {
namespace {

using Condition = std::function<bool(const Vec3&)>;

Condition in_box(const Vec3& low, const Vec3& high)
{
  return [=](const Vec3& x) {
    return ((x - low).array() > -1e-9).all() && ((high - x).array() > -1e-9).all();
  };
}

/// A block of 5 x 4 x 4 cells of 1 cm without those whose middles are in `hole`; the surface "wall"
/// has all faces on the boundary in `hole`.
test::BlockShape with_hole(const Condition& hole)
{
  test::BlockShape shape{5, 4, 4, Vec3(0.05, 0.04, 0.04)};
  shape.hole = hole;
  return shape;
}

mesh::Mesh hollow_block(const Condition& hole)
{
  mesh::Mesh mesh = test::block(with_hole(hole));
  test::add_surface(mesh, "wall", hole);
  return mesh;
}

const Vec3 low(0.01, 0.01, 0.01), high(0.04, 0.03, 0.02);

mesh::Mesh box_shaped_void()
{
  return hollow_block(in_box(low, high));
}

/// A channel along x, open at both ends; its wall without these.
mesh::Mesh channel()
{
  mesh::Mesh mesh = test::block(with_hole(in_box(Vec3(0.0, 0.01, 0.01), Vec3(0.05, 0.03, 0.03))));
  test::add_surface(mesh, "wall", in_box(Vec3(0.0, 0.01, 0.01), Vec3(0.05, 0.03, 0.03)));
  return mesh;
}

/// Σ over the flat faces of a wall: areas with their normals, and whether all look away from the
/// middle.
struct Faces
{
  explicit Faces(const Wall& wall)
  {
    const law::ClosedSurface& surface = wall.surface();
    const auto n = static_cast<std::size_t>(surface.face_nodes);
    for (std::size_t f = 0; f < surface.faces(); ++f) {
      Vec3 x[3];
      for (std::size_t k = 0; k < 3; ++k)
        x[k] = wall.undeformed().segment<3>(3 * surface.nodes[n * f + k]);
      const Vec3 normal = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
      sum += normal;
      area += normal.norm();
      outward = outward && normal.dot(x[0] + x[1] + x[2]) > 0.0;
    }
  }
  Vec3 sum = Vec3::Zero();
  double area = 0.0;
  bool outward = true;
};

void expect_box(const Wall& wall)
{
  const double volume = 0.03 * 0.02 * 0.01, area = 2.0 * (6e-4 + 3e-4 + 2e-4);
  EXPECT_NEAR(wall.volume(), volume, 1e-15 * 0.05);
  EXPECT_NEAR(wall.area(), area, 1e-14);
  const Faces faces(wall);
  EXPECT_LT(faces.sum.norm(), 1e-17);  // closed
  EXPECT_NEAR(faces.area, area, 1e-14);
  EXPECT_TRUE(faces.outward);
  EXPECT_TRUE(wall.rims().empty());
}

TEST(Wall, OfABoxShapedVoidIsClosedAndLooksIntoTheTissue)
{
  mesh::Mesh mesh = box_shaped_void();
  const Wall wall(mesh, "wall", false);
  expect_box(wall);
  EXPECT_EQ(wall.surface().faces(), 2U * 2U * (6U + 3U + 2U));
  EXPECT_EQ(wall.nodes(), mesh::group_nodes(mesh, "wall"));
  // Whichever way the file has its faces.
  for (mesh::Face& face : mesh.surfaces.back().faces) std::swap(face[0], face[1]);
  expect_box(Wall(mesh, "wall", true));
}

TEST(Wall, OfAQuadraticMeshHasItsMiddles)
{
  test::BlockShape shape = with_hole(in_box(low, high));
  shape.quadratic = true;
  mesh::Mesh mesh = test::block(shape);
  test::add_surface(mesh, "wall", in_box(low, high));
  const Wall wall(mesh, "wall", false);
  expect_box(wall);
  EXPECT_EQ(wall.surface().face_nodes, 6);
  EXPECT_EQ(wall.nodes(), mesh::group_nodes(mesh, "wall"));
}

TEST(Wall, HoldsWhatIsInsideIt)
{
  const Wall wall(box_shaped_void(), "wall", false);
  const auto holds = [&](const Vec3& x) {
    return wall.holds(x - wall.reference(), wall.undeformed());
  };
  EXPECT_TRUE(holds(Vec3(0.02, 0.02, 0.015)));
  EXPECT_TRUE(holds(Vec3(0.0101, 0.0101, 0.0199)));
  EXPECT_FALSE(holds(Vec3(0.02, 0.02, 0.0201)));
  EXPECT_FALSE(holds(Vec3(0.3, 0.02, 0.015)));
  // All about, in front of faces, edges and corners.
  for (double x : {-0.3, 0.0099, 0.0101, 0.0133, 0.0251, 0.0399, 0.0401})
    for (double y : {0.0099, 0.0101, 0.0213, 0.0299, 0.0301, 0.9})
      for (double z : {-0.2, 0.0099, 0.0101, 0.0157, 0.0199, 0.0201}) {
        const Vec3 place(x, y, z);
        const bool inside =
            ((place - low).array() > 0.0).all() && ((high - place).array() > 0.0).all();
        EXPECT_EQ(holds(place), inside) << place.transpose();
      }
  const core::VecX twice = 2.0 * wall.undeformed();
  EXPECT_TRUE(wall.holds(Vec3(0.0, 0.0, 0.0099), twice));  // where it is now
}

TEST(Wall, WithHolesIsClosedByCaps)
{
  const mesh::Mesh mesh = channel();
  const Wall wall(mesh, "wall", true);
  EXPECT_NEAR(wall.volume(), 0.05 * 0.02 * 0.02, 1e-18);
  EXPECT_NEAR(wall.area(), 4 * 0.05 * 0.02 + 2 * 0.02 * 0.02, 1e-14);
  const Faces faces(wall);
  EXPECT_LT(faces.sum.norm(), 1e-17);
  EXPECT_TRUE(faces.outward);
  ASSERT_EQ(wall.rims().size(), 2U);
  for (const std::vector<int>& rim : wall.rims()) {
    EXPECT_EQ(rim.size(), 8U);  // a square of 2 x 2 cells
    const double x = mesh.x[static_cast<std::size_t>(rim.front())].x();
    for (int node : rim) EXPECT_EQ(mesh.x[static_cast<std::size_t>(node)].x(), x);
  }
}

// Quadratic faces of caps are as flat as the holes they close.
TEST(Wall, OfAQuadraticMeshIsClosedByFlatCaps)
{
  const Condition hole = in_box(Vec3(0.0, 0.01, 0.01), Vec3(0.05, 0.03, 0.03));
  test::BlockShape shape = with_hole(hole);
  shape.quadratic = true;
  mesh::Mesh mesh = test::block(shape);
  test::add_surface(mesh, "wall", hole);
  const Wall wall(mesh, "wall", true);
  EXPECT_NEAR(wall.volume(), 0.05 * 0.02 * 0.02, 1e-17);
  EXPECT_NEAR(wall.area(), 4 * 0.05 * 0.02 + 2 * 0.02 * 0.02, 1e-13);
  EXPECT_LT(Faces(wall).sum.norm(), 1e-17);
  EXPECT_EQ(wall.rims().size(), 2U);
}

// The work of forces at the vertices, the caps' included, is that at the nodes of any rank.
TEST(Wall, ForcesAreTheAdjointOfPlaces)
{
  test::Body body(with_hole(in_box(Vec3(0.0, 0.01, 0.01), Vec3(0.05, 0.03, 0.03))));
  const Wall wall(channel(), "wall", true);
  const OwnedField u = test::nodal(body, [](const Vec3& X) {
    return Vec3(std::sin(90.0 * X.x()), std::cos(70.0 * X.y()), X.z() * X.x());
  });
  const VecX at = wall.at_vertices(u, body.space);
  VecX forces(at.size());
  for (Eigen::Index i = 0; i < forces.size(); ++i)
    forces[i] = std::cos(2.0 * static_cast<double>(i));
  const double work = body.space.dot(wall.to_nodes(forces, body.space), u);
  EXPECT_NEAR(work, forces.dot(at), 1e-13 * forces.norm() * at.norm());
  for (std::size_t i = 0; i < wall.nodes().size(); ++i) {
    const Vec3 X = body.mesh.x[static_cast<std::size_t>(wall.nodes()[i])];
    EXPECT_LT((at.segment<3>(3 * static_cast<Eigen::Index>(i)) -
               Vec3(std::sin(90.0 * X.x()), std::cos(70.0 * X.y()), X.z() * X.x()))
                  .norm(),
              1e-15);
  }
}

/// The surface "wall" is refused, by code 65 and with these words.
void expect_refusal(const mesh::Mesh& mesh, bool caps, const std::string& words)
{
  try {
    const Wall wall(mesh, "wall", caps);
    ADD_FAILURE() << "accepted a wall that " << words;
  } catch (const core::Failure& failure) {
    const std::string line = failure.what();
    EXPECT_EQ(failure.code(), core::ExitCode::data);
    EXPECT_NE(line.find(words), std::string::npos) << line;
    EXPECT_NE(line.find("wall"), std::string::npos) << line;
  }
}

TEST(Wall, ThatIsOpenIsRefused)
{
  expect_refusal(channel(), false, "has a hole of 8 edges");
  mesh::Mesh mesh = box_shaped_void();
  mesh.surfaces.back().faces.pop_back();
  expect_refusal(mesh, false, "has a hole of 3 edges");
}

TEST(Wall, ThatIsNoBoundaryOfAVoidIsRefused)
{
  mesh::Mesh twice = box_shaped_void();
  twice.surfaces.back().faces.push_back(twice.surfaces.back().faces.front());
  expect_refusal(twice, false, "has a face twice");

  mesh::Mesh inside = box_shaped_void();
  const mesh::Tet& tet = inside.tets[0];
  for (const mesh::Face& face : {mesh::Face{tet[0], tet[1], tet[2]},
                                 {tet[0], tet[1], tet[3]},
                                 {tet[0], tet[2], tet[3]},
                                 {tet[1], tet[2], tet[3]}})
    inside.surfaces.back().faces.push_back(face);
  expect_refusal(inside, false, "tissue on both sides");

  mesh::Mesh outer = test::block({2, 2, 2});
  test::add_surface(outer, "wall", [](const Vec3&) { return true; });
  expect_refusal(outer, false, "inside out");

  mesh::Mesh flat = test::block({2, 2, 2});
  test::add_surface(flat, "wall", [](const Vec3& x) { return x.z() == 0.0; });
  expect_refusal(flat, true, "encloses no volume");

  mesh::Mesh none = test::block({2, 2, 2});
  expect_refusal(none, false, "no physical surface");
}

TEST(Wall, ThatTouchesItselfIsRefused)
{
  const Vec3 cell(0.01, 0.01, 0.01);
  for (const auto& [second, words] :
       {std::pair{Vec3(0.02, 0.02, 0.01), "touches itself"},  // along an edge
        std::pair{Vec3(0.02, 0.02, 0.02), "touches itself at node"}}) {
    const Condition one = in_box(low, low + cell), other = in_box(second, second + cell);
    mesh::Mesh mesh = test::block(with_hole([&](const Vec3& x) { return one(x) || other(x); }));
    mesh::SurfaceGroup wall{"wall", {}};
    for (const Condition& hole : {one, other}) {
      test::add_surface(mesh, "part", hole);
      const auto& faces = mesh.surfaces.back().faces;
      wall.faces.insert(wall.faces.end(), faces.begin(), faces.end());
    }
    mesh.surfaces.push_back(wall);
    expect_refusal(mesh, false, words);
  }
}

}  // namespace
}  // namespace trocar::cavity
