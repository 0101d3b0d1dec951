#include "io/results.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/failure.hpp"
#include "core/fnv.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::io {
namespace {

/// Upper limit of the history rows for which run.h5 has room at the start. More room could be
/// wasted, because runs may be stopped long before the end.
constexpr std::size_t most_ahead = 4096;

template <class Number>
std::string_view bytes_of(const Number* first, std::size_t count)
{
  return {reinterpret_cast<const char*>(first), count * sizeof(Number)};
}

std::vector<std::int64_t> as_integers(const std::vector<double>& values)
{
  return {values.begin(), values.end()};
}

}  // namespace

Results::Results(const std::string& folder, const mesh::Mesh& mesh, const Provenance& provenance,
                 const std::vector<Series>& series, std::size_t rows)
    : folder_(folder),
      series_(series),
      mesh_{mesh.x.size(), mesh.tets.size(), mesh.nodes_per_tet()},
      room_(std::clamp<std::size_t>(rows, 1, most_ahead))
{
  base::H5File file = base::H5File::create(run_file());
  file.attribute("/", "schema", std::string("trocar-1"));
  write_mesh(file, mesh);
  core::Fnv1a id;
  for (const auto& [name, text] : provenance.texts) {
    file.write_text("/provenance/" + name, text);
    id.add(text);
  }
  id.add(std::to_string(::getpid()));
  id_ = id.hex();
  file.write_text("/provenance/run_id", id_);
  for (const auto& [name, words] : provenance.tables)
    file.write_words("/provenance/" + name, words);
  add_series(file);
  file.make_group("/ledger");
  for (const auto& [name, count] : core::Ledger().entries())
    file.attribute("/ledger", std::string(name), count);
  place(file);
  folder_.clear();  // last, so that old results survive when the disk is full
  if (!folder_.remark().empty()) remarks_.push_back(folder_.remark());
}

Results::~Results()
{
  try {
    write_frames();
  } catch (const core::Failure&) {  // a destructor must not throw
  }
}

void Results::add_series(base::H5File& file) const
{
  for (const Series& one : series_) {
    file.create_series("/history/" + one.name, one.columns, room_, one.units);
    if (!one.old_name.empty()) file.link("/history/" + one.name, "/history/" + one.old_name);
  }
}

/// Replaces run.h5 by `file` and opens it, so that rows and counts can be written in place.
void Results::place(base::H5File& file)
{
  places_.clear();
  std::string bytes = file.bytes();
  for (const Series& one : series_)
    places_.push_back(file.series_place("/history/" + one.name, one.columns, bytes));
  ledger_places_.clear();
  for (const auto& [name, count] : core::Ledger().entries())
    ledger_places_.push_back(file.attribute_place("/ledger", std::string(name), bytes));
  for (const base::SeriesPlace& one : places_)
    std::memcpy(bytes.data() + one.rows, &rows_, sizeof rows_);
  base::replace_file(run_file(), bytes);
  run_ = base::Descriptor(run_file(), O_RDWR);
}

void Results::write_mesh(base::H5File& file, const mesh::Mesh& mesh) const
{
  std::vector<double> x;
  for (const auto& p : mesh.x) x.insert(x.end(), p.data(), p.data() + 3);
  std::vector<std::int64_t> tets;
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int node : mesh::nodes_of(mesh, t)) tets.push_back(node);
  file.write("/mesh/coordinates", x, 3, "m");
  file.write("/mesh/tets", tets, static_cast<std::size_t>(mesh_.nodes_per_tet), "1");
  file.write("/mesh/region", std::vector<std::int64_t>(mesh.region.begin(), mesh.region.end()), 0,
             "1");
  file.write("/mesh/node_tag",
             std::vector<std::int64_t>(mesh.node_tag.begin(), mesh.node_tag.end()), 0, "1");
  file.write("/mesh/elem_tag",
             std::vector<std::int64_t>(mesh.elem_tag.begin(), mesh.elem_tag.end()), 0, "1");
  file.write_words("/mesh/volumes", mesh.volumes);
  if (!mesh.file_of.empty()) file.write_words("/mesh/file", mesh.file_of);
}

/// Rewrites run.h5 with room for twice as many rows.
void Results::make_room()
{
  const base::H5File old = base::H5File::of_bytes(run_file(), run_.read_at(0, run_.size()));
  room_ *= 2;
  take_over(old, places_, "");
}

void Results::append_history(const std::vector<std::vector<double>>& row,
                             const core::Ledger& ledger)
{
  for (std::size_t i = 0; i < series_.size(); ++i)
    base::refuse_nan(row[i], "/history/" + series_[i].name);
  if (rows_ == room_) make_room();
  for (std::size_t i = 0; i < series_.size(); ++i)
    run_.write_at(places_[i].data + rows_ * places_[i].columns * sizeof(double),
                  bytes_of(row[i].data(), row[i].size()));
  ++rows_;
  for (const base::SeriesPlace& one : places_) run_.write_at(one.rows, bytes_of(&rows_, 1));
  std::size_t i = 0;
  for (const auto& [name, count] : ledger.entries()) {
    const std::int64_t value = count;
    run_.write_at(ledger_places_[i++], bytes_of(&value, 1));
  }
}

void Results::write_fields(int step, double time, const std::vector<Field>& fields,
                           const std::vector<Curve>& curves, const std::vector<std::string>& notes)
{
  const std::string path = folder_.path() + "/" + step_file(step);
  auto file = base::H5File::create(path);
  XdmfFrame frame{step, time, {}, {}};
  for (const Field& field : fields) {
    if (field.integer)
      file.write(field.name, as_integers(field.values), field.columns, field.units);
    else
      file.write(field.name, field.values, field.columns, field.units);
    if (field.nodal || field.cell)
      frame.attributes.push_back({field.name, field.columns, field.cell});
  }
  for (const Curve& curve : curves) {
    const std::size_t points = curve.points.size() / 3;
    file.write(curve.name + "/axis", curve.points, 3, "m");
    file.write(curve.name + "/radius", std::vector<double>(points, curve.radius), 0, "m");
    frame.curves.push_back({curve.name, points});
  }
  file.write("/time", std::vector<double>{time}, 0, "s");
  for (const std::string& note : notes) file.attribute("/", note, std::int64_t{1});
  base::replace_file(path, file.bytes());
  frames_.push_back(std::move(frame));
  // Writing run.xdmf after every frame would cost the square of the number of frames. Beyond
  // `at_once` frames it is written when their number has grown by 1/`part`, and at the end. If the
  // run is killed, the last frames may be missing in run.xdmf.
  constexpr std::size_t at_once = 64, part = 8;
  if (frames_.size() <= at_once || frames_.size() >= shown_ + shown_ / part) write_frames();
}

void Results::write_frames()
{
  if (shown_ == frames_.size()) return;
  base::replace_file(folder_.path() + "/run.xdmf", xdmf_text(mesh_, frames_));
  shown_ = frames_.size();
}

void Results::write_table(const std::string& path, const std::vector<double>& values,
                          const std::string& units)
{
  base::H5File file = base::H5File::of_bytes(run_file(), run_.read_at(0, run_.size()));
  if (file.has(path)) file.remove(path);  // from the earlier run that this run continues
  file.write(path, values, 0, units);
  place(file);
}

void Results::close()
{
  write_frames();
  run_.sync();
}

}  // namespace trocar::io
