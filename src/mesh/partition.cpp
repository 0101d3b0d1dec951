#include "mesh/partition.hpp"

#include <metis.h>

#include "mesh/quadratic.hpp"

namespace trocar::mesh {
namespace {

std::vector<int> metis_node_parts(const Mesh& mesh, int part_count)
{
  std::vector<idx_t> start{0}, nodes;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetNodes of_tet = nodes_of(mesh, t);
    nodes.insert(nodes.end(), of_tet.begin(), of_tet.end());
    start.push_back(static_cast<idx_t>(nodes.size()));
  }
  idx_t tets = mesh.tet_count(), count = mesh.node_count(), parts = part_count, cut = 0;
  idx_t shared_nodes = mesh.quadratic() ? 6 : 3;  // nodes of a face that two tets share
  std::vector<idx_t> tet_part(mesh.tets.size()), node_part(mesh.x.size());
  const int status =
      METIS_PartMeshDual(&tets, &count, start.data(), nodes.data(), nullptr, nullptr, &shared_nodes,
                         &parts, nullptr, nullptr, &cut, tet_part.data(), node_part.data());
  if (status != METIS_OK)
    throw core::Failure(
        core::ExitCode::internal,
        mesh.file + ": METIS could not partition the mesh (" + std::to_string(status) + ")");
  return {node_part.begin(), node_part.end()};
}

}  // namespace

std::vector<int> partition_nodes(const Mesh& mesh, const base::Comm& comm)
{
  std::vector<int> owner(mesh.x.size(), 0);
  if (comm.size() == 1) return owner;
  base::on_root(comm, [&] {
    // METIS needs at least one tet per part. With fewer tets the last ranks own nothing.
    const int parts = std::min(comm.size(), mesh.tet_count());
    if (parts > 1) owner = metis_node_parts(mesh, parts);
  });
  comm.broadcast(owner);
  return owner;
}

}  // namespace trocar::mesh
