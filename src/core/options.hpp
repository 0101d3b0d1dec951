#pragma once

#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/math.hpp"

namespace trocar::core {

/// Type of an option's value. `file`: the name of a file to be read.
enum class OptionType { real, integer, flag, text, file, choice, names, vector };

/// One row of the option table. The table drives parsing, -help, docs/options.md and the HDF5
/// record. A name may hold one `<group>` in place of a name that the user chooses:
/// `tissue_<volume>_young` overrides `tissue_young` for one volume.
struct OptionSpec
{
  std::string name;  ///< without the leading dash
  OptionType type = OptionType::real;
  std::string fallback;  ///< default, as the user would write it
  std::string unit;      ///< SI, "1" for pure numbers, "" for words
  std::string help;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;               ///< the range excludes `low`
  bool high_open = false;              ///< the range excludes `high`
  std::vector<std::string> choices{};  ///< for OptionType::choice
};

/// The range of a spec as text, "" when there is none.
std::string range_text(const OptionSpec& spec);

/// A value that the user gave, and where.
struct OptionValue
{
  std::string value;
  std::string source;   ///< "command line", "options file" or "PETSC_OPTIONS"
  std::string place{};  ///< `WrittenOption::place`, for messages
};

/// A value as the run used it, for the record in the results.
struct ResolvedOption
{
  std::string name, value, unit, source;
};

/// Reads values of options and checks them against the option table. A bad value throws Failure
/// (64) with one line that names the option. Not collective: every rank holds the same values.
class Options
{
 public:
  Options(const std::vector<OptionSpec>& table, std::map<std::string, OptionValue> given);

  double real(const std::string& name, const std::string& group = "");
  int integer(const std::string& name, const std::string& group = "");
  bool flag(const std::string& name, const std::string& group = "");
  std::string text(const std::string& name, const std::string& group = "");
  std::vector<std::string> names(const std::string& name, const std::string& group = "");
  /// Names that the user gives to things. The part of each name before a colon must be plain (see
  /// `is_plain_name`).
  std::vector<std::string> new_names(const std::string& name);
  Vec3 vector(const std::string& name, const std::string& group = "");
  /// Three numbers; the word `free` leaves an axis without a value (NaN).
  Vec3 vector_or_free(const std::string& name, const std::string& group);

  /// True when the user gave the option for this group or for all groups.
  bool given(const std::string& name, const std::string& group = "") const;

  /// True when the user gave the option for this group itself, not only for all groups.
  bool given_for(const std::string& name, const std::string& group) const;

  /// Sorted names that the user put in place of `<group>`, in options that match the pattern.
  std::set<std::string> groups_given(const std::string& pattern) const;

  /// Throws Failure (64) if an option names a volume, surface or needle that does not exist, or if
  /// an option that nobody has read has a bad value.
  void refuse_unread();

  const std::vector<ResolvedOption>& resolved() const { return resolved_; }

 private:
  const OptionSpec& spec(const std::string& name) const;
  const std::string& raw(const std::string& name, const std::string& group);
  /// Reads a value according to its type, only to throw Failure (64) if the value is bad.
  void try_value(const OptionSpec& spec, const std::string& name);
  /// Name and place of an option for error messages: of the option that the user gave for this
  /// group, else of the option for all groups.
  std::string label(const std::string& name, const std::string& group) const;
  double number(const std::string& cell, const OptionSpec& spec, const std::string& label) const;

  const std::vector<OptionSpec>& table_;
  std::map<std::string, OptionValue> given_;
  std::set<std::string> read_;
  std::vector<ResolvedOption> resolved_;
};

/// True when `name` is the name of `spec` or matches its pattern. If it matches, `group` receives
/// the user's word in place of `<group>`.
bool matches(const OptionSpec& spec, const std::string& name, std::string* group = nullptr);

}  // namespace trocar::core
