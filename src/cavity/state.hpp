#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::cavity {

using core::MatX;
using core::Vec3;
using core::VecX;

/// State of one cavity. A value, equal on every rank.
struct CavityState
{
  double pressure = 0.0;        ///< at the reference point of its wall [Pa]
  double amount = 0.0;          ///< V_f: volume of the fluid at its reference pressure [m³]
  double whole = 0.0;           ///< amount that the volume curve scales [m³]
  double start_pressure = 0.0;  ///< pressure after the start, for the alarm [Pa]
  double reference = 0.0;       ///< pressure at which the fluid's volume is `amount` [Pa]
  bool given = false;           ///< the pressure is given: always, or only at the start
  bool held = false;            ///< the amount is held whatever the fluid (P-V curves)

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("pressure", "Pa", self.pressure);
    v("amount", "m^3", self.amount);
    v("whole", "m^3", self.whole);
    v("start_pressure", "Pa", self.start_pressure);
    v("reference", "Pa", self.reference);
    v("given", "1", self.given);
    v("held", "1", self.held);
  }
};

struct ConduitState
{
  bool pierced = false;    ///< a needle has come through the wall
  bool needle_in = false;  ///< the needle is in every cavity that the conduit joins
  double channel = 0.0;    ///< length of the needle's way through tissue to the wall [m]
  double flow = 0.0;       ///< from `from` to `to` [m³/s]
  double moved = 0.0;      ///< volume that has flowed since the start [m³]

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("pierced", "1", self.pierced);
    v("needle_in", "1", self.needle_in);
    v("channel", "m", self.channel);
    v("flow", "m^3/s", self.flow);
    v("moved", "m^3", self.moved);
  }
};

struct State
{
  std::vector<CavityState> cavity;
  std::vector<ConduitState> conduit;

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("cavity", "", self.cavity);
    v("conduit", "", self.conduit);
  }
};

/// A part of a needle's path that lies in no tissue.
struct VoidPiece
{
  Vec3 place;      ///< point of the needle in the middle of that part [m]
  double channel;  ///< length of tissue that the path crosses before this void [m]
};

/// Vertex coordinates by wall, each counted from the wall's reference point [m].
using Shape = std::vector<VecX>;

/// What one cavity did in a step.
struct CavityReport
{
  double pressure = 0.0, volume = 0.0;  ///< [Pa], [m³] of the deformed wall
  double error = 0.0;                   ///< |V - V_law| / V_0, of the deformed wall
  int iterations = 0;                   ///< linearisations or pressure updates, whichever are more
  bool alarm = false;
};

}  // namespace trocar::cavity
