#pragma once

#include <vector>

#include "law/problem.hpp"

// Problems of touching bodies with friction cones, made from known answers.
namespace trocar::test {

using law::MatX;
using law::VecX;

/// Compliance of points on a half space; of a rigid body (rank 6) with 1e-3 of a half space's, or
/// alone; of half the rank. Diagonal about 1e-3 m/N.
enum class Cones { half_space, stiff, rigid, half_rank };

struct KnownCones
{
  law::Problem problem;
  VecX lambda, delta;
};

/// 30 % of the groups are open by about 1 mm, 35 % slip by that, the rest sticks; forces about 1 N.
KnownCones known_cones(Cones kind, int groups, double friction, unsigned seed);

}  // namespace trocar::test
