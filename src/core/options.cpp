#include "core/options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/failure.hpp"
#include "core/words.hpp"

namespace trocar::core {
namespace {

std::string with_group(const std::string& pattern, const std::string& group)
{
  const auto open = pattern.find('<');
  if (open == std::string::npos || group.empty()) return pattern;
  return pattern.substr(0, open) + group + pattern.substr(pattern.find('>') + 1);
}

/// `tissue_<volume>_young` falls back to `tissue_young`.
std::string without_group(const std::string& pattern)
{
  const auto open = pattern.find('<');
  if (open == std::string::npos) return pattern;
  return pattern.substr(0, open) + pattern.substr(pattern.find('>') + 2);
}

}  // namespace

bool matches(const OptionSpec& spec, const std::string& name, std::string* group)
{
  const auto open = spec.name.find('<');
  if (open == std::string::npos) return spec.name == name;
  const std::string head = spec.name.substr(0, open);
  const std::string tail = spec.name.substr(spec.name.find('>') + 1);
  if (name.size() <= head.size() + tail.size()) return false;
  if (name.compare(0, head.size(), head) != 0) return false;
  if (name.compare(name.size() - tail.size(), tail.size(), tail) != 0) return false;
  if (group) *group = name.substr(head.size(), name.size() - head.size() - tail.size());
  return true;
}

std::string range_text(const OptionSpec& spec)
{
  const bool low = std::isfinite(spec.low);
  const bool high = std::isfinite(spec.high);
  if (!low && !high) return "";
  if (low && high)
    return std::string(spec.low_open ? "(" : "[") + shown(spec.low) + ", " + shown(spec.high) +
           (spec.high_open ? ")" : "]");
  if (low) return std::string(spec.low_open ? "> " : ">= ") + shown(spec.low);
  return std::string(spec.high_open ? "< " : "<= ") + shown(spec.high);
}

Options::Options(const std::vector<OptionSpec>& table, std::map<std::string, OptionValue> given)
    : table_(table), given_(std::move(given))
{
}

const OptionSpec& Options::spec(const std::string& name) const
{
  for (const OptionSpec& spec : table_)
    if (spec.name == name) return spec;
  throw Failure(ExitCode::internal, "option -" + name + " is read but not in the table");
}

std::string Options::label(const std::string& name, const std::string& group) const
{
  const std::string full = with_group(name, group);
  const auto own = given_.find(full);
  const auto one = own != given_.end() ? own : given_.find(without_group(name));
  if (one == given_.end()) return without_group(name);
  const std::string& place = one->second.place;
  return one->first + (place.empty() ? "" : " (" + place + ")");
}

const std::string& Options::raw(const std::string& name, const std::string& group)
{
  const OptionSpec& row = spec(name);
  const std::string full = with_group(row.name, group);
  const std::string general = without_group(row.name);
  const auto has_name = [&](const OptionSpec& other) { return other.name == full; };
  if (full != row.name && full != general && std::any_of(table_.begin(), table_.end(), has_name))
    throw option_error("option -" + full + " would mean two things with a name of '" +
                       printable(group, 60) + "': choose another one");
  read_.insert(full);
  read_.insert(general);
  const auto own = given_.find(full);
  const auto inherited = own != given_.end() ? own : given_.find(general);
  static const OptionValue none;
  const bool found = inherited != given_.end();
  const std::string& value = found ? inherited->second.value : row.fallback;
  const bool recorded = std::any_of(resolved_.begin(), resolved_.end(),
                                    [&](const ResolvedOption& r) { return r.name == full; });
  if (!recorded)
    resolved_.push_back({full, value, row.unit, found ? inherited->second.source : "default"});
  return value;
}

double Options::number(const std::string& cell, const OptionSpec& row,
                       const std::string& label) const
{
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (cell.empty() || *end != '\0')
    throw option_error("option -" + label + ": '" + printable(cell, 60) + "' is not a number");
  if (!std::isfinite(value))
    throw option_error("option -" + label + ": '" + printable(cell, 60) + "' is not finite");
  const bool below = row.low_open ? value <= row.low : value < row.low;
  const bool above = row.high_open ? value >= row.high : value > row.high;
  if (below || above)
    throw option_error("option -" + label + ": " + cell + " is out of range, must be " +
                       range_text(row) + (row.unit.empty() ? "" : " [" + row.unit + "]"));
  return value;
}

double Options::real(const std::string& name, const std::string& group)
{
  return number(raw(name, group), spec(name), label(name, group));
}

int Options::integer(const std::string& name, const std::string& group)
{
  const std::string& value = raw(name, group);
  const double parsed = number(value, spec(name), label(name, group));
  if (parsed != std::floor(parsed) || std::abs(parsed) > 2e9)
    throw option_error("option -" + label(name, group) + ": '" + value + "' is no integer");
  return static_cast<int>(parsed);
}

bool Options::flag(const std::string& name, const std::string& group)
{
  const std::string& value = raw(name, group);
  if (value.empty() || value == "true" || value == "1" || value == "yes") return true;
  if (value == "false" || value == "0" || value == "no") return false;
  throw option_error("option -" + label(name, group) + ": '" + value +
                     "' is neither true nor false");
}

std::string Options::text(const std::string& name, const std::string& group)
{
  const std::string& value = raw(name, group);
  const OptionSpec& row = spec(name);
  if (row.type == OptionType::choice &&
      std::find(row.choices.begin(), row.choices.end(), value) == row.choices.end())
    throw option_error("option -" + label(name, group) + ": '" + value + "' is not one of " +
                       join(row.choices) + did_you_mean(value, row.choices));
  return value;
}

std::vector<std::string> Options::names(const std::string& name, const std::string& group)
{
  const std::string& value = raw(name, group);
  if (value == "\"\"") return {};
  std::vector<std::string> words = split(value, ',');
  for (std::size_t i = 0; i < words.size(); ++i)
    if (words[i].empty() || std::count(words.begin(), words.end(), words[i]) > 1)
      throw option_error("option -" + label(name, group) + ": '" + value +
                         "' holds an empty or repeated name");
  return words;
}

std::vector<std::string> Options::new_names(const std::string& name)
{
  std::vector<std::string> words = names(name);
  for (const std::string& word : words)
    if (!is_plain_name(word.substr(0, word.find(':'))))
      throw option_error("option -" + label(name, "") + ": '" + word +
                         "' cannot be a name: it has characters that paths or XML take otherwise");
  return words;
}

Vec3 Options::vector(const std::string& name, const std::string& group)
{
  const Vec3 value = vector_or_free(name, group);
  if (value.hasNaN())
    throw option_error("option -" + label(name, group) + ": 'free' has no meaning here");
  return value;
}

Vec3 Options::vector_or_free(const std::string& name, const std::string& group)
{
  const std::string& value = raw(name, group);
  const std::string shown_name = label(name, group);
  const std::vector<std::string> cells = split(value, ',');
  if (cells.size() != 3)
    throw option_error("option -" + shown_name + ": '" + value + "' must be x,y,z");
  Vec3 result;
  for (int a = 0; a < 3; ++a) {
    const std::string& cell = cells[static_cast<std::size_t>(a)];
    result[a] = cell == "free" ? std::nan("") : number(cell, spec(name), shown_name);
  }
  return result;
}

bool Options::given(const std::string& name, const std::string& group) const
{
  return given_.count(with_group(name, group)) > 0 || given_.count(without_group(name)) > 0;
}

bool Options::given_for(const std::string& name, const std::string& group) const
{
  return given_.count(with_group(name, group)) > 0;
}

std::set<std::string> Options::groups_given(const std::string& pattern) const
{
  std::set<std::string> groups;
  std::string group;
  for (const auto& [name, value] : given_)
    if (matches(spec(pattern), name, &group)) groups.insert(group);
  return groups;
}

void Options::try_value(const OptionSpec& row, const std::string& name)
{
  std::string group;
  matches(row, name, &group);
  switch (row.type) {
    case OptionType::real:
      real(row.name, group);
      break;
    case OptionType::integer:
      integer(row.name, group);
      break;
    case OptionType::flag:
      flag(row.name, group);
      break;
    case OptionType::names:
      names(row.name, group);
      break;
    case OptionType::vector:
      vector_or_free(row.name, group);
      break;
    case OptionType::text:
    case OptionType::file:
    case OptionType::choice:
      text(row.name, group);
      break;
  }
}

void Options::refuse_unread()
{
  std::vector<std::string> known;
  for (const std::string& one : read_) known.push_back("-" + one);
  const std::set<std::string> read = read_;
  for (const auto& [name, value] : given_) {
    if (read.count(name)) continue;
    const auto plain = std::find_if(table_.begin(), table_.end(),
                                    [&](const OptionSpec& spec) { return spec.name == name; });
    if (plain == table_.end())
      throw option_error("option -" + name + (value.place.empty() ? "" : " (" + value.place + ")") +
                         " names nothing in this scene" + did_you_mean("-" + name, known));
    try_value(*plain, name);
  }
}

}  // namespace trocar::core
