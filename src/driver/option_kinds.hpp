#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/options.hpp"

// Functions that make rows of the option table, one for each kind of option.
namespace trocar::driver {

using core::OptionSpec;
using core::OptionType;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline OptionSpec positive(const char* name, const char* fallback, const char* unit,
                           const char* help)
{
  return {name, OptionType::real, fallback, unit, help, 0.0, infinity, true, false};
}
inline OptionSpec not_negative(const char* name, const char* fallback, const char* unit,
                               const char* help)
{
  return {name, OptionType::real, fallback, unit, help, 0.0, infinity, false, false};
}
inline OptionSpec poisson(const char* name, const char* fallback)
{
  return {name, OptionType::real, fallback, "1", "Poisson's ratio", -1.0, 0.5, true, true};
}
inline OptionSpec count(const char* name, const char* fallback, double low, double high,
                        const char* help)
{
  return {name, OptionType::integer, fallback, "1", help, low, high, false, false};
}
inline OptionSpec word(const char* name, const char* fallback, const char* help)
{
  return {name, OptionType::text, fallback, "", help};
}
inline OptionSpec file(const char* name, const char* help)
{
  return {name, OptionType::file, "", "", help};
}
inline OptionSpec list(const char* name, const char* help)
{
  return {name, OptionType::names, "\"\"", "", help};
}
inline OptionSpec vector(const char* name, const char* fallback, const char* unit, const char* help)
{
  return {name, OptionType::vector, fallback, unit, help};
}
inline OptionSpec flag(const char* name, const char* help)
{
  return {name, OptionType::flag, "false", "", help};
}
inline OptionSpec choice(const char* name, const char* fallback, std::vector<std::string> choices,
                         const char* help)
{
  OptionSpec spec{name, OptionType::choice, fallback, "", help};
  spec.choices = std::move(choices);
  return spec;
}

inline OptionSpec withdrawal(const std::string& name)
{
  return {name, OptionType::real, "-1",  "",   "the same on withdrawal; -1 = as on the advance",
          -1.0, infinity,         false, false};
}

/// Adds an option, for example tissue_young, and its override for one group, tissue_<volume>_young.
inline void with_override(std::vector<OptionSpec>& table, const OptionSpec& spec,
                          const std::string& group)
{
  table.push_back(spec);
  OptionSpec own = spec;
  own.name.insert(own.name.find('_') + 1, group + "_");
  own.help = spec.help + " of one " + group.substr(1, group.size() - 2);
  table.push_back(own);
}

/// Adds the options of contact: pairs and obstacles.
void add_contact_options(std::vector<OptionSpec>& table);

/// Adds the options of cavities and of the conduits between them.
void add_cavity_options(std::vector<OptionSpec>& table);

}  // namespace trocar::driver
