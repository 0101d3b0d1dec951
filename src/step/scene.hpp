#pragma once

#include <vector>

#include "cavity/settings.hpp"
#include "insertion/ground.hpp"
#include "law/compare.hpp"
#include "mesh/mesh.hpp"
#include "needle/needle.hpp"
#include "tissue/tissue.hpp"

namespace trocar::step {

/// How a scene moves through time.
struct TimeSettings
{
  bool is_static = false;  ///< a path of equilibria instead of motion
  double step = 0.01;      ///< h [s]: T over a whole number
  double end = 0.0;        ///< T [s]
  double asked = 0.01;     ///< h as it was asked for [s]
  bool start_in_equilibrium = false;
  bool second_order = false;  ///< BDF2 instead of backward Euler
  int newton_max = 0;         ///< linearisations per dynamic step; 0: as many as it takes
  int direction_max = 1;      ///< updates of the constraint directions per linearisation
};

/// Number of steps to the end.
long step_count(const TimeSettings& time);

/// Bodies, what acts on them and the laws between them, in SI units.
struct Scene
{
  mesh::Mesh mesh;
  TimeSettings time;
  tissue::TissueSettings tissue;
  std::vector<needle::NeedleSettings> needles;
  insertion::InsertionSettings insertion;
  cavity::Settings cavities;
  law::Settings laws;
  std::vector<law::BenchmarkCase> compare;  ///< solvers to be timed beside it
  bool energy = false;                      ///< keep the energy account
  bool stale_error = false;                 ///< solve steps with a stale compliance exactly as well
};

}  // namespace trocar::step
