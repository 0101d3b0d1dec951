#include "driver/restart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>

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

/// Output, tolerances, how much is computed at once and how long: nothing that the state is of.
bool may_always_change(std::string_view name)
{
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

/// How needles move, from where they are.
bool may_branch(std::string_view name)
{
  constexpr std::array motion{"_velocity", "_depth", "_hold", "_trajectory"};
  return begins(name, "needle_") && std::any_of(motion.begin(), motion.end(),
                                                [&](const char* one) { return ends(name, one); });
}

bool names_file(const std::string& name)
{
  const std::vector<core::OptionSpec>& table = option_table();
  return std::any_of(table.begin(), table.end(), [&](const core::OptionSpec& spec) {
    return spec.type == core::OptionType::file && core::matches(spec, name);
  });
}

/// The same text, number or contents.
bool same(const io::Checkpoint::Option& one, const io::Checkpoint::Option& other)
{
  if (one.value == other.value && one.hash == other.hash) return true;
  if (!one.hash.empty() || !other.hash.empty()) return one.hash == other.hash;
  std::istringstream a(one.value), b(other.value);
  double x = 0.0, y = 0.0;
  return (a >> x) && (b >> y) && a.eof() && b.eof() && x == y;
}

void refuse_other_options(const io::Checkpoint& from,
                          const std::vector<io::Checkpoint::Option>& now, bool branch)
{
  std::map<std::string, std::pair<io::Checkpoint::Option, io::Checkpoint::Option>> both;
  for (const io::Checkpoint::Option& one : from.options) both[one.name].first = one;
  for (const io::Checkpoint::Option& one : now) both[one.name].second = one;
  for (const auto& [name, pair] : both) {
    const auto& [was, is] = pair;
    if (same(was, is) || may_always_change(name) || (branch && may_branch(name))) continue;
    const bool contents = was.value == is.value;
    const std::string with = may_branch(name) ? " (-restart_from, into another folder, can)" : "";
    throw core::option_error("option -" + name + ": a run cannot go on with another one" + with +
                             (contents
                                  ? "; the file " + core::printable(is.value, 60) + " has changed"
                                  : "; it was '" + core::printable(was.value, 60) +
                                        "', now it is '" + core::printable(is.value, 60) + "'"));
  }
}

}  // namespace

std::vector<io::Checkpoint::Option> options_with_hashes(
    const std::vector<core::ResolvedOption>& resolved)
{
  std::vector<io::Checkpoint::Option> options;
  for (const core::ResolvedOption& one : resolved) {
    options.push_back({one.name, one.value, ""});
    if (one.value.empty() || one.value == "\"\"" || !names_file(one.name)) continue;
    std::ifstream stream(one.value, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    options.back().hash = core::fnv1a(bytes.str());
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
    refuse_other_options(from, options_with_hashes(resolved), scenario.restart.branch);
  });
  io::Checkpoint::Time& time = from.time;
  std::vector<double> seconds{time.now, time.step, time.asked, time.end};
  std::vector<long long> counts{time.nominal, time.accepted};
  std::vector<std::string> names;
  for (const auto& [name, count] : from.ledger) {
    names.push_back(name);
    counts.push_back(count);
  }
  comm.broadcast(seconds);
  comm.broadcast(counts);
  comm.broadcast(names);
  time = {seconds[0], seconds[1], seconds[2], seconds[3], counts[0], counts[1]};
  from.ledger.clear();
  for (std::size_t i = 0; i < names.size(); ++i) from.ledger.emplace_back(names[i], counts[2 + i]);
  return from;
}

void continue_time(const io::Checkpoint::Time& from, Scenario& scenario)
{
  step::TimeSettings& time = scenario.time;
  const double wanted = time.end;
  if (wanted == from.end) {  // the very same steps
    time.step = from.step;
    return;
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
