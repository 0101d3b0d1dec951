#pragma once

#include <string>
#include <vector>

namespace trocar::core {

/// A state as lists of numbers, independent of the number of ranks. The entries are the leaves of
/// the state in the order of its `visit` functions (core/visit.hpp). Values of nodes and tets are
/// in the order of the mesh file.
struct Archive
{
  struct Field
  {
    std::string name, unit;
    std::vector<double> values;

    bool operator==(const Field&) const = default;
  };

  /// "NAME [UNIT]" of every leaf, and "NAME" of every list or optional part before its leaves.
  std::vector<std::string> names;
  std::vector<long long> whole;  ///< integers, flags, sizes of lists, presence of optional parts
  std::vector<double> real;      ///< reals that every rank holds
  std::vector<Field> fields;     ///< reals of nodes or tets, which are distributed over the ranks

  bool operator==(const Archive&) const = default;
};

}  // namespace trocar::core
