#include "cavity/network.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trocar::cavity {
namespace {

const law::FluidLaw& law_of(const Cavities& cavities, int i, const State& state)
{
  static const law::FluidLaw constant_volume;
  return state.cavity[index(i)].held ? constant_volume : cavities.one(i).fluid;
}

/// The conduit at time t, as the network needs it. A gap is a thin annulus with the resistance of
/// flow between plates, a hole is a pipe (Poiseuille).
law::Conduit conduit_at(const Cavities& cavities, int e, const State& state, double t)
{
  const ConduitSettings& one = cavities.settings().conduits[index(e)];
  const ConduitState& now = state.conduit[index(e)];
  // A needle that arrives through a void has hardly any channel in tissue: then the opening itself
  // resists, like a channel as long as the needle's radius.
  const double length = one.length > 0.0 ? one.length : std::max(now.channel, one.needle_radius);
  double resistance = one.resistance;
  if (one.needle >= 0 && now.needle_in && one.gap > 0.0)
    resistance = 6.0 * one.viscosity * length /
                 (std::numbers::pi * one.needle_radius * std::pow(one.gap, 3));
  if (one.needle >= 0 && !now.needle_in) {
    resistance = now.pierced ? one.hole_resistance : 0.0;
    if (now.pierced && one.hole_radius > 0.0)
      resistance = 8.0 * one.viscosity * length / (std::numbers::pi * std::pow(one.hole_radius, 4));
  }
  law::Conduit conduit{one.from, one.to, resistance > 0.0 ? 1.0 / resistance : 0.0, one.valve, 0.0};
  if (one.flow != 0.0 && (one.needle < 0 || now.needle_in))
    conduit.flow = one.flow * (one.flow_curve ? core::interpolate(*one.flow_curve, 1, t) : 1.0);
  return conduit;
}

/// Flows of the network at pressures p. A conduit carries the fluid of its compressible end.
law::Flows flows(const Cavities& cavities, const State& state, const VecX& p, double t)
{
  std::vector<law::Conduit> conduits;
  for (int e = 0; e < static_cast<int>(cavities.settings().conduits.size()); ++e) {
    law::Conduit one = conduit_at(cavities, e, state, t);
    for (int end : {one.from, one.to}) {
      if (end < 0 || !law_of(cavities, end, state).compressible()) continue;
      const law::FluidLaw& carried = law_of(cavities, end, state);
      one.density_from = carried.density(one.from >= 0 ? p[one.from] : 0.0);
      one.density_to = carried.density(one.to >= 0 ? p[one.to] : 0.0);
    }
    conduits.push_back(one);
  }
  return law::network_flows(conduits, p);
}

/// Converts an amount of fluid counted at p = 0 to the cavity's reference pressure [m³].
double amount_at_reference(const Cavities& cavities, int i, const State& state, double at_zero)
{
  return at_zero / law_of(cavities, i, state).density(state.cavity[index(i)].reference);
}

}  // namespace

// The network's part of -∂V_law,i/∂p_j is h L_ij / ρ_i, with its Laplacian L and the densities ρ.
// The compliance has h L_ij / √(ρ_i ρ_j) instead. This is symmetric positive semidefinite, as rows
// need it, and equal to the former where densities are equal. The fluids are linearised again until
// they settle, so the result is exact all the same.
Fluid fluid(const Cavities& cavities, const State& state, const VecX& p, const TimeStep& now)
{
  Fluid result{VecX::Zero(cavities.size()), MatX::Zero(cavities.size(), cavities.size()),
               VecX::Zero(cavities.size())};
  const bool flowing = !cavities.settings().conduits.empty() && !now.start;
  law::Flows network;
  if (flowing) network = flows(cavities, state, p, now.t);
  VecX root = VecX::Ones(cavities.size());  // square roots of the densities
  for (int i = 0; i < cavities.size(); ++i) {
    const CavityState& mine = state.cavity[index(i)];
    const law::FluidLaw& law = law_of(cavities, i, state);
    const double V0 = cavities.wall(i).volume();
    const double more =
        flowing ? amount_at_reference(cavities, i, state, now.h * network.inflow[i]) : 0.0;
    const auto answer = law.at(p[i], mine.amount + more, mine.reference);
    result.volume[i] = V0 + now.load * (answer.volume - V0);
    result.compliance(i, i) = now.load * answer.compliance;
    root[i] = std::sqrt(law.density(p[i]));
  }
  if (!flowing) return result;
  const MatX by_volume =
      root.cwiseInverse().asDiagonal() * network.conductance * root.cwiseInverse().asDiagonal();
  result.compliance += now.h * by_volume;
  result.round_off = 1e-15 * now.h * (by_volume.cwiseAbs() * p.cwiseAbs());
  return result;
}

int drained(const Fluid& fluid)
{
  for (Eigen::Index i = 0; i < fluid.volume.size(); ++i)
    if (fluid.volume[i] < 0.0 && fluid.compliance(i, i) < 0.0) return static_cast<int>(i);
  return -1;
}

double linear_volume(const Cavities& cavities, int i, const OwnedField& u)
{
  const Wall& wall = cavities.wall(i);
  return wall.volume() +
         wall.area() * cavities.space().dot(cavities.undeformed_probe(i)->vector, u);
}

