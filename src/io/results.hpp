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
  std::string old_name{};  ///< that a link keeps for readers of older files; "" without one
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
/// Lives on rank 0 alone; every call throws Failure (74) there. Whatever the moment at which a run
/// is killed or its disk is full, every step that was written before opens: run.h5 has room for
/// rows ahead, into which their numbers go before their count does; all else is put in place whole.
class Results
{
 public:
  /// `rows`: expected in the histories, which room is made for; more may come.
  Results(const std::string& folder, const mesh::Mesh& mesh, const Provenance& provenance,
          const std::vector<Series>& series, std::size_t rows = 1);
  /// Goes on in the folder of an earlier run after the last of its rows that a checkpoint knows.
  /// Later rows and field files are cut off. Failure (65) where run.h5 is not the one that the
  /// checkpoint was made with, (74) where it cannot be written again. `note` is kept in it.
  Results(const std::string& folder, const mesh::Mesh& mesh, const std::vector<Series>& series,
          const Checkpoint& from, const std::string& note);
  ~Results();
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  /// One row in every series, in the order they were declared.
  void append_history(const std::vector<std::vector<double>>& row, const core::Ledger& ledger);

  /// A field file for this time; `step` counts accepted steps.
  void write_fields(int step, double time, const std::vector<Field>& fields,
                    const std::vector<Curve>& curves, const std::vector<std::string>& notes);
  /// A dataset of its own in run.h5.
  void write_table(const std::string& path, const std::vector<double>& values,
                   const std::string& units);
  /// Fills in what a run needs to go on with these files; they are on the disk when it returns.
  void fill_in(Checkpoint& checkpoint) const;
  const std::string& folder() const { return folder_.path(); }
  void close();

  /// What is to be said of the folder, one line each.
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
  std::string id_;  ///< of the run, by which a checkpoint knows its run.h5
  std::vector<Series> series_;
  XdmfMesh mesh_;
  std::vector<XdmfFrame> frames_;
  std::size_t shown_ = 0;  ///< frames that run.xdmf has
  std::uint64_t rows_ = 0, room_ = 0;
  base::Descriptor run_;
  std::vector<base::SeriesPlace> places_;
  std::vector<std::uint64_t> ledger_places_;
};

}  // namespace trocar::io
