#pragma once

#include <stdexcept>
#include <string>

#include "core/words.hpp"

namespace trocar::core {

/// What the process returns to the shell; the numbers follow sysexits.h where it has one.
enum class ExitCode : int {
  ok = 0,
  internal = 1,
  options = 64,
  data = 65,
  solver = 70,
  output = 74,
  checkpoint = 75
};

/// A reason to stop, in one line for the user: what names and values of others bring into it is
/// escaped, and cut where it is long. Thrown on every rank or, from one rank only,
/// turned into an agreed stop by `base::on_root` or into MPI_Abort by `main`.
class Failure : public std::runtime_error
{
 public:
  Failure(ExitCode code, const std::string& line)
      : std::runtime_error(printable(line, longest)), code_(code)
  {
  }
  ExitCode code() const noexcept { return code_; }

 private:
  static constexpr std::size_t longest = 700;  ///< characters
  ExitCode code_;
};

/// A linear solve that stopped short of its tolerance (70). Thrown on every rank.
class Unsolved : public Failure
{
 public:
  explicit Unsolved(const std::string& line) : Failure(ExitCode::solver, line) {}
};

inline Failure option_error(const std::string& line)
{
  return {ExitCode::options, line};
}
inline Failure data_error(const std::string& line)
{
  return {ExitCode::data, line};
}
inline Failure solver_error(const std::string& line)
{
  return {ExitCode::solver, line};
}
inline Failure output_error(const std::string& line)
{
  return {ExitCode::output, line};
}

}  // namespace trocar::core
