#pragma once

#include <vector>

#include "step/time_stepper.hpp"

namespace trocar::post {

/// Settings of a P-V curve: equilibria with one cavity held at `points` volumes from `low` to
/// `high` times its volume in the mesh.
struct PvSettings
{
  int cavity = 0;
  double low = 0.7, high = 1.3;
  int points = 25;
  int pieces = 4;  ///< number of straight pieces of the second fit
};

/// Pressure over volume, in ascending order, and two least-squares fits (fluid paper figure 4).
struct PvCurve
{
  std::vector<double> ratio;     ///< V / V_0
  std::vector<double> pressure;  ///< pressure of the cavity [Pa]
  std::vector<double> line;      ///< first fit at every ratio, a straight line [Pa]
  std::vector<double> pieces;    ///< second fit at every ratio, straight pieces [Pa]
  double slope = 0.0;            ///< K_p = dp/d(V/V_0) of the line [Pa]
  double r_squared = 0.0;        ///< coefficient of determination R² of the line
};

/// Results of a sweep: the P-V curve and the state at the largest volume.
struct PvSweep
{
  PvCurve curve;
  step::State end;
};
/// Sweeps the volume from `start` down over the ratios up to 1, then from `start` up over the
/// others. The observer receives every point, with its number instead of a time. Throws Failure
/// (70) when a point is not reached. Collective.
PvSweep sweep_volume(step::Model& model, const PvSettings& settings, const step::State& start,
                     step::Observer& observer);

}  // namespace trocar::post
