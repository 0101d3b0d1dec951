#pragma once

#include "fem/block_matrix.hpp"
#include "mesh/partition.hpp"
#include "support/block.hpp"
#include "tissue/tissue.hpp"

namespace trocar::test {

/// A block with its space and one tissue on it, on all ranks of the world.
struct Body
{
  explicit Body(const BlockShape& shape, tissue::TissueSettings settings = {})
      : comm(MPI_COMM_WORLD),
        mesh(block(shape)),
        space(mesh, mesh::partition_nodes(mesh, comm), comm,
              tissue::overlap_layers(settings.dilatation)),
        tissue(mesh, space, with_material(std::move(settings)), ledger)
  {
  }

  static tissue::TissueSettings with_material(tissue::TissueSettings settings)
  {
    if (settings.materials.empty()) settings.materials.push_back({});
    return settings;
  }

  base::Comm comm;
  mesh::Mesh mesh;
  core::Ledger ledger;
  fem::Space space;
  tissue::Tissue tissue;
};

/// The field f(X) of the body's owned nodes.
inline fem::OwnedField nodal(const Body& body,
                             const std::function<core::Vec3(const core::Vec3&)>& f)
{
  fem::OwnedField field = body.space.zero();
  for (int i = 0; i < body.space.owned(); ++i)
    field.node(i) = f(body.mesh.x[static_cast<std::size_t>(body.space.file_node(i))]);
  return field;
}

/// The undeformed operator scale_k K + scale_m M of a mesh as a dense matrix in file numbering,
/// assembled with the textbook 6x12 strain matrix: independent of the program's block formula.
core::MatX dense_operator(const mesh::Mesh& mesh, const tissue::Material& material, double scale_k,
                          double scale_m);

/// Rows and columns of fixed dofs of a dense operator replaced by those of the identity.
void fix_dense(core::MatX& A, const fem::Dirichlet& fixed, int nodes);

}  // namespace trocar::test
