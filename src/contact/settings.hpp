#pragma once

#include <limits>
#include <string>
#include <vector>

#include "contact/obstacle.hpp"

namespace trocar::contact {

/// A pair of `-contact_pairs`.
struct PairSettings
{
  std::string name;
  std::string slave;   ///< physical surface
  std::string master;  ///< physical surface or obstacle
  double friction = 0.0;
  double shear_limit = std::numeric_limits<double>::infinity();  ///< [Pa]
  bool closed = true;   ///< an overlap at the start counts as a closed gap without force
  double search = 0.0;  ///< farthest distance that is looked at [m]; 0: one edge of the slave
};

struct Settings
{
  std::vector<PairSettings> pairs;
  std::vector<Obstacle> obstacles;
};

}  // namespace trocar::contact
