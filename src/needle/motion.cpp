#include "needle/motion.hpp"

#include <algorithm>

#include "core/failure.hpp"
#include "core/words.hpp"

namespace trocar::needle {

Pose BaseMotion::start() const
{
  return {entry + (inserted - length) * direction,
          core::rotation_exp(roll * direction) * core::frame_along(direction)};
}

Pose BaseMotion::at(double t) const
{
  Pose pose = start();
  if (!trajectory) {
    const double reach = std::max(depth - inserted, 0.0);
    const double arrival = velocity > 0.0 ? reach / velocity : 0.0;
    double travel = std::min(velocity * t, velocity > 0.0 ? reach : 0.0);
    if (t > arrival + hold) travel -= withdraw_velocity * (t - arrival - hold);
    pose.x += travel * direction;
    return pose;
  }
  const auto value = [&](std::size_t column) { return core::interpolate(*trajectory, column, t); };
  pose.x = Vec3(value(1), value(2), value(3));
  if (trajectory->columns.size() >= 7) {
    const Vec3 aim = Vec3(value(4), value(5), value(6)).normalized();
    pose.R = core::rotation_between(direction, aim) * pose.R;
  }
  if (trajectory->columns.size() >= 8)
    pose.R = core::rotation_exp(value(7) * pose.R.col(0)) * pose.R;
  return pose;
}

void check_trajectory(const BaseMotion& motion)
{
  if (!motion.trajectory) return;
  const core::Csv& table = *motion.trajectory;
  core::require_time_column(table);
  const std::vector<std::string> names{"time", "x", "y", "z", "dx", "dy", "dz", "roll"};
  const std::size_t count = table.columns.size();
  if ((count != 4 && count != 7 && count != 8) ||
      !std::equal(table.columns.begin(), table.columns.end(), names.begin()))
    throw core::data_error(table.file +
                           ": columns must be time,x,y,z[,dx,dy,dz[,roll]], they are " +
                           core::join(table.columns, ","));
  if (count >= 7)
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      if (Vec3(table.rows[i][4], table.rows[i][5], table.rows[i][6]).norm() < 1e-9)
        throw core::data_error(table.file + ": row " + std::to_string(i + 1) +
                               " has a direction of length 0");
  const Pose first = motion.at(table.rows.front().front());
  const Pose start = motion.start();
  const double apart = std::max((first.x - start.x).norm(),
                                motion.length * (first.R.col(0) - start.R.col(0)).norm());
  if (apart > 1e-6 * motion.length)
    throw core::data_error(table.file + ": the trajectory begins " + core::shown(apart) +
                           " m away from the base at entry + (inserted - length) * direction");
}

}  // namespace trocar::needle
