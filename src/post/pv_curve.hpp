#pragma once

#include <vector>

#include "step/time_stepper.hpp"

namespace trocar::post {

/// A P-V curve: equilibria with a cavity held at volumes between two parts of that of the mesh.
struct PvSettings
{
  int cavity = 0;
  double low = 0.7, high = 1.3;
  int points = 25;
  int pieces = 4;  ///< of the second fit
};

/// Pressure over volume, ascending, and least-squares fits of it (fluid paper figure 4).
struct PvCurve
{
  std::vector<double> ratio;     ///< V / V_0
  std::vector<double> pressure;  ///< [Pa]
  std::vector<double> line;      ///< straight line at both ends [Pa]
  std::vector<double> pieces;    ///< continuous straight pieces at their ends [Pa]
  double slope = 0.0;            ///< K_p = dp/d(V/V_0) of the line [Pa]
  double r_squared = 0.0;        ///< of the line
};

/// Sweeps the volume from that at the start, down and up; the observer is told of every point, with
/// its number for the time. Failure (70) when one is not reached. Gives the curve and the state at
/// the largest volume. Collective.
struct PvSweep
{
  PvCurve curve;
  step::State end;
};
PvSweep sweep_volume(step::Model& model, const PvSettings& settings, const step::State& start,
                     step::Observer& observer);

}  // namespace trocar::post
