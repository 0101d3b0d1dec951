#pragma once

#include <vector>

#include "insertion/ground.hpp"
#include "insertion/state.hpp"
#include "law/problem.hpp"

namespace trocar::insertion {

/// Which rows a coupling point got in a set, and where it was on the shaft.
struct PointRows
{
  int first = -1;      ///< first of two lateral rows, -1 when there is none
  int axial = -1;      ///< row of the box (or η) law, -1 when there is none
  int viscous = -1;    ///< row of the dashpot, -1 when there is none
  int point = 0;       ///< coupling point of them all in the set
  double bound = 0.0;  ///< F of the box row [N]
  double slid = 0.0;   ///< axial gap when the rows were made [m]
};

/// Rows of one needle in a set.
struct CouplingRows
{
  std::vector<PointRows> points;
  int lever = -1;  ///< first of two lateral rows at a tip that one point alone would let turn
  TipRows tip;
};

/// What one needle's coupling did in a step.
struct CouplingReport
{
  double shaft_friction = 0.0;  ///< Σ axial λ [N], > 0 resists insertion
  double friction_work = 0.0;   ///< Σ λ δ of the axial rows [J], <= 0 (η law: no such bound)
  double tip_force = 0.0;       ///< axial λ on the tip [N], >= 0
  double tip_gap = 0.0;         ///< δ of the tip's axial row [m], < 0 where it advanced
  double cutting_work = 0.0;    ///< λ δ of the tip's axial row [J], <= 0
  TipOutcome tip = TipOutcome::holds;  ///< anything else: call `settle_tip`
};

/// Adds a needle's rows at an iterate.
CouplingRows add_rows(const Ground& ground, const InsertionState& state, const Iterate& at,
                      constraint::Set& set);

/// Takes multipliers and end-of-step gaps back into points and tip: stick or slip, hold or yield.
CouplingReport accept(const Ground& ground, InsertionState& state, const CouplingRows& rows,
                      const law::Multipliers& multipliers);

/// ∫ over the piece of path nearest to each point [m] per tissue volume, so that the sum over
/// points is the inserted length in tissue. Shape (points, volumes).
core::MatX tributary_lengths(const mesh::Mesh& mesh, const InsertionState& state);

}  // namespace trocar::insertion
