#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace trocar::io {

/// Reads a Gmsh mesh (MSH 2.2 or 4.1, ascii or binary) on rank 0 and copies it to every rank. Only
/// tets in physical volumes are kept. Physical volumes, surfaces, curves and points keep their
/// names; a group without a name is called "volume_TAG" etc. Coordinates are multiplied by `scale`.
/// Throws Failure (65) on every rank, with file and tag, for a mesh that cannot be used.
/// Collective.
mesh::Mesh read_gmsh(const std::string& file, double scale, const base::Comm& comm);
/// The meshes of several files as one, see mesh::joined. Collective.
mesh::Mesh read_gmsh(const std::vector<std::string>& files, double scale, const base::Comm& comm);

}  // namespace trocar::io
