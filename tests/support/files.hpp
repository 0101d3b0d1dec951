#pragma once

#include <string>

#include "mesh/mesh.hpp"

namespace trocar::test {

/// The text of a file; a failed check and "" when there is none.
std::string file_text(const std::string& path);

/// Writes text to a file on rank 0; it is there for every rank afterwards. Collective.
std::string shared_text(const std::string& path, const std::string& text, const base::Comm& comm);

/// The mesh of linear tets as a Gmsh file (2.2, ascii) with its volumes and surfaces, written by
/// rank 0; gives its name. Collective.
std::string shared_mesh(const std::string& path, const mesh::Mesh& mesh, const base::Comm& comm);

}  // namespace trocar::test
