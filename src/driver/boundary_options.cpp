#include "driver/boundary_options.hpp"

#include <algorithm>
#include <cmath>

#include "core/csv.hpp"
#include "core/words.hpp"
#include "driver/option_source.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::driver {
namespace {

using core::Options;
using core::Vec3;

/// Reads -fix. A group that is listed more than once becomes one support, fixed along all the axes
/// listed with it.
std::vector<tissue::BoundaryConditions::Fixed> read_fixed(Options& options)
{
  std::vector<tissue::BoundaryConditions::Fixed> fixed;
  for (const std::string& entry : options.names("fix")) {
    const auto colon = entry.find(':');
    tissue::BoundaryConditions::Fixed one{entry.substr(0, colon), 7};
    if (colon != std::string::npos) {
      one.axes = 0;
      for (char axis : entry.substr(colon + 1)) {
        if (axis < 'x' || axis > 'z')
          throw core::option_error("option -fix: '" + entry + "': axes are letters of xyz");
        one.axes |= 1U << (axis - 'x');
      }
    }
    const auto known = std::find_if(fixed.begin(), fixed.end(),
                                    [&](const auto& other) { return other.group == one.group; });
    if (known == fixed.end())
      fixed.push_back(one);
    else
      known->axes |= one.axes;
  }
  return fixed;
}

/// Reads the displacement [m] of every node of a group from a CSV file (columns node,x,y,z; node is
/// the Gmsh tag). Key of the result: index of the node in the mesh. Throws Failure (65).
/// Collective.
std::map<int, Vec3> read_field(const std::string& file, const std::string& group,
                               const mesh::Mesh& mesh, const base::Comm& comm)
{
  const core::Csv table = read_csv(file, comm);
  if (table.columns != std::vector<std::string>{"node", "x", "y", "z"})
    throw core::data_error(file + ": columns must be node,x,y,z");
  std::map<long long, Vec3> by_tag;
  for (const auto& row : table.rows) {
    constexpr double most = 9e15;  // a double holds all integers up to 2^53 = 9.007e15 exactly
    if (row[0] != std::floor(row[0]) || std::abs(row[0]) > most)
      throw core::data_error(file + ": node " + core::shown(row[0]) + " is no tag of a node");
    const auto tag = static_cast<long long>(row[0]);
    const Vec3 value(row[1], row[2], row[3]);
    const auto [known, fresh] = by_tag.emplace(tag, value);
    if (!fresh && known->second != value)
      throw core::data_error(file + ": node " + std::to_string(tag) +
                             " is given twice, with different displacements");
  }
  std::map<int, Vec3> field;
  std::vector<int> missing;
  for (int node : mesh::group_nodes(mesh, group)) {
    const auto at = by_tag.find(mesh.node_tag[static_cast<std::size_t>(node)]);
    if (at != by_tag.end())
      field.emplace(node, at->second);
    else
      missing.push_back(node);
  }
  for (int node : missing) {  // a middle node without a row takes the mean of its edge
    const auto ends = mesh::ends_of_middle(mesh, node);
    if (!ends || !field.count((*ends)[0]) || !field.count((*ends)[1]))
      throw core::data_error(file + ": node " +
                             std::to_string(mesh.node_tag[static_cast<std::size_t>(node)]) +
                             " of group '" + group + "' is missing");
    field[node] = 0.5 * (field[(*ends)[0]] + field[(*ends)[1]]);
  }
  return field;
}

}  // namespace

std::optional<core::Csv> read_curve(const std::string& file, const base::Comm& comm)
{
  if (file.empty()) return std::nullopt;
  core::Csv curve = read_csv(file, comm);
  core::require_time_column(curve);
  if (curve.columns.size() != 2) throw core::data_error(file + ": columns must be time,factor");
  return curve;
}

tissue::BoundaryConditions read_boundary(Options& options, const mesh::Mesh& mesh,
                                         const base::Comm& comm)
{
  tissue::BoundaryConditions boundary;
  boundary.gravity = options.vector("gravity");
  boundary.fixed = read_fixed(options);
  std::set<std::string> groups = options.groups_given("boundary_<surf>_displacement");
  for (const char* pattern :
       {"boundary_<surf>_traction", "boundary_<surf>_curve", "boundary_<surf>_field"})
    for (const std::string& group : options.groups_given(pattern)) groups.insert(group);
  for (const std::string& group : groups) {
    const std::string field = options.text("boundary_<surf>_field", group);
    const bool uniform = options.given("boundary_<surf>_displacement", group);
    if (uniform && !field.empty())
      throw core::option_error("option -boundary_" + group +
                               "_field: the group has one displacement for all nodes already");
    const bool moves = uniform || !field.empty();
    const bool pulls = options.given("boundary_<surf>_traction", group);
    const std::string file = options.text("boundary_<surf>_curve", group);
    if (!file.empty() && !moves && !pulls)
      throw core::option_error("option -boundary_" + group +
                               "_curve: the group has neither displacement nor traction");
    const auto curve = read_curve(file, comm);
    if (moves) {
      mesh::group_nodes(mesh, group);
      boundary.displacements.push_back(
          {group,
           uniform ? options.vector_or_free("boundary_<surf>_displacement", group)
                   : Vec3(Vec3::Zero()),
           curve, field.empty() ? std::map<int, Vec3>{} : read_field(field, group, mesh, comm)});
    }
    if (pulls) {
      mesh::surface_group(mesh, group);
      boundary.tractions.push_back(
          {group, options.vector("boundary_<surf>_traction", group), curve});
    }
  }
  for (const auto& fixed : boundary.fixed) mesh::group_nodes(mesh, fixed.group);
  tissue::refuse_conflicts(boundary, mesh);
  return boundary;
}

}  // namespace trocar::driver
