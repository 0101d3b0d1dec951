#pragma once

#include <vector>

#include "core/math.hpp"

namespace trocar::law {

using core::MatX;
using core::VecX;

/// Monotone cubic through points (Fritsch and Carlson 1980), straight beyond its ends.
class MonotoneSpline
{
 public:
  MonotoneSpline() = default;
  /// x ascending, y nowhere rising; two points at least.
  MonotoneSpline(std::vector<double> x, std::vector<double> y);

  struct Value
  {
    double y, slope;
  };
  Value at(double x) const;

 private:
  std::vector<double> x_, y_, slope_;
};

/// What a fluid does: the volume it takes at a pressure, which nowhere rises with the pressure.
struct FluidLaw
{
  enum class Kind {
    pressure,         ///< the pressure is given, any volume will do
    constant_volume,  ///< V = V_f
    bulk,             ///< V = V_f exp(-(p - p_0) / K_f)
    gas,              ///< V = V_f (p_0 + p_a) / (p + p_a), isothermal
    table             ///< V = V_f + spline(p) - spline(p_0)
  };
  Kind kind = Kind::constant_volume;
  double bulk_modulus = 0.0;  ///< K_f [Pa]
  double ambient = 0.0;       ///< absolute pressure p_a where p = 0 [Pa]
  MonotoneSpline table{};     ///< V [m³] over p [Pa]

  struct Answer
  {
    double volume;      ///< V_law(p) [m³]
    double compliance;  ///< D = -dV_law/dp >= 0 [m³/Pa]
    double per_amount;  ///< ∂V_law/∂V_f
  };
  /// V_law and D at p for a fluid that takes V_f = `amount` at p_0 = `reference`. A gas is
  /// continued straight below a tenth of the ambient pressure.
  Answer at(double p, double amount, double reference) const;

  bool compressible() const { return kind == Kind::bulk || kind == Kind::gas; }
  /// Density at p over that at p = 0: a gas (p + p_a)/p_a, a bulk modulus e^(p/K_f), else 1. An
  /// amount V_f at p_0 is V_f times the density there.
  double density(double p) const;
  /// Fluids of two cavities that may flow into each other.
  bool mixes_with(const FluidLaw& other) const;
};

/// A way for fluid between two cavities, or one and outside (-1, where the pressure is 0). It moves
/// amount: the flow at the pressure it comes from times the density there.
struct Conduit
{
  int from = -1, to = -1;
  double conductance = 0.0;                     ///< 1/R [m³/(s Pa)]; 0: closed
  bool valve = false;                           ///< only from `from` to `to`
  double flow = 0.0;                            ///< prescribed flow beside it [m³/s]
  double density_from = 1.0, density_to = 1.0;  ///< of its fluid at either end, over that at p = 0
};

/// What a network does at cavity pressures p.
struct Flows
{
  VecX conduit;      ///< flow from `from` to `to`, at the pressure it comes from (conduits) [m³/s]
  VecX inflow;       ///< of amount into every cavity, at p = 0 [m³/s]
  MatX conductance;  ///< -∂inflow/∂p with the densities held, symmetric positive semidefinite
                     ///< [m³/(s Pa)]
};
Flows network_flows(const std::vector<Conduit>& conduits, const VecX& p);

}  // namespace trocar::law
