#include "io/checkpoint.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "base/files.hpp"
#include "base/hdf5.hpp"
#include "core/failure.hpp"
#include "core/fnv.hpp"

namespace trocar::io {
namespace {

constexpr const char* manifest_name = "checkpoint.txt";
constexpr const char* turns[] = {"checkpoint_a.h5", "checkpoint_b.h5"};
constexpr const char* format = "trocar-checkpoint-1";

/// Contents of checkpoint.txt: which of the two files is the last complete checkpoint.
struct Manifest
{
  std::string file;
  std::uint64_t bytes = 0;
  std::string sum;  ///< FNV-1a of the bytes of `file`
};

std::string text_of(const Manifest& manifest, const Checkpoint::Time& time)
{
  std::ostringstream text;
  text.precision(17);
  text << "format " << format << "\nfile " << manifest.file << "\nbytes " << manifest.bytes
       << "\nfnv1a " << manifest.sum << "\nstep " << time.nominal << "\ntime " << time.now << "\n";
  return text.str() + "above " + core::fnv1a(text.str()) + "\n";
}

core::Failure damaged(const std::string& path, const std::string& what)
{
  return core::data_error(path + ": " + what);
}

std::string contents(const std::string& path)
{
  std::optional<std::string> bytes = base::contents_of(path);
  if (!bytes) throw damaged(path, "cannot be read");
  return std::move(*bytes);
}

/// Reads checkpoint.txt. Failure (65) unless its own checksum, its format and the file name in it
/// are right.
Manifest manifest_of(const std::string& path)
{
  const std::string text = contents(path);
  const std::size_t end = text.rfind("above ");
  if (text.rfind("format ", 0) != 0) throw damaged(path, "is no list of a checkpoint");
  if (end == std::string::npos ||
      text.substr(end) != "above " + core::fnv1a({text.data(), end}) + "\n")
    throw damaged(path, "is damaged: its own sum is another");
  std::map<std::string, std::string> values;
  std::istringstream lines(text.substr(0, end));
  for (std::string name, value; lines >> name >> value;) values[name] = value;
  if (values["format"] != format)
    throw damaged(path, "is of the format " + values["format"] + "; this program reads " + format);
  Manifest manifest{values["file"], 0, values["fnv1a"]};
  std::istringstream(values["bytes"]) >> manifest.bytes;
  if (manifest.file != turns[0] && manifest.file != turns[1])
    throw damaged(path, "names a file that is no checkpoint");
  return manifest;
}

/// One frame as a line of words separated by tabs. No name contains a tab.
std::string line_of(const XdmfFrame& frame)
{
  std::ostringstream text;
  text.precision(17);
  text << frame.step << '\t' << frame.time << '\t' << frame.attributes.size();
  for (const XdmfFrame::Attribute& one : frame.attributes)
    text << '\t' << one.name << '\t' << one.columns << '\t' << one.cell;
  for (const XdmfFrame::Curve& one : frame.curves) text << '\t' << one.name << '\t' << one.points;
  return text.str();
}

XdmfFrame frame_of(const std::string& line)
{
  std::vector<std::string> words;
  std::istringstream text(line);
  for (std::string word; std::getline(text, word, '\t');) words.push_back(word);
  std::size_t at = 0;
  const auto next = [&]() -> const std::string& { return words.at(at++); };
  XdmfFrame frame{};
  frame.step = std::stoi(next());
  frame.time = std::stod(next());
  for (std::size_t left = std::stoul(next()); left > 0; --left) {
    const std::string& name = next();
    const std::size_t columns = std::stoul(next());
    frame.attributes.push_back({name, columns, next() == "1"});
  }
  while (at < words.size()) {
    const std::string& name = next();
    frame.curves.push_back({name, std::stoul(next())});
  }
  return frame;
}

std::vector<std::int64_t> wide(const std::vector<long long>& values)
{
  return {values.begin(), values.end()};
}

void write_state(base::H5File& file, const core::Archive& state)
{
  file.write_words("/state/names", state.names);
  file.write("/state/whole", wide(state.whole), 0, "1");
  file.write("/state/real", state.real, 0, "1");
  std::vector<std::string> fields, units;
  for (const core::Archive::Field& field : state.fields) {
    fields.push_back(field.name);
    units.push_back(field.unit);
    file.write("/field/" + field.name, field.values, 0, field.unit);
  }
  file.write_words("/state/fields", fields);
  file.write_words("/state/units", units);
}

core::Archive read_state(const base::H5File& file)
{
  core::Archive state;
  state.names = file.read_words("/state/names");
  const std::vector<std::int64_t> whole = file.read_integers("/state/whole");
  state.whole.assign(whole.begin(), whole.end());
  state.real = file.read_reals("/state/real");
  const auto fields = file.read_words("/state/fields"), units = file.read_words("/state/units");
  for (std::size_t i = 0; i < fields.size(); ++i)
    state.fields.push_back({fields[i], units.at(i), file.read_reals("/field/" + fields[i])});
  return state;
}

std::string file_of(const Checkpoint& all, const std::string& path)
{
  base::H5File file = base::H5File::create(path);
  file.attribute("/", "schema", std::string(format));
  file.write_text("/run/version", all.version);
  std::vector<std::string> names, values, hashes, frames, ledger;
  for (const Checkpoint::Option& one : all.options) {
    names.push_back(one.name);
    values.push_back(one.value);
    hashes.push_back(one.hash);
  }
  file.write_words("/run/option/name", names);
  file.write_words("/run/option/value", values);
  file.write_words("/run/option/hash", hashes);
  const Checkpoint::Time& time = all.time;
  file.write("/run/time", std::vector<double>{time.now, time.step, time.end}, 0, "s");
  file.write("/run/steps", wide({time.nominal, time.accepted}), 0, "1");
  file.write("/run/file/size", wide({all.run.bytes, all.run.rows, all.run.room}), 0, "1");
  file.write_words("/run/file/id_sum", {all.run.id, all.run.sum});
  file.write("/run/file/series", wide(all.run.series), 0, "1");
  file.write("/run/file/ledger", wide(all.run.ledger), 0, "1");
  std::vector<long long> counts;
  for (const auto& [name, count] : all.ledger) {
    ledger.push_back(name);
    counts.push_back(count);
  }
  file.write_words("/run/ledger/name", ledger);
  file.write("/run/ledger/count", wide(counts), 0, "1");
  for (const XdmfFrame& frame : all.frames) frames.push_back(line_of(frame));
  file.write_words("/run/frames", frames);
  write_state(file, all.state);
  return file.bytes();
}

Checkpoint checkpoint_of(const base::H5File& file)
{
  Checkpoint all;
  all.version = file.read_words("/run/version").at(0);
  const auto names = file.read_words("/run/option/name");
  const auto values = file.read_words("/run/option/value");
  const auto hashes = file.read_words("/run/option/hash");
  for (std::size_t i = 0; i < names.size(); ++i)
    all.options.push_back({names[i], values.at(i), hashes.at(i)});
  const std::vector<double> time = file.read_reals("/run/time");
  const std::vector<std::int64_t> steps = file.read_integers("/run/steps");
  all.time = {time.at(0), time.at(1), time.at(2), steps.at(0), steps.at(1)};
  const auto size = file.read_integers("/run/file/size");
  const auto series = file.read_integers("/run/file/series");
  const auto places = file.read_integers("/run/file/ledger");
  const auto words = file.read_words("/run/file/id_sum");
  all.run = {size.at(0),
             size.at(1),
             size.at(2),
             words.at(0),
             words.at(1),
             {series.begin(), series.end()},
             {places.begin(), places.end()}};
  const auto counted = file.read_words("/run/ledger/name");
  const auto counts = file.read_integers("/run/ledger/count");
  for (std::size_t i = 0; i < counted.size(); ++i)
    all.ledger.emplace_back(counted[i], counts.at(i));
  for (const std::string& line : file.read_words("/run/frames"))
    all.frames.push_back(frame_of(line));
  all.state = read_state(file);
  return all;
}

}  // namespace

bool names_checkpoint(const std::string& name)
{
  return name == manifest_name || name == turns[0] || name == turns[1];
}

void write_checkpoint(const std::string& folder, const Checkpoint& checkpoint)
{
  const std::string list = folder + "/" + manifest_name;
  std::string last;
  if (std::filesystem::exists(list)) last = manifest_of(list).file;
  Manifest manifest{last == turns[0] ? turns[1] : turns[0], 0, {}};
  const std::string path = folder + "/" + manifest.file;
  const std::string bytes = file_of(checkpoint, path);
  manifest.bytes = bytes.size();
  manifest.sum = core::fnv1a(bytes);
  base::replace_file(path, bytes);
  base::replace_file(list, text_of(manifest, checkpoint.time));
}

namespace {

/// The bytes of the file that checkpoint.txt (`list`) names. Failure (65) when size or checksum
/// differ from those in the manifest.
std::string good_bytes(const std::string& list, const Manifest& manifest, const std::string& path)
{
  std::string bytes = contents(path);
  if (bytes.size() != manifest.bytes)
    throw damaged(path, "has " + std::to_string(bytes.size()) + " bytes; " + list + " wants " +
                            std::to_string(manifest.bytes));
  if (core::fnv1a(bytes) != manifest.sum)
    throw damaged(path, "is damaged: its sum is not the one in " + list);
  return bytes;
}

}  // namespace

Checkpoint read_checkpoint(const std::string& folder)
{
  const std::string list = folder + "/" + manifest_name;
  if (!std::filesystem::exists(list))
    throw core::data_error("folder " + folder + " has no checkpoint (" + manifest_name + ")");
  Manifest manifest = manifest_of(list);
  const auto path = [&] { return folder + "/" + manifest.file; };
  std::string bytes;
  try {
    bytes = good_bytes(list, manifest, path());
  } catch (const core::Failure&) {  // another run may have written a new checkpoint meanwhile
    const std::string before = manifest.sum;
    manifest = manifest_of(list);
    if (manifest.sum == before) throw;
    bytes = good_bytes(list, manifest, path());
  }
  try {
    return checkpoint_of(base::H5File::of_bytes(path(), std::move(bytes)));
  } catch (const std::exception& error) {  // the checksum is right, the contents are not
    throw damaged(path(), std::string("is no checkpoint of this program (") + error.what() + ")");
  }
}

}  // namespace trocar::io
