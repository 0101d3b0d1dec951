#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::law {

using core::MatX;
using core::VecX;

/// Monotone cubic spline through points (Fritsch and Carlson 1980), with straight lines beyond its
/// ends.
class MonotoneSpline
{
 public:
  MonotoneSpline() = default;
  /// x ascending, y never rising; at least two points.
  MonotoneSpline(std::vector<double> x, std::vector<double> y);

  struct Value
  {
    double y, slope;
  };
  Value at(double x) const;

 private:
  std::vector<double> x_, y_, slope_;
};

/// Law of a fluid: its volume V_law(p), which never rises with the pressure p (theory 9). V_f is
/// the volume at the reference pressure p_0.
struct FluidLaw
{
  enum class Kind {
    pressure,         ///< the pressure is given, the volume is free
    constant_volume,  ///< V = V_f
    bulk,             ///< V = V_f exp(-(p - p_0) / K_f)
    gas,              ///< V = V_f (p_0 + p_a) / (p + p_a), isothermal
    table             ///< V = V_f + spline(p) - spline(p_0)
  };
  Kind kind = Kind::constant_volume;
  double bulk_modulus = 0.0;  ///< K_f [Pa]
  double ambient = 0.0;       ///< p_a, the absolute pressure at p = 0 [Pa]
  MonotoneSpline table{};     ///< V [m³] over p [Pa]

  struct Answer
  {
    double volume;      ///< V_law(p) [m³]
    double compliance;  ///< D = -dV_law/dp >= 0 [m³/Pa]
    double per_amount;  ///< ∂V_law/∂V_f [1]
  };
  /// V_law and D at p, for a fluid whose volume at p_0 = `reference` [Pa] is V_f = `amount` [m³].
  /// Below an absolute pressure of p_a / 10 the law of a gas is continued by its tangent.
  Answer at(double p, double amount, double reference) const;

  bool compressible() const { return kind == Kind::bulk || kind == Kind::gas; }
  /// Density at p over that at p = 0 [1]: (p + p_a)/p_a of a gas, e^(p/K_f) with a bulk modulus,
  /// else 1. A fluid of volume V_f at p_0 has the volume V_f · density(p_0) at p = 0.
  double density(double p) const;
  /// True when a conduit may join cavities with these two fluids.
  bool mixes_with(const FluidLaw& other) const;
};

/// A conduit between two cavities, or between a cavity and the outside (-1, where the pressure is
/// 0). The amount that it moves is the volume which the fluid has at p = 0: the volume flow at the
/// upstream pressure times the upstream density.
struct Conduit
{
  int from = -1, to = -1;
  double conductance = 0.0;  ///< 1/R [m³/(s Pa)]; 0: closed
  bool valve = false;        ///< 1/R acts only while the pressure at `from` is higher
  double flow = 0.0;         ///< prescribed flow, added to the flow through 1/R [m³/s]
  double density_from = 1.0, density_to = 1.0;  ///< `FluidLaw::density` at either end [1]
};

/// Flows of a network at the cavity pressures p.
struct Flows
{
  VecX conduit;  ///< volume flow from `from` to `to` at the upstream pressure (conduits) [m³/s]
  VecX inflow;   ///< flow of amount into every cavity (cavities) [m³/s at p = 0]
  /// -∂inflow/∂p at fixed densities (cavities x cavities), symmetric positive semidefinite
  /// [m³/(s Pa)].
  MatX conductance;
};
Flows network_flows(const std::vector<Conduit>& conduits, const VecX& p);

}  // namespace trocar::law
