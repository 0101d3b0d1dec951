#pragma once

#include <optional>
#include <vector>

#include "cavity/state.hpp"
#include "contact/state.hpp"
#include "insertion/state.hpp"
#include "needle/needle.hpp"
#include "tissue/tissue.hpp"

namespace trocar::step {

/// Energy account [J]: energies stored at the end of a step, and sums since the start.
///   supplied = elastic + kinetic - stored_at_start + friction + cutting + damping
///            + contact + contact_friction + rest.
/// The rest is what backward Euler dissipates, and the error of geometry that a step keeps frozen.
struct EnergyAccount
{
  double elastic = 0.0, kinetic = 0.0;
  double stored_at_start = 0.0;
  double supplied = 0.0;  ///< work of holders, loads, fluids and moving supports
  double friction = 0.0, cutting = 0.0, damping = 0.0;
  double contact = 0.0;           ///< lost where gaps close
  double contact_friction = 0.0;  ///< between bodies

  double rest() const
  {
    return supplied - (elastic + kinetic - stored_at_start) - friction - cutting - damping -
           contact - contact_friction;
  }

  /// Names every member and its unit, see core/visit.hpp.
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
    v("contact", "J", self.contact);
    v("contact_friction", "J", self.contact_friction);
  }
};

/// Error terms of a velocity that is a difference of displacements:
///   v = u'(t) - lag u'' + curvature u''' + O(h³).
struct Differenced
{
  double lag = 0.0;        ///< [s]
  double curvature = 0.0;  ///< [s²]

  /// Names every member and its unit, see core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("lag", "s", self.lag);
    v("curvature", "s^2", self.curvature);
  }
};

/// The state at the start of the last step, as far as BDF2 needs it.
struct PreviousStep
{
  Differenced velocity;
  tissue::TissueState tissue;
  std::vector<needle::NeedleState> needles;

  /// Names every member and its unit, see core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("velocity", "", self.velocity);
    v("tissue", "", self.tissue);
    v("needle", "", self.needles);
  }
};

/// Everything that changes in a run. A value type, so that a rejected step leaves no trace in it.
struct State
{
  double t = 0.0;        ///< time [s]
  double h = 0.0;        ///< length of the step that ended here [s]; 0: start or statics
  Differenced velocity;  ///< error terms of the velocities; 0: exact
  tissue::TissueState tissue;
  std::vector<needle::NeedleState> needles;
  std::vector<insertion::InsertionState> insertions;  ///< by needle
  cavity::State cavities;
  contact::State contact;
  std::optional<PreviousStep> before;  ///< with -time_scheme bdf2 only
  EnergyAccount energy;                ///< kept with -output_energy only

  /// Names every member and its unit, see core/visit.hpp.
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
    v("contact", "", self.contact);
    v("before", "", self.before);
    v("energy", "", self.energy);
  }
};

}  // namespace trocar::step
