#include "driver/option_kinds.hpp"

namespace trocar::driver {
namespace {

std::vector<OptionSpec> wall_and_fluid()
{
  return {
      word("cavity_surface", "", "physical surface that is the cavity's wall"),
      word(
          "cavity_region", "",
          "physical volume whose tets are taken out: its skin is the wall, a surface of that name"),
      flag("cavity_cap", "close holes of the wall by caps between their rims"),
      choice("cavity_law", "constant_volume",
             {"constant_volume", "pressure", "pulse", "bulk", "gas", "table"},
             "what the fluid does: keeps its volume; has a given pressure, constant or pulsing; "
             "volume over pressure by bulk modulus, as a gas, or by a table"),
      {"cavity_pressure", OptionType::real, "0", "Pa", "pressure of law pressure"},
      {"cavity_mean", OptionType::real, "0", "Pa", "mean pressure of law pulse"},
      {"cavity_amplitude", OptionType::real, "0", "Pa", "amplitude of law pulse (a sine)"},
      positive("cavity_period", "1", "s", "period of law pulse"),
      file(
          "cavity_table",
          "CSV (columns pressure,volume in Pa, m^3; nowhere rising, only differences count) of law "
          "table"),
      positive("cavity_bulk_modulus", "2.2e9", "Pa", "bulk modulus of law bulk"),
      positive("cavity_ambient_pressure", "101325", "Pa",
               "absolute pressure where pressures are 0, for law gas"),
      file("cavity_curve",
           "CSV (columns time,factor) that scales a given pressure, or the amount of fluid"),
      not_negative(
          "cavity_volume", "0", "m^3",
          "volume of the fluid at zero pressure; 0 = that of the mesh, else the run starts "
          "in equilibrium"),
      {"cavity_initial_pressure", OptionType::real, "0", "Pa",
       "pressure at the start, in equilibrium; the amount of fluid follows from it"},
      not_negative("cavity_density", "0", "kg/m^3",
                   "density of the fluid: its pressure grows with depth under gravity"),
  };
}

std::vector<OptionSpec> model_and_solver()
{
  return {
      choice("cavity_model", "follower", {"linear", "frozen", "follower"},
             "pressure on the undeformed wall and linear volume; the same with exact volume, as in "
             "the fluid paper; or both as the wall deforms"),
      choice("cavity_solver", "auto", {"auto", "proportional", "exact", "newton"},
             "how pressures are found; frozen: any (auto = exact), others: newton"),
      positive("cavity_tolerance", "1e-12", "1", "volume error as a part of the volume"),
      not_negative("cavity_gain", "0", "Pa",
                   "K_p of solver proportional; 0 = from a sweep of the cavity at rest"),
      count("cavity_max_updates", "1000", 1, 1e9,
            "pressure updates for one linearisation of a step"),
      not_negative("cavity_alarm", "0", "Pa",
                   "change of pressure since the start that sets the alarm; 0 = off"),
  };
}

void add_conduits(std::vector<OptionSpec>& t)
{
  t.push_back(list("conduits", "ways for fluid: NAME:FROM:TO,… between cavities or `outside`"));
  const std::vector<OptionSpec> conduit{
      not_negative("conduit_<conduit>_resistance", "0", "Pa s/m^3",
                   "pressure drop over flow; 0 = closed; with a needle: while it is in"),
      flag("conduit_<conduit>_valve", "flow only from FROM to TO"),
      {"conduit_<conduit>_flow", OptionType::real, "0", "m^3/s",
       "prescribed flow from FROM to TO, through the needle when there is one"},
      file("conduit_<conduit>_curve", "CSV (columns time,factor) that scales the prescribed flow"),
      word("conduit_<conduit>_needle", "",
           "needle that opens the conduit when its tip comes through the wall"),
      not_negative("conduit_<conduit>_gap", "0", "m",
                   "gap around the needle, for the resistance of an annulus; 0 = none"),
      not_negative("conduit_<conduit>_hole_resistance", "0", "Pa s/m^3",
                   "resistance of the hole after withdrawal; 0 = it closes"),
      not_negative("conduit_<conduit>_hole_radius", "0", "m",
                   "radius of the hole, for a pipe's resistance"),
      positive("conduit_<conduit>_viscosity", "1e-3", "Pa s", "viscosity in gap and hole"),
      not_negative("conduit_<conduit>_length", "0", "m",
                   "length of gap and hole; 0 = the needle's way through tissue"),
  };
  t.insert(t.end(), conduit.begin(), conduit.end());
}

}  // namespace

void add_cavity_options(std::vector<OptionSpec>& t)
{
  t.push_back(list("cavities", "names of the fluid-filled cavities"));
  for (const OptionSpec& spec : wall_and_fluid()) with_override(t, spec, "<cavity>");
  for (const OptionSpec& spec : model_and_solver()) with_override(t, spec, "<cavity>");
  add_conduits(t);
  t.push_back(word("pv_cavity", "", "cavity of -analysis pv_curve; by default the first"));
  t.push_back(positive("pv_low", "0.7", "1", "smallest volume of the curve, part of the mesh's"));
  t.push_back(positive("pv_high", "1.3", "1", "largest one"));
  t.push_back(count("pv_points", "25", 3, 10000, "points of the curve"));
  t.push_back(count("pv_pieces", "4", 1, 1000, "straight pieces of the second fit"));
}

}  // namespace trocar::driver
