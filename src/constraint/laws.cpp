#include "constraint/laws.hpp"

#include <algorithm>
#include <limits>

#include "law/solve.hpp"

namespace trocar::constraint {
namespace {

/// The laws hold to the tolerance, or to the rounding of the gaps after free motion: a body that
/// only contact holds moves far before the rows catch it.
law::Settings above_rounding(law::Settings settings, const law::Problem& problem)
{
  constexpr double rounded = 1e3 * std::numeric_limits<double>::epsilon();
  if (problem.g.size() > 0)
    settings.tolerance = std::max(settings.tolerance, rounded * problem.g.cwiseAbs().maxCoeff());
  return settings;
}

}  // namespace

void Laws::use(solve::LaggedFactor& factor)
{
  if (version_ == factor.version()) return;
  solve::ComplianceReport made;
  C_ = factor.compliance().block(system_->probes(), made);
  version_ = factor.version();
  report_->compliance += made;
  W_ = system_->compliance(C_);
}

Outcome<Done> Laws::meet(solve::LaggedFactor& factor, const core::VecX& free,
                         const core::VecX& start)
{
  constexpr int most_settlements = 50;
  use(factor);
  const law::Multipliers last = std::move(answer_);
  LawReport& report = *report_;
  int settlements = 0;
  for (;; ++settlements) {  // repeated only until nonlinear laws of fluids settle
    problem_ = system_->problem(W_, free);
    problem_.start = settlements > 0 ? answer_.lambda : last.converged ? last.lambda : start;
    answer_ = law::solve(problem_, above_rounding(settings_->solver, problem_));
    ++settings_->ledger->constraint_solves;
    if (!answer_.converged)
      return core::Refusal{answer_.immovable < 0
                               ? answer_.why
                               : answer_.why + ", of " + system_->place(answer_.immovable)};
    report.iterations += answer_.iterations;
    if (!system_->settle(answer_.lambda)) break;
    W_ = system_->compliance(C_);
    if (settlements == most_settlements)
      return core::Refusal{"the laws of the fluids do not settle"};
  }
  same_states_ =
      settlements == 0 && last.converged &&
      law::same_states(problem_, last.lambda, answer_.lambda, settings_->solver.tolerance);
  if (!last.converged) law::compare(problem_, settings_->compare, report.trials);

  report.rows = system_->size();
  report.rank = answer_.rank;
  report.condition = answer_.condition;
  report.nonunique = answer_.nonunique;
  report.residual = std::max(report.residual, answer_.residual);
  report.outer = std::max(report.outer, answer_.outer);
  report.contraction = std::max(report.contraction, answer_.contraction);
  return Done{};
}

}  // namespace trocar::constraint
