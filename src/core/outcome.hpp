#pragma once

#include <optional>
#include <string>
#include <utility>

namespace trocar::core {

/// Why something is not there, in one line for the log.
struct Refusal
{
  std::string why;
  bool unsolved = false;  ///< a linear solver stopped short of its tolerance
};

/// A value, or why there is none: what a smaller step may do better. Equal on every rank; whoever
/// makes one has agreed on it.
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

/// The value of what is done for its effect.
struct Done
{
};

}  // namespace trocar::core
