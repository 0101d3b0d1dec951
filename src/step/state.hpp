#pragma once

#include <optional>
#include <vector>

#include "cavity/state.hpp"
#include "insertion/state.hpp"
#include "needle/needle.hpp"
#include "tissue/tissue.hpp"

namespace trocar::step {

/// Where the energy went [J]: what is stored at the end of a step, and sums since the start.
/// supplied = stored - stored at the start + friction + cutting + damping + rest; the rest is what
/// backward Euler loses and what frozen geometry leaves.
struct EnergyAccount
{
  double elastic = 0.0, kinetic = 0.0;
  double stored_at_start = 0.0;
  double supplied = 0.0;  ///< by holders, loads and moving supports
  double friction = 0.0, cutting = 0.0, damping = 0.0;

  double rest() const
  {
    return supplied - (elastic + kinetic - stored_at_start) - friction - cutting - damping;
  }

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("elastic", "J", self.elastic);
    v("kinetic", "J", self.kinetic);
    v("stored_at_start", "J", self.stored_at_start);
    v("supplied", "J", self.supplied);
    v("friction", "J", self.friction);
    v("cutting", "J", self.cutting);
    v("damping", "J", self.damping);
  }
};

/// Velocity as it was differenced from displacements: v = u'(t) - lag u'' + curvature u''' + O(h³).
struct Differenced
{
  double lag = 0.0;        ///< [s]
  double curvature = 0.0;  ///< [s²]

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("lag", "s", self.lag);
    v("curvature", "s^2", self.curvature);
  }
};

/// What BDF2 remembers of the step before.
struct PreviousStep
{
  Differenced velocity;
  tissue::TissueState tissue;
  std::vector<needle::NeedleState> needles;

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("velocity", "", self.velocity);
    v("tissue", "", self.tissue);
    v("needle", "", self.needles);
  }
};

/// All that changes in a run. A value: a rejected step leaves no trace.
struct State
{
  double t = 0.0;        ///< [s]
  double h = 0.0;        ///< length of the step that led here [s]; 0: none in time did
  Differenced velocity;  ///< exact where none did
  tissue::TissueState tissue;
  std::vector<needle::NeedleState> needles;
  std::vector<insertion::InsertionState> insertions;  ///< by needle
  cavity::State cavities;
  std::optional<PreviousStep> before;  ///< with -time_scheme bdf2 only
  EnergyAccount energy;                ///< kept with -output_energy only

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("time", "s", self.t);
    v("step", "s", self.h);
    v("velocity", "", self.velocity);
    v("tissue", "", self.tissue);
    v("needle", "", self.needles);
    v("insertion", "", self.insertions);
    v("cavities", "", self.cavities);
    v("before", "", self.before);
    v("energy", "", self.energy);
  }
};

}  // namespace trocar::step
