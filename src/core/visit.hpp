#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace trocar::core {

// A state describes itself to a visitor. Every struct that is part of a state has a function
//   template <class Self, class Visitor> static void visit(Self& self, Visitor& v)
// (Self is const or not) that passes every member to v, with its name and unit:
//   v("pressure", "Pa", self.pressure);
// Comparisons, tests and checkpoints all use this one description, so none of them can forget a
// member. `Walk` descends to the leaves: numbers, flags, lists of numbers, Eigen's vectors and
// matrices, fields.

/// A number, flag or enumerator.
template <class T>
concept Number =
    std::is_arithmetic_v<std::remove_const_t<T>> || std::is_enum_v<std::remove_const_t<T>>;

/// Calls `leaf.value(path, unit, value)` for every leaf; `path` joins the names by '/'. Before the
/// entries of a list it calls `leaf.resize(path, list)`, before an optional part
/// `leaf.present(path, part)`.
template <class Leaf>
class Walk
{
 public:
  explicit Walk(Leaf& leaf, std::string prefix = {}) : leaf_(leaf), prefix_(std::move(prefix)) {}

  template <class T>
  void operator()(const std::string& name, const char* unit, T& value)
  {
    const std::string path = prefix_.empty() ? name : prefix_ + "/" + name;
    if constexpr (is_shared<std::remove_const_t<T>>::value) {
      visit_shared(name, unit, value);
    } else if constexpr (is_optional<T>::value) {
      leaf_.present(path, value);
      if (value) Walk(leaf_, prefix_)(name, unit, *value);
    } else if constexpr (is_list<T>::value) {
      leaf_.resize(path, value);
      for (std::size_t i = 0; i < value.size(); ++i)
        Walk(leaf_, path)(std::to_string(i), unit, value[i]);
    } else if constexpr (requires(Walk walk) { std::remove_const_t<T>::visit(value, walk); }) {
      Walk below(leaf_, path);
      std::remove_const_t<T>::visit(value, below);
    } else {
      leaf_.value(path, unit, value);
    }
  }

 private:
  /// A part that several states share is visited in each of them.
  template <class T>
  void visit_shared(const std::string& name, const char* unit, const std::shared_ptr<const T>& part)
  {
    const std::string path = prefix_.empty() ? name : prefix_ + "/" + name;
    leaf_.present(path, part);
    if (part) Walk(leaf_, prefix_)(name, unit, *part);
  }
  template <class T>
  void visit_shared(const std::string& name, const char* unit, std::shared_ptr<const T>& part)
  {
    std::optional<T> own;
    if (part) own = *part;
    Walk(leaf_, prefix_)(name, unit, own);
    part = own ? std::make_shared<const T>(std::move(*own)) : nullptr;
  }

  template <class T>
  struct is_shared : std::false_type
  {
  };
  template <class T>
  struct is_shared<std::shared_ptr<T>> : std::true_type
  {
  };
  template <class T>
  struct is_optional : std::false_type
  {
  };
  template <class T>
  struct is_optional<std::optional<T>> : std::true_type
  {
  };
  template <class T>
  struct is_optional<const std::optional<T>> : std::true_type
  {
  };
  template <class T>
  struct is_list : std::false_type
  {
  };
  template <class T>
  struct is_list<std::vector<T>> : std::bool_constant<!Number<T>>
  {
  };
  template <class T>
  struct is_list<const std::vector<T>> : std::bool_constant<!Number<T>>
  {
  };

  Leaf& leaf_;
  std::string prefix_;
};

}  // namespace trocar::core
