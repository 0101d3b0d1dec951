#pragma once

#include <optional>
#include <string>

#include "core/csv.hpp"
#include "core/math.hpp"

namespace trocar::needle {

using core::Mat3;
using core::Vec3;

/// Place and orientation of the needle's base: position [m] and a frame whose first column points
/// along the needle at the base.
struct Pose
{
  Vec3 x;
  Mat3 R;
};

/// Prescribed motion of the base: advance at a velocity until the tip is `depth` beyond the entry,
/// hold, withdraw until the end of the run; or a trajectory from a CSV file
/// (columns time,x,y,z[,dx,dy,dz[,roll]]: linear between rows, held before and after).
struct BaseMotion
{
  Vec3 entry = Vec3::Zero();       ///< where the path enters [m]
  Vec3 direction = Vec3::UnitX();  ///< unit
  double length = 0.0;             ///< of the needle [m]
  double roll = 0.0;               ///< of the base about the direction at the start [rad]
  double inserted = 0.0;           ///< depth of the tip at the start [m]
  double velocity = 0.0;           ///< [m/s]
  double depth = 0.0;              ///< where the advance ends [m]
  double hold = 0.0;               ///< [s]
  double withdraw_velocity = 0.0;  ///< [m/s], 0 = never
  std::optional<core::Csv> trajectory;

  Pose at(double t) const;
  Pose start() const;
};

/// Throws Failure (65) when the trajectory has the wrong columns, a zero direction, or does not
/// begin where the needle is.
void check_trajectory(const BaseMotion& motion);

}  // namespace trocar::needle
