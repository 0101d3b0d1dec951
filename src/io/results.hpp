#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/comm.hpp"
#include "base/files.hpp"
#include "base/hdf5.hpp"
#include "core/ledger.hpp"
#include "io/checkpoint.hpp"
#include "io/output_folder.hpp"
#include "io/xdmf.hpp"
#include "mesh/mesh.hpp"

namespace trocar::io {

/// One history: a name below /history, its number of columns (0 for scalars) and unit.
struct Series
{
  std::string name;
  std::size_t columns;
  std::string units;
  std::string old_name{};  ///< former name, kept as a link for readers of older files; "": none
};

/// One dataset of a field file. ParaView shows `nodal` and `cell` fields through run.xdmf.
struct Field
{
  std::string name;     ///< path of the dataset in the file
  std::size_t columns;  ///< values per row; 0 for scalars
  std::string units;
  std::vector<double> values;  ///< row-major
  bool nodal = false;          ///< one row per node
  bool integer = false;        ///< write as 64-bit integers
  bool cell = false;           ///< one row per tet
};

/// A polyline of a field file, shown by ParaView. It is written as NAME/axis (points, 3) [m] and
/// NAME/radius (points) [m]. The radius is repeated at every point, so that ParaView's filters find
/// it.
struct Curve
{
  std::string name;            ///< path of its group in the file
  std::vector<double> points;  ///< coordinates, row-major [m]
  double radius;               ///< [m]
};

/// Origin of a run: texts and lists of words below /provenance.
struct Provenance
{
  std::vector<std::pair<std::string, std::string>> texts;
  std::vector<std::pair<std::string, std::vector<std::string>>> tables;
};

/// Writes the results of a run: run.h5 (mesh, provenance, histories, ledger), fields/step_N.h5 and
/// run.xdmf. Lives on rank 0 only; every call may throw Failure (74) there. Steps written so far
/// stay readable when the run is killed or the disk is full. For this, histories in run.h5 have
/// room for rows to come, and a row is written before the row count; all other files are replaced
/// as a whole.
class Results
{
 public:
  /// `rows`: expected number of history rows, for which room is made. More rows may follow.
  Results(const std::string& folder, const mesh::Mesh& mesh, const Provenance& provenance,
          const std::vector<Series>& series, std::size_t rows = 1);
  /// Continues in the folder of an earlier run, after the last row that the checkpoint `from`
  /// knows. Later rows and field files are removed. `note` is stored in run.h5. Failure (65) when
  /// run.h5 is not the file that belongs to the checkpoint, (74) when it cannot be rewritten.
  Results(const std::string& folder, const mesh::Mesh& mesh, const std::vector<Series>& series,
          const Checkpoint& from, const std::string& note);
  ~Results();
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  /// Appends one row to every series, in the order of the constructor, and updates the ledger.
  void append_history(const std::vector<std::vector<double>>& row, const core::Ledger& ledger);

  /// Writes a field file. `step`: number of accepted steps; `time` [s]; `notes`: root attributes.
  void write_fields(int step, double time, const std::vector<Field>& fields,
                    const std::vector<Curve>& curves, const std::vector<std::string>& notes);
  /// Writes one dataset into run.h5, or replaces it.
  void write_table(const std::string& path, const std::vector<double>& values,
                   const std::string& units);
  /// Stores in the checkpoint what a run needs to continue with these files. Everything written so
  /// far is on the disk when the call returns.
  void fill_in(Checkpoint& checkpoint) const;
  const std::string& folder() const { return folder_.path(); }
  void close();

  /// Messages about the folder for the log, one line each.
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  std::string run_file() const { return folder_.path() + "/run.h5"; }
  void write_mesh(base::H5File& file, const mesh::Mesh& mesh) const;
  void add_series(base::H5File& file) const;
  void place(base::H5File& file);
  void make_room();
  std::vector<base::SeriesPlace> places_in(const base::H5File& old, const std::string& bytes);
  void take_over(const base::H5File& old, const std::vector<base::SeriesPlace>& old_places,
                 const std::string& note);
  void write_frames();

  OutputFolder folder_;
  std::vector<std::string> remarks_;
  std::string id_;  ///< run id; a checkpoint recognises its run.h5 by it
  std::vector<Series> series_;
  XdmfMesh mesh_;
  std::vector<XdmfFrame> frames_;
  std::size_t shown_ = 0;  ///< number of frames in run.xdmf
  std::uint64_t rows_ = 0, room_ = 0;
  base::Descriptor run_;
  std::vector<base::SeriesPlace> places_;
  std::vector<std::uint64_t> ledger_places_;
};

}  // namespace trocar::io
