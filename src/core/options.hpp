#pragma once

#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/math.hpp"

namespace trocar::core {

/// `file`: text that names a file to be read.
enum class OptionType { real, integer, flag, text, file, choice, names, vector };

/// One row of the option table: it drives parsing, -help, docs/options.md and the HDF5 record.
/// A name may hold one `<group>` in place of a name the user chooses: `tissue_<volume>_young`
/// overrides `tissue_young` for one volume.
struct OptionSpec
{
  std::string name;  ///< without the leading dash
  OptionType type = OptionType::real;
  std::string fallback;  ///< default, as the user would write it
  std::string unit;      ///< SI, "1" for pure numbers, "" for words
  std::string help;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;  ///< the range excludes its ends
  bool high_open = false;
  std::vector<std::string> choices{};  ///< for OptionType::choice
};

/// The range of a spec as text, "" when there is none.
std::string range_text(const OptionSpec& spec);

/// What the user gave, and where.
struct OptionValue
{
  std::string value;
  std::string source;   ///< "command line", "options file", "PETSC_OPTIONS", "default"
  std::string place{};  ///< "FILE:LINE" in an options file, for messages
};

/// One value as it was used, for the record in the results.
struct ResolvedOption
{
  std::string name, value, unit, source;
};

/// Reads values through the table. Every bad value is a Failure (64) of one line that names the
/// option. Not collective: every rank holds the same values.
class Options
{
 public:
  Options(const std::vector<OptionSpec>& table, std::map<std::string, OptionValue> given);

  double real(const std::string& name, const std::string& group = "");
  int integer(const std::string& name, const std::string& group = "");
  bool flag(const std::string& name, const std::string& group = "");
  std::string text(const std::string& name, const std::string& group = "");
  std::vector<std::string> names(const std::string& name, const std::string& group = "");
  /// Names that the user gives to things, which must be plain (see `is_plain_name`); what follows a
  /// colon is not part of them.
  std::vector<std::string> new_names(const std::string& name);
  Vec3 vector(const std::string& name, const std::string& group = "");
  /// Three numbers; the word `free` leaves an axis without a value (NaN).
  Vec3 vector_or_free(const std::string& name, const std::string& group);

  /// True when the user gave the option (for this group, if one is named).
  bool given(const std::string& name, const std::string& group = "") const;

  /// True when the user gave it for this group itself.
  bool given_for(const std::string& name, const std::string& group) const;

  /// Every group the user named in options that match the pattern, sorted.
  std::set<std::string> groups_given(const std::string& pattern) const;

  /// Throws Failure (64) for an override whose volume, surface or needle does not exist, and for
  /// values of options nobody has asked for that could not be read.
  void refuse_unread();

  const std::vector<ResolvedOption>& resolved() const { return resolved_; }

 private:
  const OptionSpec& spec(const std::string& name) const;
  const std::string& raw(const std::string& name, const std::string& group);
  /// Reads a value as its type asks for it, only to see that this is possible.
  void try_value(const OptionSpec& spec, const std::string& name);
  /// The name to complain about: what the user gave, own or inherited, and where.
  std::string label(const std::string& name, const std::string& group) const;
  double number(const std::string& cell, const OptionSpec& spec, const std::string& label) const;

  const std::vector<OptionSpec>& table_;
  std::map<std::string, OptionValue> given_;
  std::set<std::string> read_;
  std::vector<ResolvedOption> resolved_;
};

/// True when `name` is the name of `spec`, or fits its pattern; `group` gets the user's word.
bool matches(const OptionSpec& spec, const std::string& name, std::string* group = nullptr);

}  // namespace trocar::core
