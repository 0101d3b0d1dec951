#include "io/msh_mesh.hpp"

#include <algorithm>
#include <array>

#include "core/failure.hpp"
#include "io/msh_groups.hpp"

namespace trocar::io {
namespace {

// Gmsh's type numbers of simplices, and the position of our middle nodes (edges `mesh::tet_edges`)
// in Gmsh's node order of a tet.
constexpr int point_type = 15;
struct Order
{
  std::array<int, 4> type;           ///< type number, by dimension
  std::array<std::size_t, 4> nodes;  ///< nodes per element, by dimension
};
constexpr Order linear{{point_type, 1, 2, 4}, {1, 2, 3, 4}};
constexpr Order quadratic{{point_type, 8, 9, 11}, {1, 3, 6, 10}};
constexpr std::array<std::size_t, 6> middles_in_gmsh{4, 5, 6, 7, 9, 8};
/// Builds a mesh. Each step of the constructor needs the results of the steps before.
class Assembly
{
 public:
  Assembly(const MshFile& file, double scale);
  mesh::Mesh take() { return std::move(mesh_); }

 private:
  core::Failure failure(const std::string& text) const
  {
    return core::data_error(mesh_.file + ": " + text);
  }
  std::vector<MshGroup> groups(int dim) { return msh_groups(file_, dim, mesh_.remarks); }
  void require_type(const MshGroup& group, int dim) const;
  int row(int of_file) const { return row_[static_cast<std::size_t>(of_file)]; }

  void read_volumes(double scale);
  void number_nodes(const MshTets& raw, double scale);
  void read_surfaces();
  void read_points();
  void read_curves();
  void add_points(mesh::PointGroup points, std::size_t in_file, int dim);

