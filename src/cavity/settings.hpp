#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/csv.hpp"
#include "core/math.hpp"
#include "law/fluid.hpp"

namespace trocar::cavity {

using core::Vec3;

/// How a cavity's pressure acts and what volume it holds (docs/theory.md section 9).
enum class Model {
  linear,   ///< p g_0 on the tissue, volume V_0 + g_0·u
  frozen,   ///< p g_0 on the tissue, volume of the deformed wall (fluid paper)
  follower  ///< p g(u) on the tissue, volume of the deformed wall; has an energy
};

/// How pressures are found.
enum class Solver {
  proportional,  ///< frozen model: p += K_p (V_law - V)/V_0 (fluid paper)
  exact,         ///< frozen model: root of the cubics V_i(p)
  newton         ///< frozen: one Newton step on the cubics per update; other models: see rows.hpp
};

/// Pressure over time: (mean + amplitude sin(2π t / period)) · curve(t).
struct PressureCurve
{
  double mean = 0.0, amplitude = 0.0;  ///< [Pa]
  double period = 1.0;                 ///< [s]
  std::optional<core::Csv> curve{};    ///< columns time, factor

  double at(double t) const;
};

struct CavitySettings
{
  std::string name, surface;
  bool caps = false;  ///< holes of the wall are closed
  Model model = Model::follower;
  Solver solver = Solver::newton;
  law::FluidLaw fluid{};
  PressureCurve pressure{};                  ///< with a fluid of given pressure
  std::optional<core::Csv> volume_curve{};   ///< factor on the amount of fluid (time, factor)
  double volume = 0.0;                       ///< V_f at the start, 0: volume in the mesh [m³]
  std::optional<double> initial_pressure{};  ///< at the start [Pa]; V_f follows from it
  Vec3 weight = Vec3::Zero();                ///< ρ g of the fluid: pressure per length [Pa/m]
  double tolerance = 1e-12;                  ///< of |V - V_law| / V_0
  double gain = 0.0;                         ///< K_p, 0: from a sweep of the cavity at rest [Pa]
  int most_updates = 1000;                   ///< most updates of the pressures in one search
  double alarm = 0.0;  ///< change of pressure that sets the alarm, 0: none [Pa]
};

/// A way for fluid; with a needle it opens when the needle's tip comes through the wall.
struct ConduitSettings
{
  std::string name;
  int from = -1, to = -1;   ///< cavities; -1: outside
  double resistance = 0.0;  ///< [Pa s/m³], 0: closed
  bool valve = false;       ///< flow only from `from` to `to`
  double flow = 0.0;        ///< prescribed, through the needle when there is one [m³/s]
  std::optional<core::Csv> flow_curve{};  ///< factor on `flow` (time, factor)
  int needle = -1;                        ///< needle that opens the conduit, -1: always open
  double needle_radius = 0.0;             ///< [m]
  double gap = 0.0;                       ///< between needle and tissue, 0: none given [m]
  double hole_resistance = 0.0;  ///< of the hole after withdrawal, 0: see hole_radius [Pa s/m³]
  double hole_radius = 0.0;      ///< of the hole as a pipe [m]; both 0: the hole closes
  double viscosity = 1e-3;       ///< [Pa s]
  double length = 0.0;           ///< of gap and hole, 0: of the channel in tissue [m]
};

struct Settings
{
  std::vector<CavitySettings> cavities;
  std::vector<ConduitSettings> conduits;
};

}  // namespace trocar::cavity
