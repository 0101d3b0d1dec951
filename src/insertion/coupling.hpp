#pragma once

#include <vector>

#include "insertion/ground.hpp"
#include "insertion/state.hpp"
#include "law/problem.hpp"

namespace trocar::insertion {

/// Row numbers of a coupling point in a set, its friction bound and its axial gap. Along a line
/// neighbouring points may share their rows.
struct PointRows
{
  int from = 0;                    ///< index of the (first) point
  std::vector<double> share{1.0};  ///< of every point in the forces
  /// Axial gap of every point less that of all, which slip takes away: points that share their rows
  /// slip together.
  std::vector<double> apart{0.0};
  int first = -1;      ///< first of two lateral rows, -1 when there is none
  int axial = -1;      ///< row of the box law or of the η law, -1 when there is none
  int viscous = -1;    ///< row of the dashpot, -1 when there is none
  int point = 0;       ///< `law::Block::point` of all its rows
  double bound = 0.0;  ///< bound F of the box row [N]
  double slid = 0.0;   ///< axial gap when the rows were made [m]
};

/// Rows of one needle in a set.
struct CouplingRows
{
  std::vector<PointRows> points;
  int lever = -1;  ///< first of two rows that keep a needle from turning about its only point
  TipRows tip;
};

/// Forces and work of one needle's coupling in a step.
struct CouplingReport
{
  double shaft_friction = 0.0;  ///< Σ axial λ [N], > 0 resists insertion
  /// Σ λ δ of the points' axial rows and the tip's lateral rows [J]; <= 0, but not with the η law.
  double friction_work = 0.0;
  double tip_force = 0.0;              ///< axial λ on the tip [N], >= 0
  double tip_gap = 0.0;                ///< δ of the tip's axial row [m], < 0 where it advanced
  double cutting_work = 0.0;           ///< λ δ of the tip's axial row [J], <= 0
  TipOutcome tip = TipOutcome::holds;  ///< any other outcome: call `settle_tip`
};

/// Adds one axial row for dry friction, where `rows.bound` is positive, and one for a dashpot, and
/// writes down their numbers. `dashpot`: compliance h/b of the dashpot [m/N], 0: none.
void add_friction_rows(double dashpot, constraint::Row row, PointRows& rows, constraint::Set& set);

/// Adds the rows of one needle at an iterate to the set.
CouplingRows add_rows(const Ground& ground, const InsertionState& state, const Iterate& at,
                      constraint::Set& set);

/// Stores the multipliers in points and tip. Multipliers and end-of-step gaps decide whether a
/// point sticks or slips and whether the tip holds or yields.
CouplingReport accept(const Ground& ground, InsertionState& state, const CouplingRows& rows,
                      const law::Multipliers& multipliers);

/// Length of the inserted path nearest to each point, by physical volume of the mesh [m]; shape
/// (points, volumes). The sum of all entries is the inserted length in tissue.
core::MatX tributary_lengths(const mesh::Mesh& mesh, const InsertionState& state);

}  // namespace trocar::insertion