  const MshFile& file_;
  Order order_ = linear;
  mesh::Mesh mesh_;
  std::vector<int> row_;  ///< mesh node of each node of the file; -1: on no tet
};

Assembly::Assembly(const MshFile& file, double scale) : file_(file)
{
  mesh_.file = file.file;
  mesh_.unit = scale;
  mesh_.hash = file.hash;
  for (const MshFile::Block& block : file.blocks)
    if (block.type == quadratic.type[3]) order_ = quadratic;
  read_volumes(scale);
  read_surfaces();
  read_points();
  read_curves();
}

void Assembly::require_type(const MshGroup& group, int dim) const
{
  const int type = order_.type[static_cast<std::size_t>(dim)];
  for (const MshFile::Block* block : group.blocks)
    if (block->type != type && !block->tags.empty())
      throw failure("physical " + std::string(msh_kinds[dim]) + " '" + group.name +
                    "' holds element " + std::to_string(block->tags.front()) +
                    ", of another order than the tetrahedra or no simplex (Gmsh's type " +
                    std::to_string(block->type) + ", not " + std::to_string(type) + ")");
}

void Assembly::read_volumes(double scale)
{
  std::vector<MshGroup> volumes;
  for (MshGroup& group : groups(3)) {
    require_type(group, 3);
    if (group.empty())
      mesh_.remarks.push_back("physical volume '" + group.name + "' holds no tetrahedron");
    else
      volumes.push_back(std::move(group));
  }
  if (volumes.empty()) throw failure("no tetrahedra in any physical volume");
  for (const MshGroup& group : volumes) mesh_.volumes.push_back(group.name);
  const MshTets raw = msh_tets(file_, volumes, order_.nodes[3]);
  number_nodes(raw, scale);
  mesh_.tets.resize(raw.tets.size());
  mesh_.region.resize(raw.tets.size());
  mesh_.elem_tag.resize(raw.tets.size());
  if (raw.nodes_each > 4) mesh_.middles.resize(raw.tets.size());
  for (std::size_t t = 0; t < raw.tets.size(); ++t) {
    const int* const nodes = raw.nodes(raw.tets[t]);
    for (std::size_t a = 0; a < 4; ++a) mesh_.tets[t][a] = row(nodes[a]);
    mesh_.region[t] = raw.region_of(raw.tets[t]);
    mesh_.elem_tag[t] = raw.tag(raw.tets[t]);
    for (std::size_t k = 0; raw.nodes_each > 4 && k < 6; ++k)
      mesh_.middles[t][k] = row(nodes[middles_in_gmsh[k]]);
  }
  if (file_.loose_tets > 0)
    mesh_.remarks.push_back(std::to_string(file_.loose_tets) +
                            " tetrahedra are in no physical volume: they are left out");
}

/// Numbers the nodes of the tets in the order of their tags.
void Assembly::number_nodes(const MshTets& raw, double scale)
{
  row_.assign(file_.node_tag.size(), -1);
  for (const MshTets::Place& tet : raw.tets) {
    const int* const nodes = raw.nodes(tet);
    for (std::size_t a = 0; a < raw.nodes_each; ++a) row_[static_cast<std::size_t>(nodes[a])] = 0;
  }
  std::vector<int> used;
  for (std::size_t i = 0; i < row_.size(); ++i)
    if (row_[i] == 0) used.push_back(static_cast<int>(i));
  const auto tag = [&](int i) { return file_.node_tag[static_cast<std::size_t>(i)]; };
  const auto before = [&](int a, int b) { return tag(a) < tag(b); };
  if (!std::is_sorted(used.begin(), used.end(), before))
    std::sort(used.begin(), used.end(), before);
  mesh_.x.reserve(used.size());
  mesh_.node_tag.reserve(used.size());
  for (int i : used) {
    row_[static_cast<std::size_t>(i)] = static_cast<int>(mesh_.x.size());
    mesh_.node_tag.push_back(tag(i));
    mesh_.x.push_back(scale *
                      Eigen::Map<const mesh::Vec3>(&file_.x[3 * static_cast<std::size_t>(i)]));
  }
}

/// Reads the surfaces. A triangle with a node on no tet is a stray; `mesh::judge` finds the other
/// strays.
void Assembly::read_surfaces()
{
  for (const MshGroup& group : groups(2)) {
    require_type(group, 2);
    mesh::SurfaceGroup surface{group.name, {}, {}, {}};
    for (const MshFile::Block* block : group.blocks)
      for (std::size_t i = 0; i < block->tags.size(); ++i) {
        mesh::Face face;
        for (std::size_t a = 0; a < 3; ++a) face[a] = row(block->nodes[order_.nodes[2] * i + a]);
        if (*std::min_element(face.begin(), face.end()) < 0) {
          surface.strays.push_back(block->tags[i]);
        } else {
          surface.faces.push_back(face);
          surface.tags.push_back(block->tags[i]);
        }
      }
    mesh_.surfaces.push_back(std::move(surface));
  }
}

void Assembly::add_points(mesh::PointGroup points, std::size_t in_file, int dim)
{
  std::sort(points.nodes.begin(), points.nodes.end());
  points.nodes.erase(std::unique(points.nodes.begin(), points.nodes.end()), points.nodes.end());
  const std::size_t off = in_file - points.nodes.size();
  if (off > 0 || in_file == 0)
    mesh_.remarks.push_back("physical " + std::string(msh_kinds[dim]) + " '" + points.name +
                            "': " + std::to_string(off) + " of its " + std::to_string(in_file) +
                            " points are on no tetrahedron");
  mesh_.points.push_back(std::move(points));
}

void Assembly::read_points()
{
  for (const MshGroup& group : groups(0)) {
    require_type(group, 0);
    mesh::PointGroup points{group.name, {}, {}};
    std::vector<int> all;
    for (const MshFile::Block* block : group.blocks)
      all.insert(all.end(), block->nodes.begin(), block->nodes.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (int node : all)
      if (row(node) >= 0) points.nodes.push_back(row(node));
    add_points(std::move(points), all.size(), 0);
  }
}

/// Reads curves as groups of points. Skips a curve that has the name of a surface or of a point
/// group, so that this name keeps its meaning.
void Assembly::read_curves()
{
  const auto taken = [&](const std::string& name) {
    const auto has = [&](const auto& group) { return group.name == name; };
    return std::any_of(mesh_.surfaces.begin(), mesh_.surfaces.end(), has) ||
           std::any_of(mesh_.points.begin(), mesh_.points.end(), has);
  };
  for (const MshGroup& group : groups(1)) {
    if (taken(group.name)) continue;
    require_type(group, 1);
    mesh::PointGroup curve{group.name, {}, {}};
    std::vector<int> all;
    for (const MshFile::Block* block : group.blocks)
      for (std::size_t i = 0; i < block->tags.size(); ++i) {
        const int* const ends = &block->nodes[order_.nodes[1] * i];
        all.insert(all.end(), ends, ends + 2);
        if (row(ends[0]) >= 0 && row(ends[1]) >= 0)
          curve.edges.push_back({row(ends[0]), row(ends[1])});
      }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (int node : all)
      if (row(node) >= 0) curve.nodes.push_back(row(node));
    add_points(std::move(curve), all.size(), 1);
  }
}

}  // namespace

mesh::Mesh mesh_of(const MshFile& file, double scale)
{
  return Assembly(file, scale).take();
}

}  // namespace trocar::io
