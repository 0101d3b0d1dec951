#include "mesh/locator.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <utility>

#include "mesh/quadratic.hpp"

namespace trocar::mesh {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Entry = std::pair<Box, int>;

Point point(const Vec3& p)
{
  return {p.x(), p.y(), p.z()};
}

}  // namespace

struct Locator::Tree
{
  bg::index::rtree<Entry, bg::index::quadratic<16>> boxes;
};

Locator::Locator(const Mesh& mesh) : mesh_(&mesh)
{
  std::vector<Entry> entries;
  entries.reserve(mesh.tets.size());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetPositions p = positions(mesh, t);
    Vec3 low = p.rowwise().minCoeff(), high = p.rowwise().maxCoeff();
    if (!is_straight(p)) {  // a curved face may bulge beyond the box of its nodes
      const Vec3 beyond = 0.1 * (high - low);
      low -= beyond;
      high += beyond;
    }
    entries.emplace_back(Box(point(low), point(high)), t);
    longest_edge_ = std::max(longest_edge_, (high - low).norm());
  }
  tree_ = std::make_unique<Tree>(
      Tree{bg::index::rtree<Entry, bg::index::quadratic<16>>(entries.begin(), entries.end())});
}

Locator::~Locator() = default;
Locator::Locator(Locator&&) noexcept = default;
Locator& Locator::operator=(Locator&&) noexcept = default;

std::vector<int> Locator::in_box(const Vec3& low, const Vec3& high) const
{
  std::vector<Entry> hits;
  tree_->boxes.query(bg::index::intersects(Box(point(low), point(high))), std::back_inserter(hits));
  std::vector<int> tets;
  for (const Entry& hit : hits) tets.push_back(hit.second);
  std::sort(tets.begin(), tets.end());
  return tets;
}

int Locator::tet_at(const Vec3& p, double tolerance) const
{
  const Vec3 reach = Vec3::Constant(tolerance * longest_edge_);
  for (int tet : in_box(p - reach, p + reach))
    if (local_coordinates(positions(*mesh_, tet), p).minCoeff() >= -tolerance) return tet;
  return -1;
}

}  // namespace trocar::mesh
