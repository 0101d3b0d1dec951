#pragma once

#include <vector>

#include "cavity/settings.hpp"
#include "contact/settings.hpp"
#include "insertion/ground.hpp"
#include "law/compare.hpp"
#include "mesh/mesh.hpp"
#include "needle/needle.hpp"
#include "tissue/tissue.hpp"

namespace trocar::step {

/// How a scene moves through time.
struct TimeSettings
{
  bool is_static = false;  ///< a sequence of static equilibria, without inertia
  double step = 0.01;      ///< h [s]; T/h is a whole number
  double end = 0.0;        ///< T [s]
  double asked = 0.01;     ///< h as the user gave it [s]
  bool start_in_equilibrium = false;
  bool second_order = false;  ///< BDF2 instead of backward Euler
  int newton_max = 0;         ///< most linearisations per dynamic step; 0: as many as needed
  int direction_max = 1;      ///< most solves per linearisation, each with new row directions
};

/// Number of steps of full length from the start to the end.
long step_count(const TimeSettings& time);

/// The bodies, the loads on them and the laws between them, in SI units.
struct Scene
{
  mesh::Mesh mesh;
  TimeSettings time;
  tissue::TissueSettings tissue;
  std::vector<needle::NeedleSettings> needles;
  insertion::InsertionSettings insertion;
  cavity::Settings cavities;
  contact::Settings contact;
  law::Settings laws;
  std::vector<law::BenchmarkCase> compare;  ///< solvers timed on the same dense problems
  bool energy = false;                      ///< keep the energy account
  bool stale_error = false;                 ///< report the error of steps with a stale compliance
};

}  // namespace trocar::step
