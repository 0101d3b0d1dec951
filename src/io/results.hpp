#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/comm.hpp"
#include "base/hdf5.hpp"
#include "core/ledger.hpp"
#include "io/xdmf.hpp"
#include "mesh/mesh.hpp"

namespace trocar::io {

/// One history: a name below /history, its number of columns (0 for scalars) and unit.
struct Series
{
  std::string name;
  std::size_t columns;
  std::string units;
};

/// One dataset of a field file. `nodal` fields are shown by ParaView through run.xdmf.
struct Field
{
  std::string name;     ///< path in the file
  std::size_t columns;  ///< 0 for scalars
  std::string units;
  std::vector<double> values;  ///< row-major
  bool nodal = false;
  bool integer = false;  ///< write as 64-bit integers
  bool cell = false;     ///< by tet; shown like nodal fields
};

/// A curve of a field file, shown by ParaView: written as NAME/axis (points, 3) [m] and, the same
/// at every point so that filters find it, NAME/radius (points) [m].
struct Curve
{
  std::string name;            ///< of a group in the file
  std::vector<double> points;  ///< row-major [m]
  double radius;               ///< [m]
};

/// What a run was: text and word lists below /provenance.
struct Provenance
{
  std::vector<std::pair<std::string, std::string>> texts;
  std::vector<std::pair<std::string, std::vector<std::string>>> tables;
};

/// The result folder: run.h5 (mesh, provenance, histories, ledger), fields/step_N.h5, run.xdmf.
/// Lives on rank 0 alone; every call throws Failure (74) there. A run that is killed leaves every
/// finished step readable: field files are renamed into place, histories only grow.
class Results
{
 public:
  Results(const std::string& folder, const mesh::Mesh& mesh, const Provenance& provenance,
          const std::vector<Series>& series);

  /// One row in every series, in the order they were declared.
  void append_history(const std::vector<std::vector<double>>& row, const core::Ledger& ledger);

  /// A field file for this time; `step` counts accepted steps.
  void write_fields(int step, double time, const std::vector<Field>& fields,
                    const std::vector<Curve>& curves, const std::vector<std::string>& notes);
  /// A dataset of its own in run.h5, once the run is over.
  void write_table(const std::string& path, const std::vector<double>& values,
                   const std::string& units);
  void close();

 private:
  void write_mesh(const mesh::Mesh& mesh);
  std::string folder_;
  base::H5File run_;
  std::vector<Series> series_;
  XdmfMesh mesh_;
  std::vector<XdmfFrame> frames_;
};

/// Writes text to a temporary name, syncs it and renames it over `path`. Throws Failure (74).
void write_atomically(const std::string& path, const std::string& text);

}  // namespace trocar::io
