#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "cavity/cavities.hpp"

// Cavities in the constraint system: what their fluids hold, and what a step leaves.
namespace trocar::cavity {

/// The edge as the network sees it at time t. Gap: a thin annulus between plates, hole: a pipe
/// (Poiseuille).
law::Edge Cavities::edge(int e, const State& state, double t) const
{
  const EdgeSettings& one = settings_.edges[index(e)];
  const EdgeState& now = state.edge[index(e)];
  // A needle that comes along a void has hardly a channel: then the opening itself resists.
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
  law::Edge edge{one.from, one.to, resistance > 0.0 ? 1.0 / resistance : 0.0, one.valve, 0.0};
  if (one.flow != 0.0 && (one.needle < 0 || now.needle_in))
    edge.flow = one.flow * (one.flow_curve ? core::interpolate(*one.flow_curve, 1, t) : 1.0);
  return edge;
}

/// What the network does at pressures p. An edge carries the fluid of its compressible end.
law::Flows Cavities::flows(const State& state, const VecX& p, double t) const
{
  std::vector<law::Edge> edges;
  for (int e = 0; e < static_cast<int>(settings_.edges.size()); ++e) {
    law::Edge one = edge(e, state, t);
    for (int end : {one.from, one.to}) {
      if (end < 0 || !law_of(end, state).compressible()) continue;
      const law::FluidLaw& carried = law_of(end, state);
      one.density_from = carried.density(one.from >= 0 ? p[one.from] : 0.0);
      one.density_to = carried.density(one.to >= 0 ? p[one.to] : 0.0);
    }
    edges.push_back(one);
  }
  return law::network_flows(edges, p);
}

/// An amount at p = 0 as the cavity counts its own, at its reference pressure [m³].
double Cavities::amount_at_reference(int i, const State& state, double at_zero) const
{
  return at_zero / law_of(i, state).density(state.cavity[index(i)].reference);
}

// ∂V_law,i/∂p_j of the network is h L_ij / ρ_i with its Laplacian L and the densities ρ. In the
// compliance it is h L_ij / √(ρ_i ρ_j), symmetric positive semidefinite as rows must be and right
// where densities are equal; the fluids are linearised until they settle, so that the answer is
// exact.
Fluid Cavities::fluid(const State& state, const VecX& p, const TimeStep& now) const
{
  Fluid fluid{VecX::Zero(size()), MatX::Zero(size(), size()), VecX::Zero(size())};
  const bool flowing = !settings_.edges.empty() && !now.start;
  law::Flows network;
  if (flowing) network = flows(state, p, now.t);
  VecX root = VecX::Ones(size());  // of the densities
  for (int i = 0; i < size(); ++i) {
    const CavityState& mine = state.cavity[index(i)];
    const law::FluidLaw& law = law_of(i, state);
    const double V0 = walls_[index(i)].volume();
    const double more = flowing ? amount_at_reference(i, state, now.h * network.inflow[i]) : 0.0;
    const auto answer = law.at(p[i], mine.amount + more, mine.reference);
    fluid.volume[i] = V0 + now.load * (answer.volume - V0);
    fluid.compliance(i, i) = now.load * answer.compliance;
    root[i] = std::sqrt(law.density(p[i]));
  }
  if (!flowing) return fluid;
  const MatX by_volume =
      root.cwiseInverse().asDiagonal() * network.conductance * root.cwiseInverse().asDiagonal();
  fluid.compliance += now.h * by_volume;
  fluid.round_off = 1e-15 * now.h * (by_volume.cwiseAbs() * p.cwiseAbs());
  return fluid;
}

/// V_0 + g_0·u [m³].
double Cavities::linear_volume(int i, const OwnedField& u) const
{
  const Wall& wall = walls_[index(i)];
  return wall.volume() + wall.area() * space_->dot(undeformed_probe_[index(i)]->vector, u);
}

CavityRows Cavities::add_rows(const State& state, const Shape& shape, const OwnedField& u,
                              const TimeStep& now, constraint::Set& set)
{
  CavityRows rows;
  rows.first = set.size();
  int point = set.empty() ? 0 : set.rows().back().point + 1;
  std::vector<double> held;
  for (int i = 0; i < size(); ++i) {
    const CavitySettings& one = settings_.cavities[index(i)];
    if (one.model == Model::frozen || state.cavity[index(i)].given) continue;
    const Wall& wall = walls_[index(i)];
    std::shared_ptr<const solve::WideProbe> probe = undeformed_probe_[index(i)];
    if (one.model == Model::follower)
      probe = std::make_shared<solve::WideProbe>(solve::WideProbe{
          i, wall.to_nodes(gradient(i, shape) / wall.area(), *space_), ++versions_});
    held.push_back(one.model == Model::follower ? law::volume(wall.surface(), shape[index(i)])
                                                : linear_volume(i, u));
    constraint::Row row;
    row.wide = set.add_wide(std::move(probe));
    row.start = state.cavity[index(i)].pressure * wall.area();
    row.point = point++;
    set.add(row);
    rows.cavity.push_back(i);
  }
  rows.held = Eigen::Map<VecX>(held.data(), static_cast<Eigen::Index>(held.size()));
  rows.pressure = pressures(state);
  rows.fluid = fluid(state, rows.pressure, now);
  rows.state = state;
  rows.now = now;
  set_gaps(rows, set);
  return rows;
}

/// δ = (V - V_law(p))/area, linear in the pressures about those of the rows.
void Cavities::set_gaps(const CavityRows& rows, constraint::Set& set) const
{
  const auto count = static_cast<int>(rows.cavity.size());
  if (count == 0) return;
  std::erase_if(set.couplings(), [&](const auto& c) { return c.i >= rows.first; });
  for (int k = 0; k < count; ++k) {
    const int i = rows.cavity[index(k)];
    double gap = rows.held[k] - rows.fluid.volume[i];
    for (int l = 0; l < count; ++l) {
      const int j = rows.cavity[index(l)];
      gap -= rows.fluid.compliance(i, j) * rows.pressure[j];
      if (l <= k && rows.fluid.compliance(i, j) != 0.0)
        set.couplings().push_back(
            {rows.first + k, rows.first + l,
             rows.fluid.compliance(i, j) / walls_[index(i)].area() / walls_[index(j)].area()});
    }
    set.set_gap(rows.first + k, gap / walls_[index(i)].area());
  }
}

int Cavities::drained(const Fluid& fluid)
{
  for (Eigen::Index i = 0; i < fluid.volume.size(); ++i)
    if (fluid.volume[i] < 0.0 && fluid.compliance(i, i) < 0.0) return static_cast<int>(i);
  return -1;
}

bool Cavities::refresh(const VecX& lambda, CavityRows& rows, constraint::Set& set) const
{
  if (rows.cavity.empty()) return false;
  VecX p = rows.pressure;
  for (std::size_t k = 0; k < rows.cavity.size(); ++k) {
    const int i = rows.cavity[k];
    p[i] = lambda[rows.first + static_cast<Eigen::Index>(k)] / walls_[index(i)].area();
  }
  Fluid there = fluid(rows.state, p, rows.now);
  // Pressures at which a fluid would have flowed out whole lie beyond the answer.
  constexpr int most_halvings = 30;
  for (int k = 0; k < most_halvings && drained(there) >= 0; ++k) {
    p = 0.5 * (p + rows.pressure);
    there = fluid(rows.state, p, rows.now);
  }
  const VecX expected = rows.fluid.volume - rows.fluid.compliance * (p - rows.pressure);
  bool right = true;
  for (int i : rows.cavity)
    right = right && std::abs(there.volume[i] - expected[i]) <=
                         1e-13 * walls_[index(i)].volume() + there.round_off[i];
  if (right) return false;
  rows.pressure = p;
  rows.fluid = there;
  set_gaps(rows, set);
  return true;
}

void Cavities::take(const CavityRows& rows, const VecX& lambda, const TimeStep& now,
                    State& state) const
{
  for (int i = 0; i < size(); ++i)
    if (state.cavity[index(i)].given) state.cavity[index(i)].pressure = given_pressure(i, now);
  for (std::size_t k = 0; k < rows.cavity.size(); ++k) {
    const int i = rows.cavity[k];
    state.cavity[index(i)].pressure =
        lambda[rows.first + static_cast<Eigen::Index>(k)] / walls_[index(i)].area();
  }
}

bool Cavities::closed(const State& state, const Shape& shape, const TimeStep& now) const
{
  const VecX V = volumes(shape);
  const Fluid fluids = fluid(state, pressures(state), now);
  for (int i = 0; i < size(); ++i) {
    const CavitySettings& one = settings_.cavities[index(i)];
    if (one.model == Model::linear || state.cavity[index(i)].given) continue;
    const double V0 = walls_[index(i)].volume();
    if (!(std::abs(V[i] - fluids.volume[i]) <= one.tolerance * V0 + fluids.round_off[i]))
      return false;
  }
  return true;
}

std::vector<CavityReport> Cavities::accept(State& state, const OwnedField& u, const Shape& shape,
                                           const TimeStep& now) const
{
  const VecX V = volumes(shape);
  const VecX p = pressures(state);
  const Fluid fluids = fluid(state, p, now);
  std::vector<CavityReport> reports;
  const bool starts = now.start && now.load >= 1.0;
  for (int i = 0; i < size(); ++i) {
    const CavitySettings& one = settings_.cavities[index(i)];
    CavityState& mine = state.cavity[index(i)];
    CavityReport report{p[i], V[i], 0.0, 0, false};
    if (!mine.given) report.error = std::abs(V[i] - fluids.volume[i]) / walls_[index(i)].volume();
    if (starts) {
      mine.start_pressure = p[i];
      if (mine.given && one.fluid.kind != law::FluidLaw::Kind::pressure) {
        mine.given = false;
        mine.amount = one.model == Model::linear ? linear_volume(i, u) : V[i];
        mine.whole = mine.amount;
        mine.reference = p[i];
      }
    }
    report.alarm = one.alarm > 0.0 && std::abs(p[i] - mine.start_pressure) >= one.alarm;
    reports.push_back(report);
  }
  if (settings_.edges.empty() || now.start) return reports;
  const law::Flows network = flows(state, p, now.t);
  for (std::size_t e = 0; e < state.edge.size(); ++e) {
    state.edge[e].flow = network.edge[static_cast<Eigen::Index>(e)];
    state.edge[e].moved += now.h * state.edge[e].flow;
  }
  for (int i = 0; i < size(); ++i)
    state.cavity[index(i)].amount += amount_at_reference(i, state, now.h * network.inflow[i]);
  return reports;
}

}  // namespace trocar::cavity
