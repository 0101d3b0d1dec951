#pragma once

#include <string>
#include <vector>

namespace trocar::core {

/// A state as lists of numbers, the same whatever the number of ranks: what a state says of itself,
/// leaf by leaf in the order in which it says it. Lists of nodes and tets are in file order.
struct Archive
{
  struct Field
  {
    std::string name, unit;
    std::vector<double> values;

    bool operator==(const Field&) const = default;
  };

  std::vector<std::string> names;  ///< of the leaves, "NAME [UNIT]"; lists tell their size first
  std::vector<long long> whole;    ///< integers, flags, sizes of lists, whether parts are there
  std::vector<double> real;        ///< what ranks do not share
  std::vector<Field> fields;       ///< what they share

  bool operator==(const Archive&) const = default;
};

}  // namespace trocar::core
