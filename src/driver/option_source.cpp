#include "driver/option_source.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

#include "base/files.hpp"
#include "core/option_text.hpp"
#include "core/words.hpp"
#include "driver/option_list.hpp"
#include "driver/petsc_options.hpp"

namespace trocar::driver {
namespace {

namespace fs = std::filesystem;
using core::WrittenOption;

constexpr std::uintmax_t largest_file = 16'000'000;  ///< limit for options files and CSV files [B]

/// The text of a file. Throws a Failure with exit code `code` when it cannot be read; its line
/// begins with `before`.
std::string text_of(const std::string& file, const std::string& before, core::ExitCode code)
{
  const auto failure = [&](const std::string& why) {
    return core::Failure(code, before + why + " '" + core::printable(file) + "'");
  };
  std::error_code trouble;
  const fs::file_status status = fs::status(file, trouble);
  if (!fs::exists(status)) throw failure("no such file");
  if (!fs::is_regular_file(status)) throw failure("this is no file that can be read:");
  if (fs::file_size(file, trouble) > largest_file) throw failure("too large (16 MB at most):");
  std::optional<std::string> text = base::contents_of(file);
  if (!text) throw failure("this cannot be read:");
  return std::move(*text);
}

/// Path of a file that an option names: in the working folder, else in `beside`, the folder of the
/// options file. Returns `file` itself when it is in neither.
std::string found(const std::string& file, const fs::path& beside)
{
  std::error_code ignored;
  if (file.empty() || fs::exists(file, ignored)) return file;
  const fs::path other = beside / file;
  return !beside.empty() && fs::exists(other, ignored) ? other.string() : file;
}

const core::OptionSpec* row_of(const std::string& name)
{
  for (const core::OptionSpec& spec : option_table())
    if (core::matches(spec, name)) return &spec;
  return nullptr;
}

/// The present name of an option. Old names of renamed options are accepted for one version.
std::string present_name(const std::string& name)
{
  if (name == "edges") return "conduits";
  return name.rfind("edge_", 0) == 0 ? "conduit_" + name.substr(5) : name;
}

/// Collects the options of all sources. A later call replaces values of earlier calls, so the
/// source with the lowest precedence comes first.
class Collector
{
 public:
  explicit Collector(Invocation& invocation) : invocation_(invocation) {}

  /// Takes the options in the files that `options` names. Files have the lowest precedence, so call
  /// this for all sources before the first `take`.
  void files_of(const std::vector<WrittenOption>& options)
  {
    for (const WrittenOption& one : options)
      if (one.name == "options_file") include(one, {});
  }
  void take(const std::vector<WrittenOption>& options, const std::string& source,
            const fs::path& beside = {})
  {
    for (const WrittenOption& one : options)
      if (one.name != "options_file") take(one, source, beside);
  }
  const std::vector<WrittenOption>& petsc() const { return petsc_; }

 private:
  void take(const WrittenOption& as_written, const std::string& source, const fs::path& beside)
  {
    WrittenOption one = as_written;
    one.name = present_name(one.name);
    if (one.name != as_written.name) invocation_.outdated.push_back(as_written.name);
    const core::OptionSpec* const row = row_of(one.name);
    if (!row) {
      petsc_.push_back(one);
      return;
    }
    std::string value = core::value_of(one, row->type == core::OptionType::vector);
    if (row->type == core::OptionType::file) value = found(value, beside);
    invocation_.given[one.name] = {value, source, one.place};
  }

  void include(const WrittenOption& one, const fs::path& beside)
  {
    const std::string name = core::value_of(one, false);
    if (name.empty()) throw core::option_error(core::label_of(one) + ": a file name must follow");
    const std::string file = found(name, beside);
    const std::string text = text_of(file, core::label_of(one) + ": ", core::ExitCode::options);
    std::error_code ignored;
    const fs::path path = fs::canonical(file, ignored);
    if (std::find(open_.begin(), open_.end(), path) != open_.end())
      throw core::option_error(core::label_of(one) + ": '" + core::printable(file) +
                               "' includes itself");
    constexpr int most_files = 100;
    if (++files_ > most_files)
      throw core::option_error(core::label_of(one) + ": more than 100 options files");
    open_.push_back(path);
    invocation_.options_file += (invocation_.options_file.empty() ? "" : ",") + file;
    invocation_.options_file_text += text;
    const fs::path folder = fs::path(file).parent_path();
    for (const WrittenOption& inner : core::parse_option_text(text, file))
      inner.name == "options_file" ? include(inner, folder) : take(inner, "options file", folder);
    open_.pop_back();
  }

  Invocation& invocation_;
  std::vector<WrittenOption> petsc_;
  std::vector<fs::path> open_;  ///< files that are being read; a file may not include itself
  int files_ = 0;               ///< number of options files read
};

void collect(Invocation& invocation)
{
  const char* const variable = std::getenv("PETSC_OPTIONS");
  std::istringstream cells(variable ? variable : "");
  std::vector<std::string> words;
  for (std::string word; cells >> word;) words.push_back(word);
  const auto environment = core::parse_option_words(words, variable ? "PETSC_OPTIONS" : "");
  words = invocation.arguments;
  if (!words.empty()) words.erase(words.begin());  // the program's name
  const auto arguments = core::parse_option_words(words, "");
  Collector all(invocation);
  all.files_of(environment);
  all.files_of(arguments);
  all.take(environment, "PETSC_OPTIONS");
  all.take(arguments, "command line");
  invocation.petsc = petsc_arguments(all.petsc());
}

void broadcast(Invocation& invocation, const base::Comm& comm)
{
  std::vector<std::string> cells;
  for (const auto& [name, value] : invocation.given)
    cells.insert(cells.end(), {name, value.value, value.source, value.place});
  comm.broadcast(cells);
  for (std::size_t i = 0; i + 3 < cells.size(); i += 4)
    invocation.given[cells[i]] = {cells[i + 1], cells[i + 2], cells[i + 3]};
  comm.broadcast(invocation.petsc);
  comm.broadcast(invocation.outdated);
  comm.broadcast(invocation.options_file);
  comm.broadcast(invocation.options_file_text);
}

}  // namespace

Invocation read_invocation(int argc, char** argv, const base::Comm& comm)
{
  Invocation invocation;
  for (int i = 0; i < argc; ++i) invocation.arguments.emplace_back(argv[i]);
  base::on_root(comm, [&] { collect(invocation); });
  broadcast(invocation, comm);
  return invocation;
}

std::string read_bytes(const std::string& file, const base::Comm& comm)
{
  std::string text;
  base::on_root(comm, [&] { text = text_of(file, "", core::ExitCode::data); });
  comm.broadcast(text);
  return text;
}

core::Csv read_csv(const std::string& file, const base::Comm& comm)
{
  return core::parse_csv(read_bytes(file, comm), file);
}

}  // namespace trocar::driver
