#include <fcntl.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <filesystem>
#include <limits>

#include "core/failure.hpp"
#include "core/fnv.hpp"
#include "io/results.hpp"

// Results of a run that continues from a checkpoint, and the data of run.h5 that a checkpoint
// keeps.
namespace trocar::io {
namespace {

/// Sets bytes of a file to zero, so that the checksum does not depend on them. Failure (65) when
/// they lie beyond its end.
void blank(std::string& bytes, std::uint64_t from, std::uint64_t count)
{
  if (from > bytes.size() || count > bytes.size() - from)
    throw core::data_error("a place in it lies beyond its end");
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(from), count, '\0');
}

/// FNV-1a of run.h5 with zeros in place of all that changes after the checkpoint: row counts,
/// ledger counts, and the room for rows after `at.rows`.
std::string sum_of_what_stays(std::string bytes, const Checkpoint::RunFile& at)
{
  // Offset of the data [B], columns.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> histories;
  const auto place = [](long long number) { return static_cast<std::uint64_t>(number); };
  for (std::size_t i = 0; i + 2 < at.series.size(); i += 3) {
    blank(bytes, place(at.series[i + 1]), sizeof(std::uint64_t));
    histories.emplace_back(place(at.series[i]), place(at.series[i + 2]));
  }
  for (long long count : at.ledger) blank(bytes, place(count), sizeof(std::int64_t));
  const std::uint64_t rows = place(at.rows), room = place(at.room);
  for (const auto& [data, columns] : histories) {
    const std::uint64_t written = data + rows * columns * sizeof(double);
    blank(bytes, written, (room - std::min(room, rows)) * columns * sizeof(double));
  }
  return core::fnv1a(bytes);
}

}  // namespace

void Results::fill_in(Checkpoint& checkpoint) const
{
  run_.sync();
  Checkpoint::RunFile& run = checkpoint.run = {};
  run.id = id_;
  run.rows = static_cast<long long>(rows_);
  run.room = static_cast<long long>(room_);
  run.bytes = static_cast<long long>(run_.size());
  for (const base::SeriesPlace& one : places_)
    for (const std::uint64_t number : {one.data, one.rows, std::uint64_t{one.columns}})
      run.series.push_back(static_cast<long long>(number));
  run.ledger.assign(ledger_places_.begin(), ledger_places_.end());
  run.sum = sum_of_what_stays(run_.read_at(0, run_.size()), run);
  checkpoint.frames = frames_;
}

/// The places of the histories in the run.h5 of the checkpoint. Sets `room_`, and adds a remark
/// when rows after the checkpoint will be cut off. Failure (65) when a history is missing or too
/// short.
std::vector<base::SeriesPlace> Results::places_in(const base::H5File& old, const std::string& bytes)
{
  std::vector<base::SeriesPlace> places;
  std::uint64_t there = std::numeric_limits<std::uint64_t>::max();
  for (const Series& one : series_) {
    const std::string path = "/history/" + one.name;
    if (!old.has(path)) throw core::data_error("has no history " + one.name);
    places.push_back(old.series_place(path, one.columns, bytes));
    const base::SeriesPlace& place = places.back();
    std::uint64_t rows = 0;
    std::memcpy(&rows, bytes.data() + place.rows, sizeof rows);
    there = std::min(there, rows);
    if (there < rows_) throw core::data_error("ends before the checkpoint does");
  }
  if (there > rows_)
    remarks_.push_back(std::to_string(there - rows_) +
                       " steps after the checkpoint were cut off; they come again");
  room_ = std::max<std::uint64_t>(2 * rows_, there);
  return places;
}

Results::Results(const std::string& folder, const mesh::Mesh& mesh,
                 const std::vector<Series>& series, const Checkpoint& from, const std::string& note)
    : folder_(folder),
      series_(series),
      mesh_{mesh.x.size(), mesh.tets.size(), mesh.nodes_per_tet()},
      frames_(from.frames),
      rows_(static_cast<std::uint64_t>(from.run.rows))
{
  if (!folder_.remark().empty()) remarks_.push_back(folder_.remark());
  if (!std::filesystem::exists(run_file()))
    throw core::data_error(run_file() +
                           " is not there, with which a run goes on (-restart_from "
                           "does without)");
  run_ = base::Descriptor(run_file(), O_RDWR);
  const std::string bytes = run_.read_at(0, run_.size());
  const base::H5File old = [&] {
    try {
      // A file that was rewritten with more room since then has other bytes, so no sum can be
      // compared. This is rare: most files have enough room from the start.
      if (static_cast<long long>(bytes.size()) == from.run.bytes &&
          sum_of_what_stays(bytes, from.run) != from.run.sum)
        throw core::data_error("it is damaged");
      base::H5File file = base::H5File::of_bytes(run_file(), bytes);
      id_ = file.read_words("/provenance/run_id").at(0);
      if (id_ != from.run.id) throw core::data_error("it is of another run");
      places_ = places_in(file, bytes);
      return file;
    } catch (const std::exception& error) {
      throw core::data_error(run_file() + " is not that of the checkpoint: " + error.what());
    }
  }();
  take_over(old, places_, note);
  folder_.clear_after(from.time.accepted);
  write_frames();
}

/// Writes a new run.h5 with the contents of `old`, the first `rows_` rows of its histories and room
/// for `room_` rows. With a `note` (not empty) the run continues from a checkpoint: the note goes
/// to /provenance/restart_N, and tables that a run writes at its end are left out.
void Results::take_over(const base::H5File& old, const std::vector<base::SeriesPlace>& old_places,
                        const std::string& note)
{
  const std::vector<base::SeriesPlace> from = old_places;  // a copy: `old_places` may be `places_`
  base::H5File file = base::H5File::create(run_file());
  file.attribute("/", "schema", std::string("trocar-1"));
  for (const std::string& name : old.top()) {
    const bool told_at_the_end = name == "error_estimate" || name == "pv_curve";
    if (name != "history" && (note.empty() || !told_at_the_end)) file.copy(old, "/" + name);
  }
  if (!note.empty()) {
    int before = 1;
    while (file.has("/provenance/restart_" + std::to_string(before))) ++before;
    file.write_text("/provenance/restart_" + std::to_string(before), note);
  }
  add_series(file);
  std::string bytes = file.bytes();
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const base::SeriesPlace to =
        file.series_place("/history/" + series_[i].name, series_[i].columns, bytes);
    const std::size_t length = rows_ * to.columns * sizeof(double);
    std::memcpy(bytes.data() + to.data, run_.read_at(from[i].data, length).data(), length);
  }
  base::H5File filled = base::H5File::of_bytes(run_file(), std::move(bytes));
  place(filled);
}

}  // namespace trocar::io
