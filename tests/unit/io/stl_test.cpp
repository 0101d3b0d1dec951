#include <gtest/gtest.h>

#include <cctype>
#include <cstdint>
#include <cstring>

#include "core/failure.hpp"
#include "io/stl.hpp"

namespace trocar {
namespace {

using core::Vec3;

/// The faces of the tet with corners 0, x, y, z, seen from outside.
const std::vector<mesh::Triangle> tet{{Vec3::Zero(), Vec3::UnitY(), Vec3::UnitX()},
                                      {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ()},
                                      {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()},
                                      {Vec3::UnitY(), Vec3::Zero(), Vec3::UnitZ()}};

std::string text_of(const std::vector<mesh::Triangle>& triangles)
{
  std::string text = "solid  some name\n";
  for (const mesh::Triangle& triangle : triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const Vec3& x : triangle)
      text += "   vertex " + std::to_string(x.x()) + " " + std::to_string(x.y()) + "\t" +
              std::to_string(x.z()) + "\r\n";
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid\n";
}

template <class Value>
void append(Value value, std::string& bytes)
{
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

std::string binary_of(const std::vector<mesh::Triangle>& triangles)
{
  std::string bytes = "solid a binary file may begin so";
  bytes.resize(80);
  append(static_cast<std::uint32_t>(triangles.size()), bytes);
  for (const mesh::Triangle& triangle : triangles) {
    for (int k = 0; k < 3; ++k) append(0.0F, bytes);
    for (const Vec3& x : triangle)
      for (int k = 0; k < 3; ++k) append(static_cast<float>(x[k]), bytes);
    append(std::uint16_t{0}, bytes);
  }
  return bytes;
}

TEST(Stl, TextAndBinaryHaveTheSameTriangles)
{
  for (const std::string& bytes : {text_of(tet), binary_of(tet)}) {
    const mesh::Skin skin = mesh::skin_of(io::parse_stl(bytes, "file"), "file");
    EXPECT_EQ(skin.x.size(), 4U);
    EXPECT_EQ(skin.faces.size(), 4U);
    EXPECT_NEAR(skin.volume(), 1.0 / 6.0, 1e-15);
  }
}

TEST(Stl, WordsInCapitalsAndTextBehindTheEnd)
{
  std::string text = text_of(tet);
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(io::parse_stl(text + "\n; made by hand\n", "file").size(), 4U);
}

TEST(Stl, TrianglesWithoutAreaAreLeftOut)
{
  std::vector<mesh::Triangle> more = tet;
  more.push_back({Vec3::Zero(), Vec3::Zero(), Vec3::UnitX()});
  EXPECT_EQ(mesh::skin_of(more, "file").faces.size(), 4U);
}

std::string refusal_of(const std::string& bytes)
{
  try {
    mesh::skin_of(io::parse_stl(bytes, "file"), "file");
  } catch (const core::Failure& failure) {
    EXPECT_EQ(failure.code(), core::ExitCode::data);
    return failure.what();
  }
  return "taken";
}

TEST(Stl, BadFilesAreRefused)
{
  std::vector<mesh::Triangle> open = tet, inside = tet, nothing = tet;
  open.pop_back();
  for (mesh::Triangle& triangle : inside) std::swap(triangle[0], triangle[1]);
  nothing[0][1].x() = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal_of(text_of(open)).find("open at"), std::string::npos);
  EXPECT_NE(refusal_of(binary_of(inside)).find("inside out"), std::string::npos);
  EXPECT_NE(refusal_of(binary_of(nothing)).find("triangle 1"), std::string::npos);
  EXPECT_NE(refusal_of(text_of(nothing)).find("line 5"), std::string::npos);
  EXPECT_NE(refusal_of("").find("cut off"), std::string::npos);
  EXPECT_NE(refusal_of("solid\nfacet\nfacet\nendsolid").find("line 3"), std::string::npos);
  EXPECT_NE(refusal_of("solid\nfacet\nvertex 0 0 0\nendsolid").find("line 4"), std::string::npos);
  std::vector<mesh::Triangle> two = tet;  // the second part is inside out
  for (mesh::Triangle triangle : inside) {
    for (Vec3& x : triangle) x.x() += 2.0;
    two.push_back(triangle);
  }
  EXPECT_NE(refusal_of(text_of(two)).find("inside out at (2"), std::string::npos)
      << refusal_of(text_of(two));
  EXPECT_NE(refusal_of("solid\nendsolid\n").find("no triangles"), std::string::npos);
  EXPECT_NE(refusal_of(binary_of(tet).substr(0, 200)).find("file"), std::string::npos);
  const std::string text = text_of(tet);
  for (std::size_t size = 0; size < text.size() - 10; size += 7)
    EXPECT_NE(refusal_of(text.substr(0, size)), "taken") << size;
}

}  // namespace
}  // namespace trocar
