#include <algorithm>

#include "mesh/mesh.hpp"

// In a separate file, because mesh.cpp does not use MPI.
namespace trocar::mesh {
namespace {

template <class Group>
std::vector<std::string> names_of(const std::vector<Group>& groups)
{
  std::vector<std::string> names;
  for (const Group& group : groups) names.push_back(group.name);
  return names;
}

template <class Array>
void broadcast_rows(std::vector<Array>& rows, const base::Comm& comm)
{
  std::vector<int> flat;
  for (const Array& row : rows) flat.insert(flat.end(), row.begin(), row.end());
  comm.broadcast(flat);
  const std::size_t width = Array().size();
  rows.resize(flat.size() / width);
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(flat.begin() + static_cast<std::ptrdiff_t>(i * width), width, rows[i].begin());
}

void broadcast_points(std::vector<Vec3>& x, const base::Comm& comm)
{
  std::vector<double> flat;
  for (const Vec3& p : x) flat.insert(flat.end(), p.data(), p.data() + 3);
  comm.broadcast(flat);
  x.resize(flat.size() / 3);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = Eigen::Map<const Vec3>(&flat[3 * i]);
}

}  // namespace

void broadcast(Mesh& mesh, const base::Comm& comm)
{
  comm.broadcast(mesh.file);
  comm.broadcast(mesh.hash);
  std::vector<double> unit{mesh.unit};
  comm.broadcast(unit);
  mesh.unit = unit.front();
  broadcast_points(mesh.x, comm);
  broadcast_rows(mesh.tets, comm);
  broadcast_rows(mesh.middles, comm);
  mesh.index_middles();
  comm.broadcast(mesh.region);
  comm.broadcast(mesh.volumes);
  comm.broadcast(mesh.file_of);
  comm.broadcast(mesh.node_tag);
  comm.broadcast(mesh.elem_tag);
  comm.broadcast(mesh.remarks);
  std::vector<std::string> names = names_of(mesh.surfaces);
  comm.broadcast(names);
  mesh.surfaces.resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    mesh.surfaces[i].name = names[i];
    broadcast_rows(mesh.surfaces[i].faces, comm);
    comm.broadcast(mesh.surfaces[i].strays);
  }
  names = names_of(mesh.points);
  comm.broadcast(names);
  mesh.points.resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    mesh.points[i].name = names[i];
    comm.broadcast(mesh.points[i].nodes);
    broadcast_rows(mesh.points[i].edges, comm);
  }
}

}  // namespace trocar::mesh
