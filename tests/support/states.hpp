#pragma once

#include <string>
#include <vector>

#include "core/visit.hpp"
#include "step/state.hpp"

// States taken apart into numbers and put together again, by what they say of themselves.
namespace trocar::test {

/// One number of a state and its name.
struct Member
{
  std::string name;
  double value;
};

/// Takes numbers out.
struct TakeApart
{
  template <class T>
  void value(const std::string& name, const char* /*unit*/, const T& x)
  {
    if constexpr (core::Number<T>) {
      members.push_back({name, static_cast<double>(x)});
    } else if constexpr (requires { x.value.size(); }) {
      value(name, "", x.value);
    } else {
      sizes.push_back(static_cast<std::size_t>(x.size()));
      if constexpr (requires { x.rows(); })
        for (Eigen::Index i = 0; i < x.size(); ++i) members.push_back({name, x.data()[i]});
      else
        for (const auto& one : x) members.push_back({name, static_cast<double>(one)});
    }
  }
  template <class T>
  void resize(const std::string& /*name*/, const T& list)
  {
    sizes.push_back(list.size());
  }
  template <class T>
  void present(const std::string& /*name*/, const T& part)
  {
    sizes.push_back(part ? 1 : 0);
  }

  std::vector<Member> members;
  std::vector<std::size_t> sizes;  ///< of lists, in the order in which they come
};

/// Puts them into a state that knows nothing.
struct PutTogether
{
  explicit PutTogether(const TakeApart& from) : parts(&from) {}

  template <class T>
  void value(const std::string& /*name*/, const char* /*unit*/, T& x)
  {
    if constexpr (core::Number<T>) {
      x = static_cast<T>(next());
    } else if constexpr (requires { x.value.size(); }) {
      fill(x.value);
    } else {
      fill(x);
    }
  }
  template <class T>
  void resize(const std::string& /*name*/, T& list)
  {
    list.resize(next_size());
  }
  template <class T>
  void present(const std::string& /*name*/, T& part)
  {
    if (next_size() > 0) part.emplace();
  }

 private:
  template <class T>
  void fill(T& x)
  {
    const std::size_t size = next_size();
    if constexpr (requires { x.rows(); }) {
      if constexpr (T::SizeAtCompileTime == Eigen::Dynamic)
        x.resize(static_cast<Eigen::Index>(size));
      for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = next();
    } else {
      x.resize(size);
      for (auto& one : x) one = static_cast<std::remove_reference_t<decltype(one)>>(next());
    }
  }
  double next() { return parts->members.at(member++).value; }
  std::size_t next_size() { return parts->sizes.at(list++); }
  const TakeApart* parts;
  std::size_t member = 0, list = 0;
};

/// All numbers of a state on this rank.
inline TakeApart apart(const step::State& state)
{
  TakeApart parts;
  core::Walk walk(parts);
  step::State::visit(state, walk);
  return parts;
}

/// A state of these numbers and nothing else.
inline step::State together(const TakeApart& parts)
{
  step::State state;
  PutTogether put(parts);
  core::Walk walk(put);
  step::State::visit(state, walk);
  return state;
}

}  // namespace trocar::test
