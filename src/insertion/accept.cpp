#include <cmath>

#include "insertion/coupling.hpp"

// Takes the multipliers of a needle's rows back into its state.
namespace trocar::insertion {
namespace {

void accept_point(double tolerance, InsertionState& state, const PointRows& rows,
                  const law::Multipliers& multipliers, CouplingReport& report)
{
  Vec3 lambda = Vec3::Zero();
  if (rows.first >= 0) lambda.head<2>() = multipliers.lambda.segment<2>(rows.first);
  for (int row : {rows.axial, rows.viscous}) {
    if (row < 0) continue;
    lambda[2] += multipliers.lambda[row];
    report.friction_work += multipliers.lambda[row] * multipliers.delta[row];
  }
  report.shaft_friction += lambda[2];
  const int axial = std::max(rows.axial, rows.viscous);  // both rows have the same slip
  // A point without axial row slips freely, by its whole axial gap.
  const double slip = axial < 0 ? rows.slid : multipliers.delta[axial];
  // A point below its friction bound sticks, even if the solver's tolerance left it a gap.
  const bool inside = rows.axial >= 0 && rows.bound > 0.0 &&
                      std::abs(multipliers.lambda[rows.axial]) < rows.bound * (1.0 - 1e-9);
  const bool stuck = inside || std::abs(slip) <= tolerance;
  for (std::size_t i = 0; i < rows.share.size(); ++i) {
    CouplingPoint& point = state.points[static_cast<std::size_t>(rows.from) + i];
    point.lambda = rows.share[i] * lambda;
    point.stuck = stuck;
    if (!stuck) point.needle_arc += slip + rows.apart[i];
  }
}

}  // namespace

CouplingReport accept(const Ground& ground, InsertionState& state, const CouplingRows& rows,
                      const law::Multipliers& multipliers)
{
  const double tolerance = ground.settings.stick_tolerance;
  CouplingReport report;
  for (const PointRows& point : rows.points)
    accept_point(tolerance, state, point, multipliers, report);
  if (rows.tip.axial < 0) return report;
  report.tip = accept_tip(state.tip, rows.tip, multipliers, tolerance);
  report.tip_force = state.tip.lambda[2];
  report.tip_gap = multipliers.delta[rows.tip.axial];
  report.cutting_work = report.tip_force * report.tip_gap;
  if (rows.tip.lateral >= 0)
    report.friction_work += multipliers.lambda.segment<2>(rows.tip.lateral)
                                .dot(multipliers.delta.segment<2>(rows.tip.lateral));
  return report;
}

}  // namespace trocar::insertion