State start(const Cavities& cavities)
{
  State state;
  for (int i = 0; i < cavities.size(); ++i) {
    const CavitySettings& one = cavities.one(i);
    CavityState cavity;
    cavity.whole = one.volume > 0.0 ? one.volume : cavities.wall(i).volume();
    cavity.amount = cavity.whole;
    if (one.volume_curve) cavity.amount *= core::interpolate(*one.volume_curve, 1, 0.0);
    cavity.given =
        one.fluid.kind == law::FluidLaw::Kind::pressure || one.initial_pressure.has_value();
    state.cavity.push_back(cavity);
  }
  state.conduit.resize(cavities.settings().conduits.size());
  return state;
}

namespace {

/// The first of the stretches in `voids` that lies inside the cavity's wall; null: none.
const VoidPiece* entered(const Cavities& cavities, int cavity, const std::vector<VoidPiece>& voids,
                         const Shape& shape)
{
  const Wall& wall = cavities.wall(cavity);
  for (const VoidPiece& piece : voids)
    if (wall.holds(piece.place - wall.reference(), shape[index(cavity)])) return &piece;
  return nullptr;
}

}  // namespace

State advance(const Cavities& cavities, const State& old, const Between& step, const OwnedField& u)
{
  State next = old;
  for (int i = 0; i < cavities.size(); ++i) {
    const auto& curve = cavities.one(i).volume_curve;
    CavityState& mine = next.cavity[index(i)];
    if (curve)
      mine.amount += mine.whole * (core::interpolate(*curve, 1, step.t) -
                                   core::interpolate(*curve, 1, step.t_old));
  }
  Shape now;  // made only when a needle is in some void
  for (std::size_t e = 0; e < cavities.settings().conduits.size(); ++e) {
    const ConduitSettings& conduit = cavities.settings().conduits[e];
    if (conduit.needle < 0) continue;
    ConduitState& state = next.conduit[e];
    const std::vector<VoidPiece>& mine = step.voids[index(conduit.needle)];
    // True in the end when every cavity that the conduit joins has a stretch of the needle inside.
    state.needle_in = !mine.empty();
    if (mine.empty()) continue;
    if (now.empty()) now = cavities.shape(u);
    for (int i : {conduit.from, conduit.to}) {
      if (i < 0) continue;
      const VoidPiece* piece = entered(cavities, i, mine, now);
      state.needle_in = state.needle_in && piece;
      if (piece && !state.pierced) state.channel = piece->channel;
    }
    state.pierced = state.pierced || state.needle_in;
  }
  return next;
}

bool closed(const Cavities& cavities, const State& state, const Shape& shape, const TimeStep& now)
{
  const VecX V = cavities.volumes(shape);
  const Fluid fluids = fluid(cavities, state, pressures(state), now);
  for (int i = 0; i < cavities.size(); ++i) {
    const CavitySettings& one = cavities.one(i);
    if (one.model == Model::linear || state.cavity[index(i)].given) continue;
    const double V0 = cavities.wall(i).volume();
    if (!(std::abs(V[i] - fluids.volume[i]) <= one.tolerance * V0 + fluids.round_off[i]))
      return false;
  }
  return true;
}

std::vector<CavityReport> accept(const Cavities& cavities, const Configuration& end, State& state)
{
  const TimeStep& now = end.now;
  const VecX V = cavities.volumes(end.shape);
  const VecX p = pressures(state);
  const Fluid fluids = fluid(cavities, state, p, now);
  std::vector<CavityReport> reports;
  const bool starts = now.start && now.load >= 1.0;
  for (int i = 0; i < cavities.size(); ++i) {
    const CavitySettings& one = cavities.one(i);
    CavityState& mine = state.cavity[index(i)];
    CavityReport report{p[i], V[i], 0.0, 0, false};
    if (!mine.given) report.error = std::abs(V[i] - fluids.volume[i]) / cavities.wall(i).volume();
    if (starts) {
      mine.start_pressure = p[i];
      if (mine.given && one.fluid.kind != law::FluidLaw::Kind::pressure) {
        mine.given = false;
        mine.amount = one.model == Model::linear ? linear_volume(cavities, i, end.u) : V[i];
        mine.whole = mine.amount;
        mine.reference = p[i];
      }
    }
    report.alarm = one.alarm > 0.0 && std::abs(p[i] - mine.start_pressure) >= one.alarm;
    reports.push_back(report);
  }
  if (cavities.settings().conduits.empty() || now.start) return reports;
  const law::Flows network = flows(cavities, state, p, now.t);
  for (std::size_t e = 0; e < state.conduit.size(); ++e) {
    state.conduit[e].flow = network.conduit[static_cast<Eigen::Index>(e)];
    state.conduit[e].moved += now.h * state.conduit[e].flow;
  }
  for (int i = 0; i < cavities.size(); ++i)
    state.cavity[index(i)].amount +=
        amount_at_reference(cavities, i, state, now.h * network.inflow[i]);
  return reports;
}

void hold_volume(int cavity, double volume, State& state)
{
  CavityState& mine = state.cavity[index(cavity)];
  mine.held = true;
  mine.given = false;
  mine.amount = volume;
}

}  // namespace trocar::cavity
