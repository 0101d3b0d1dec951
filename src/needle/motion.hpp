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

/// Prescribed motion of the base. Without a trajectory the base advances until the tip is `depth`
/// beyond the entry, holds, and withdraws until the end of the run. A trajectory is a CSV table
/// with the columns time,x,y,z[,dx,dy,dz[,roll]], linear between rows and constant
/// before the first and after the last row.
struct BaseMotion
{
  Vec3 entry = Vec3::Zero();       ///< point where the needle enters the tissue [m]
  Vec3 direction = Vec3::UnitX();  ///< unit vector of the insertion
  double length = 0.0;             ///< length of the needle [m]
  double roll = 0.0;               ///< rotation of the base about `direction` at the start [rad]
  double inserted = 0.0;           ///< depth of the tip below `entry` at the start [m]
  double velocity = 0.0;           ///< velocity of the advance [m/s]
  double depth = 0.0;              ///< depth of the tip below `entry` where the advance ends [m]
  double hold = 0.0;               ///< time between advance and withdrawal [s]
  double withdraw_velocity = 0.0;  ///< [m/s]; 0: the needle is never withdrawn
  std::optional<core::Csv> trajectory;

  Pose at(double t) const;
  Pose start() const;
};

/// Throws Failure (65) when the trajectory has the wrong columns, a direction of length 0, or a
/// first pose that is not `motion.start()`.
void check_trajectory(const BaseMotion& motion);

}  // namespace trocar::needle
