#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// The mesh without the tets of one volume, which becomes a void. Its faces to the rest become a
/// physical surface of its name. Nodes of that volume alone are dropped, with their faces and
/// points in other groups. Throws Failure (65) when that volume does not exist, is the only one,
/// or has the name of a surface. Not collective.
Mesh hollow(const Mesh& mesh, const std::string& volume);

}  // namespace trocar::mesh
