#include "driver/restart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string_view>

#include "base/files.hpp"
#include "core/fnv.hpp"
#include "core/words.hpp"
#include "driver/option_list.hpp"

namespace trocar::driver {
namespace {

bool begins(std::string_view name, std::string_view with)
{
  return name.substr(0, with.size()) == with;
}

bool ends(std::string_view name, std::string_view with)
{
  return name.size() >= with.size() && name.substr(name.size() - with.size()) == with;
}

/// Options that may differ in every restart: output, tolerances, solvers and the length of the run.
/// They change neither the meaning of the state nor the list of histories.
bool may_always_change(std::string_view name)
{
  if (name == "constraint_compare" || name == "compliance_stale_error") return false;
  constexpr std::array families{"output_dir",  "output_every", "output_fields", "checkpoint_",
                                "restart",     "time_end",     "time_wall",     "newton_tolerance",
                                "constraint_", "compliance_",  "error_",        "locking_gauge",
                                "check",       "quiet"};
  if (std::any_of(families.begin(), families.end(),
                  [&](const char* family) { return begins(name, family); }))
    return true;
  constexpr std::array of_cavities{"_solver", "_tolerance", "_gain", "_max_updates", "_alarm"};
  return begins(name, "cavity_") && std::any_of(of_cavities.begin(), of_cavities.end(),
                                                [&](const char* one) { return ends(name, one); });
}

/// Options that may also differ in a branch: how needles move on from where they are.
bool may_branch(std::string_view name)
{
  constexpr std::array motion{"_velocity", "_depth", "_hold", "_trajectory"};
  return begins(name, "needle_") && std::any_of(motion.begin(), motion.end(),
                                                [&](const char* one) { return ends(name, one); });
}

core::OptionType type_of(const std::string& name)
{
  for (const core::OptionSpec& spec : option_table())
    if (core::matches(spec, name)) return spec.type;
  return core::OptionType::text;
}

/// Canonical form of a value, the same for equal values: flags as "true" or "false", numbers in
/// hexadecimal.
std::vector<std::string> plain(const io::Checkpoint::Option& option)
{
  if (type_of(option.name) == core::OptionType::flag) {
    const std::string& value = option.value;
    return {value == "false" || value == "0" || value == "no" ? "false" : "true"};
  }
  std::vector<std::string> words = core::split(option.value, ',');
  for (std::string& word : words) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (!word.empty() && *end == '\0') {
      std::ostringstream text;
      text << std::hexfloat << number;
      word = text.str();
    }
  }
  return words;
}

/// True when the values are equal, or the contents of the files that they name.
bool same(const io::Checkpoint::Option& one, const io::Checkpoint::Option& other)
{
  if (!one.hash.empty() || !other.hash.empty()) return one.hash == other.hash;
  return plain(one) == plain(other);
}

core::Failure refused(const io::Checkpoint::Option& was, const io::Checkpoint::Option& is)
{
  const auto shown = [](const std::string& value) {
    return "'" + core::printable(value, 60) + "'";
  };
  const std::string how = was.value == is.value
                              ? "; the file " + shown(is.value) + " has changed"
                              : "; it was " + shown(was.value) + ", now it is " + shown(is.value);
  return core::option_error(
      "option -" + is.name + ": a run cannot go on with another one" +
      (may_branch(is.name) ? " (-restart_from, into another folder, can)" : "") + how);
}

/// Throws Failure (64) for an option that differs but must not. First come the options that both
/// runs have: a difference in them is mostly the cause when only one run has some other option.
void refuse_other_options(const io::Checkpoint& from,
                          const std::vector<io::Checkpoint::Option>& now, bool branch)
{
  const auto may_change = [&](const std::string& name) {
    return may_always_change(name) || (branch && may_branch(name));
  };
  std::map<std::string, io::Checkpoint::Option> before;
  for (const io::Checkpoint::Option& one : from.options) before[one.name] = one;
  for (const io::Checkpoint::Option& is : now) {
    const auto was = before.find(is.name);
    if (was != before.end() && !same(was->second, is) && !may_change(is.name))
      throw refused(was->second, is);
  }
  for (const io::Checkpoint::Option& is : now)
    if (before.erase(is.name) == 0 && !may_change(is.name)) throw refused({}, is);
  for (const auto& [name, was] : before)
    if (!may_change(name)) throw refused(was, {name, "", ""});
}

/// True when two paths lead to the same folder. The folder need not exist.
bool one_folder(const std::string& a, const std::string& b)
{
  std::error_code ignored;
  const auto resolved = [&](const std::string& path) {
    std::filesystem::path found = std::filesystem::weakly_canonical(path, ignored);
    if (!found.has_filename()) found = found.parent_path();
    return found;
  };
  return std::filesystem::equivalent(a, b, ignored) || resolved(a) == resolved(b);
}

}  // namespace

