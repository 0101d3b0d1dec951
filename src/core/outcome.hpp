#pragma once

#include <optional>
#include <string>
#include <utility>

namespace trocar::core {

/// Why a value could not be computed, in one line for the log.
struct Refusal
{
  std::string why;
  bool unsolved = false;    ///< a linear solver stopped short of its tolerance
  bool indefinite = false;  ///< an exact tangent has no factor
};

/// A value, or the reason why it could not be computed; a smaller step may succeed. All ranks hold
/// a value or all hold the same refusal: they agree before an Outcome is made.
template <class T>
class Outcome
{
 public:
  Outcome(T value) : value_(std::move(value)) {}
  Outcome(Refusal refusal) : refusal_(std::move(refusal)) {}

  explicit operator bool() const { return value_.has_value(); }
  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }
  const Refusal& refusal() const { return refusal_; }
  const std::string& why() const { return refusal_.why; }

 private:
  std::optional<T> value_;
  Refusal refusal_;
};

/// Value of an Outcome that only says whether some work succeeded.
struct Done
{
};

}  // namespace trocar::core
