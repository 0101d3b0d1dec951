#pragma once

#include <stdexcept>
#include <string>

#include "core/words.hpp"

namespace trocar::core {

/// Exit codes of the process. Codes above 1 are those of sysexits.h.
enum class ExitCode : int {
  ok = 0,
  internal = 1,
  options = 64,
  data = 65,
  solver = 70,
  output = 74,
  checkpoint = 75
};

/// A reason to stop the run, as one line for the user. The line may contain names and values from
/// the user: control characters in it are escaped, and a long line is cut in its middle. Usually
/// every rank throws it. If one rank alone throws it, `base::on_root` or `base::on_all` rethrows it
/// on all ranks; elsewhere the driver calls MPI_Abort.
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
