#include "solve/step_solver.hpp"

#include <fstream>

#include "solve/domain.hpp"
#include "solve/ksp_step_solver.hpp"
#include "solve/supernodal_step_solver.hpp"

namespace trocar::solve {
namespace {

constexpr double part_of_memory = 0.7;  ///< largest part of the free memory for solving

/// Available memory of this machine [B]; 0 when it is unknown.
double available_memory()
{
  std::ifstream info("/proc/meminfo");
  std::string word;
  while (info >> word)
    if (word == "MemAvailable:") {
      double kilobytes = 0.0;
      info >> kilobytes;
      return 1024.0 * kilobytes;
    }
  return 0.0;
}

}  // namespace

std::unique_ptr<StepSolver> make_step_solver(Provider provider, const StepSolverParts& parts)
{
  if (provider == Provider::ksp)
    return std::make_unique<KspStepSolver>(parts, ColumnSolver::one_by_one, "");
  if (provider == Provider::ksp_block)
    return std::make_unique<KspStepSolver>(parts, ColumnSolver::blocked, "");
  const bool free_to_choose = provider == Provider::automatic;
  const int most_shared = free_to_choose ? most_interface : last_interface;
  std::unique_ptr<SupernodalStepSolver> solver;
  try {
    solver = std::make_unique<SupernodalStepSolver>(parts, most_shared);
  } catch (const core::Failure& failure) {  // all ranks throw alike
    if (!free_to_choose || failure.code() != core::ExitCode::solver) throw;
    return std::make_unique<KspStepSolver>(parts, ColumnSolver::blocked,
                                           std::string(", because ") + failure.what());
  }
  const bool too_wide = solver->shared_dofs() > most_shared;
  if (!free_to_choose && too_wide)
    throw core::solver_error("the ranks would share " + std::to_string(solver->shared_dofs()) +
                             " dofs: take fewer ranks, or -compliance_provider ksp");
  if (!free_to_choose) return solver;
  const double limit = parts.most_memory > 0.0
                           ? parts.most_memory
                           : part_of_memory * parts.space.comm().max(available_memory());
  if (too_wide)
    return std::make_unique<KspStepSolver>(
        parts, ColumnSolver::blocked,
        ", because the ranks would share " + std::to_string(solver->shared_dofs()) + " dofs");
  if (limit <= 0.0 || solver->memory_bytes() <= limit) return solver;
  return std::make_unique<KspStepSolver>(
      parts, ColumnSolver::blocked,
      ", because a supernodal factor would take " +
          std::to_string(static_cast<long long>(solver->memory_bytes() / 1e6)) + " MB");
}

}  // namespace trocar::solve