RestartSettings read_restart_settings(core::Options& options, std::string& output_folder)
{
  const auto folder = [&](const std::string& name) {
    const std::string value = options.text(name);
    if (value.empty())
      throw core::option_error("option -" + name + ": the name of a folder is missing");
    return value == "none" ? std::string() : value;
  };
  const std::string same = folder("restart"), from = folder("restart_from");
  const bool given = options.given("output_dir");
  if (!same.empty() && given && !one_folder(output_folder, same))
    throw core::option_error("option -output_dir: -restart " + core::printable(same, 100) +
                             " goes on in that folder; -restart_from starts another one");
  if (same.empty() && !from.empty() && one_folder(output_folder, from))
    throw core::option_error("option -restart_from: the results would replace those of " +
                             core::printable(from, 100) + "; give another -output_dir");
  if (same.empty()) return {from, !from.empty()};
  output_folder = same;
  return {same, false};
}

std::vector<io::Checkpoint::Option> options_with_hashes(
    const std::vector<core::ResolvedOption>& resolved, const mesh::Mesh& mesh)
{
  std::vector<io::Checkpoint::Option> options;
  for (const core::ResolvedOption& one : resolved) {
    options.push_back({one.name, one.value, ""});
    if (one.value.empty() || type_of(one.name) != core::OptionType::file) continue;
    options.back().hash =
        one.name == "mesh" ? mesh.hash : core::fnv1a(base::contents_of(one.value).value_or(""));
  }
  return options;
}

io::Checkpoint read_restart(const Scenario& scenario,
                            const std::vector<core::ResolvedOption>& resolved,
                            const base::Comm& comm)
{
  io::Checkpoint from;
  base::on_root(comm, [&] {
    from = io::read_checkpoint(scenario.restart.folder);
    refuse_other_options(from, options_with_hashes(resolved, scenario.mesh),
                         scenario.restart.branch);
  });
  io::Checkpoint::Time& time = from.time;
  std::vector<double> seconds{time.now, time.step, time.end};
  std::vector<long long> counts{time.nominal, time.accepted};
  std::vector<std::string> names;
  for (const auto& [name, count] : from.ledger) {
    names.push_back(name);
    counts.push_back(count);
  }
  comm.broadcast(seconds);
  comm.broadcast(counts);
  comm.broadcast(names);
  time = {seconds[0], seconds[1], seconds[2], counts[0], counts[1]};
  from.ledger.clear();
  for (std::size_t i = 0; i < names.size(); ++i) from.ledger.emplace_back(names[i], counts[2 + i]);
  return from;
}

bool continue_time(const io::Checkpoint::Time& from, Scenario& scenario)
{
  step::TimeSettings& time = scenario.time;
  const double wanted = time.end;
  if (wanted == from.end) {  // unchanged end: the same steps as before
    time.step = from.step;
    return from.nominal < step::step_count(time);
  }
  constexpr double whole = 1e-6;
  const double ratio = wanted / from.step;
  const double steps = std::ceil(ratio - whole);
  if (steps < static_cast<double>(from.nominal))
    throw core::option_error("option -time_end: " + core::shown(wanted) +
                             " s lies before the checkpoint, t = " + core::shown(from.now) + " s");
  time.step = time.asked = from.step;
  time.end = steps * from.step;
  std::erase_if(scenario.warnings, [](const std::string& one) { return begins(one, "-time_end"); });
  if (std::abs(ratio - steps) > whole)
    scenario.warnings.push_back(
        "-time_end " + core::shown(wanted) + " is no whole number of the checkpoint's steps of " +
        core::shown(from.step) + " s: the run ends at t = " + core::shown(time.end) + " s");
  return from.nominal < step::step_count(time);
}

void refuse_jumps(const std::vector<needle::NeedleSettings>& needles, const step::State& state)
{
  constexpr double of_length = 1e-9, of_turn = 1e-9;
  for (std::size_t i = 0; i < needles.size(); ++i) {
    const needle::BaseMotion& motion = needles[i].motion;
    const needle::Shaft& shaft = state.needles.at(i).shaft;
    const needle::Pose base = motion.at(state.t);
    const double jump = (base.x - shaft.x.front()).norm();
    const double turn = (base.R - shaft.R.front()).norm();
    if (jump <= of_length * motion.length && turn <= of_turn) continue;
    throw core::option_error("option -restart_from: needle '" + needles[i].name +
                             "' would jump by " + core::shown(jump) + " m and turn by " +
                             core::shown(turn) + " at t = " + core::shown(state.t) +
                             " s, where the checkpoint is: its motion must go on from there");
  }
}

}  // namespace trocar::driver
