#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::mesh {

/// The mesh without the tets of one volume: a void. The faces between it and what remains become
/// the physical surface of that name; nodes that only it had are gone, and faces and points of
/// other groups with them. Throws Failure (65) when there is no such volume, nothing else, or a
/// surface has that name already. Not collective.
Mesh hollow(const Mesh& mesh, const std::string& volume);

}  // namespace trocar::mesh
