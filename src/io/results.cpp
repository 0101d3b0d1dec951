#include "io/results.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/failure.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::io {
namespace {

namespace fs = std::filesystem;

void prepare_folder(const std::string& folder)
{
  std::error_code error;
  fs::create_directories(folder + "/fields", error);
  if (error) throw core::output_error("cannot make folder " + folder + ": " + error.message());
  // Steps of an earlier run would mix with ours in ParaView.
  for (const auto& entry : fs::directory_iterator(folder + "/fields", error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("step_", 0) == 0) fs::remove(entry.path(), error);
  }
  if (error) throw core::output_error("cannot clear " + folder + "/fields: " + error.message());
}

void rename_into_place(const std::string& from, const std::string& to)
{
  if (std::rename(from.c_str(), to.c_str()) != 0)
    throw core::output_error("cannot rename " + from + " to " + to);
  const fs::path folder = fs::path(to).parent_path();
  base::sync_to_disk(folder.empty() ? "." : folder.string());
}

std::vector<std::int64_t> as_integers(const std::vector<double>& values)
{
  return {values.begin(), values.end()};
}

}  // namespace

void write_atomically(const std::string& path, const std::string& text)
{
  const std::string temporary = path + ".tmp";
  std::ofstream stream(temporary);
  stream << text;
  stream.close();
  if (!stream) throw core::output_error("cannot write " + temporary);
  base::sync_to_disk(temporary);
  rename_into_place(temporary, path);
}

Results::Results(const std::string& folder, const mesh::Mesh& mesh, const Provenance& provenance,
                 const std::vector<Series>& series)
    : folder_((prepare_folder(folder), folder)),
      run_(base::H5File::create(folder + "/run.h5")),
      series_(series),
      mesh_{mesh.x.size(), mesh.tets.size(), mesh.nodes_per_tet()}
{
  run_.attribute("/", "schema", std::string("trocar-1"));
  write_mesh(mesh);
  for (const auto& [name, text] : provenance.texts) run_.write_text("/provenance/" + name, text);
  for (const auto& [name, words] : provenance.tables)
    run_.write_words("/provenance/" + name, words);
  for (const Series& one : series_)
    run_.create_series("/history/" + one.name, one.columns, one.units);
  run_.make_group("/ledger");
  for (const auto& [name, count] : core::Ledger().entries())
    run_.attribute("/ledger", std::string(name), count);
  run_.flush();
}

void Results::write_mesh(const mesh::Mesh& mesh)
{
  std::vector<double> x;
  for (const auto& p : mesh.x) x.insert(x.end(), p.data(), p.data() + 3);
  std::vector<std::int64_t> tets;
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int node : mesh::nodes_of(mesh, t)) tets.push_back(node);
  run_.write("/mesh/coordinates", x, 3, "m");
  run_.write("/mesh/tets", tets, static_cast<std::size_t>(mesh_.nodes_per_tet), "1");
  run_.write("/mesh/region", std::vector<std::int64_t>(mesh.region.begin(), mesh.region.end()), 0,
             "1");
  run_.write("/mesh/node_tag",
             std::vector<std::int64_t>(mesh.node_tag.begin(), mesh.node_tag.end()), 0, "1");
  run_.write("/mesh/elem_tag",
             std::vector<std::int64_t>(mesh.elem_tag.begin(), mesh.elem_tag.end()), 0, "1");
  run_.write_words("/mesh/volumes", mesh.volumes);
}

void Results::append_history(const std::vector<std::vector<double>>& row,
                             const core::Ledger& ledger)
{
  for (std::size_t i = 0; i < series_.size(); ++i)
    run_.append("/history/" + series_[i].name, row[i]);
  for (const auto& [name, count] : ledger.entries())
    run_.attribute("/ledger", std::string(name), count);
  run_.flush();
}

void Results::write_fields(int step, double time, const std::vector<Field>& fields,
                           const std::vector<Curve>& curves, const std::vector<std::string>& notes)
{
  const std::string path = folder_ + "/" + step_file(step);
  auto file = base::H5File::create(path + ".tmp");
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
  file.close();
  rename_into_place(path + ".tmp", path);
  frames_.push_back(std::move(frame));
  write_atomically(folder_ + "/run.xdmf", xdmf_text(mesh_, frames_));
}

void Results::write_table(const std::string& path, const std::vector<double>& values,
                          const std::string& units)
{
  run_.write(path, values, 0, units);
  run_.flush();
}

void Results::close()
{
  run_.close();
}

}  // namespace trocar::io
