#pragma once

#include "io/msh_file.hpp"
#include "mesh/mesh.hpp"

namespace trocar::io {

/// The mesh of a file: its tets in physical volumes, the nodes of these, the groups by name, all
/// in the order of their tags; coordinates times `scale` [m]. Groups of one name and dimension are
/// one, what is listed twice counts once, and `remarks` says so. Failure (65) for elements we have
/// not. For one rank alone.
mesh::Mesh mesh_of(const MshFile& file, double scale);

}  // namespace trocar::io
