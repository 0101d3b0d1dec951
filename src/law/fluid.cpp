#include "law/fluid.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::law {

MonotoneSpline::MonotoneSpline(std::vector<double> x, std::vector<double> y)
    : x_(std::move(x)), y_(std::move(y)), slope_(x_.size(), 0.0)
{
  const std::size_t last = x_.size() - 1;
  std::vector<double> secant;
  for (std::size_t i = 0; i < last; ++i)
    secant.push_back((y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]));
  slope_.front() = secant.front();
  slope_.back() = secant.back();
  for (std::size_t i = 1; i < last; ++i)
    if (secant[i - 1] * secant[i] > 0.0) slope_[i] = 0.5 * (secant[i - 1] + secant[i]);
  for (std::size_t i = 0; i < last; ++i) {
    if (secant[i] == 0.0) {
      slope_[i] = slope_[i + 1] = 0.0;
      continue;
    }
    const double a = slope_[i] / secant[i], b = slope_[i + 1] / secant[i];
    const double size = std::hypot(a, b);
    if (size <= 3.0) continue;
    slope_[i] = 3.0 / size * a * secant[i];
    slope_[i + 1] = 3.0 / size * b * secant[i];
  }
}

MonotoneSpline::Value MonotoneSpline::at(double x) const
{
  if (x <= x_.front()) return {y_.front() + slope_.front() * (x - x_.front()), slope_.front()};
  if (x >= x_.back()) return {y_.back() + slope_.back() * (x - x_.back()), slope_.back()};
  const auto i =
      static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin() - 1);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
  const double rise = y_[i + 1] - y_[i];
  const double value = y_[i] + rise * t * t * (3.0 - 2.0 * t) +
                       h * t * (1.0 - t) * (slope_[i] * (1.0 - t) - slope_[i + 1] * t);
  const double slope = 6.0 * rise / h * t * (1.0 - t) + slope_[i] * (1.0 - t) * (1.0 - 3.0 * t) +
                       slope_[i + 1] * t * (3.0 * t - 2.0);
  return {value, slope};
}

FluidLaw::Answer FluidLaw::at(double p, double amount, double reference) const
{
  switch (kind) {
    case Kind::bulk: {
      const double share = std::exp((reference - p) / bulk_modulus);
      return {amount * share, amount * share / bulk_modulus, share};
    }
    case Kind::gas: {
      const double absolute = std::max(p + ambient, 0.1 * ambient);
      const double share = (reference + ambient) / absolute;
      const double D = amount * share / absolute;
      const double beyond = p + ambient - absolute;
      return {amount * share - D * beyond, D, share * (1.0 - beyond / absolute)};
    }
    case Kind::table: {
      const MonotoneSpline::Value here = table.at(p);
      return {amount + here.y - table.at(reference).y, -here.slope, 1.0};
    }
    default:
      return {amount, 0.0, 1.0};
  }
}

double FluidLaw::density(double p) const
{
  if (!compressible()) return 1.0;
  return 1.0 / at(p, 1.0, 0.0).per_amount;
}

bool FluidLaw::mixes_with(const FluidLaw& other) const
{
  // A cavity of given pressure is a reservoir of any fluid.
  if (kind == Kind::pressure || other.kind == Kind::pressure) return true;
  if (!compressible() && !other.compressible()) return true;
  return kind == other.kind && bulk_modulus == other.bulk_modulus && ambient == other.ambient;
}

Flows network_flows(const std::vector<Conduit>& conduits, const VecX& p)
{
  Flows flows{VecX::Zero(static_cast<Eigen::Index>(conduits.size())), VecX::Zero(p.size()),
              MatX::Zero(p.size(), p.size())};
  for (std::size_t e = 0; e < conduits.size(); ++e) {
    const Conduit& conduit = conduits[e];
    const double drop =
        (conduit.from >= 0 ? p[conduit.from] : 0.0) - (conduit.to >= 0 ? p[conduit.to] : 0.0);
    const double conductance = conduit.valve && drop <= 0.0 ? 0.0 : conduit.conductance;
    const double flow = conductance * drop + conduit.flow;
    flows.conduit[static_cast<Eigen::Index>(e)] = flow;
    const double density = flow >= 0.0 ? conduit.density_from : conduit.density_to;
    const double amount = density * flow, by_drop = density * conductance;
    if (conduit.from >= 0) {
      flows.inflow[conduit.from] -= amount;
      flows.conductance(conduit.from, conduit.from) += by_drop;
    }
    if (conduit.to >= 0) {
      flows.inflow[conduit.to] += amount;
      flows.conductance(conduit.to, conduit.to) += by_drop;
    }
    if (conduit.from >= 0 && conduit.to >= 0) {
      flows.conductance(conduit.from, conduit.to) -= by_drop;
      flows.conductance(conduit.to, conduit.from) -= by_drop;
    }
  }
  return flows;
}

}  // namespace trocar::law
