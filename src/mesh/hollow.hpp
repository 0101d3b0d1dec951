#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// The mesh without the tets of one volume, which becomes a void. The faces between the void and
/// the remaining tets become a physical surface with the name of the volume. Nodes that only
/// removed tets have are dropped. Other groups lose their points and edges with dropped nodes, and
/// their faces that no remaining tet has. Failure (65) when the volume does not exist, is the only
/// one, or has the name of a surface. Not collective.
Mesh hollow(const Mesh& mesh, const std::string& volume);

}  // namespace trocar::mesh
