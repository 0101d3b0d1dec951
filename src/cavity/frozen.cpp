#include <algorithm>
#include <cmath>
#include <limits>

#include "cavity/cavities.hpp"
#include "core/words.hpp"

// Pressures of frozen cavities: the load does not follow the wall but the volume is exact, so that
// the pressure is sought outside the (symmetric) constraint system, as in the fluid paper.
namespace trocar::cavity {
namespace {

constexpr int most_newton = 100;

}  // namespace

std::vector<int> Cavities::frozen(const State& state) const
{
  std::vector<int> list;
  for (int i = 0; i < size(); ++i)
    if (settings_.cavities[index(i)].model == Model::frozen && !state.cavity[index(i)].given)
      list.push_back(i);
  return list;
}

OwnedField Cavities::unit_load(int cavity) const
{
  return walls_[index(cavity)].to_nodes(g0_[index(cavity)], *space_);
}

void Cavities::set_pressures(const std::vector<int>& which, const VecX& p, State& state)
{
  for (std::size_t k = 0; k < which.size(); ++k)
    state.cavity[index(which[k])].pressure = p[static_cast<Eigen::Index>(k)];
}

int Cavities::most_updates() const
{
  int most = 0;
  for (const CavitySettings& one : settings_.cavities) most = std::max(most, one.most_updates);
  return most;
}

bool Cavities::proportional() const
{
  for (const CavitySettings& one : settings_.cavities)
    if (one.model == Model::frozen) return one.solver == Solver::proportional;
  return false;
}

NextPressures Cavities::next_pressures(const State& state, const Shape& shape,
                                       const std::vector<OwnedField>& per_p,
                                       const TimeStep& now) const
{
  const std::vector<int> which = frozen(state);
  const auto count = static_cast<Eigen::Index>(which.size());
  const VecX p0 = pressures(state);
  const Solver solver = settings_.cavities[index(which.front())].solver;
  VecX p = p0(which);
  if (solver == Solver::proportional) {
    const VecX V = volumes(shape);
    const Fluid fluids = fluid(state, p0, now);
    for (Eigen::Index k = 0; k < count; ++k) {
      const int i = which[static_cast<std::size_t>(k)];
      p[k] +=
          settings_.cavities[index(i)].gain * (fluids.volume[i] - V[i]) / walls_[index(i)].volume();
    }
    return {p};
  }
  std::vector<law::VolumeCubic> cubics;
  for (int i : which) {
    MatX y(shape[index(i)].size(), 1 + count);
    y.col(0) = shape[index(i)];
    for (Eigen::Index k = 0; k < count; ++k)
      y.col(1 + k) = walls_[index(i)].at_vertices(per_p[static_cast<std::size_t>(k)], *space_);
    cubics.emplace_back(walls_[index(i)].surface(), y);
  }
  VecX change = VecX::Zero(count);
  double before = std::numeric_limits<double>::infinity();
  VecX step = VecX::Zero(count);
  for (int iteration = 0; iteration < most_newton; ++iteration) {
    VecX all = p0;
    all(which) = p0(which) + change;
    const Fluid fluids = fluid(state, all, now);
    VecX miss(count);
    MatX slope(count, count);
    double worst = 0.0;
    for (Eigen::Index k = 0; k < count; ++k) {
      const int i = which[static_cast<std::size_t>(k)];
      miss[k] = cubics[static_cast<std::size_t>(k)].value(change) - fluids.volume[i];
      slope.row(k) = cubics[static_cast<std::size_t>(k)].gradient(change);
      for (Eigen::Index l = 0; l < count; ++l)
        slope(k, l) += fluids.compliance(i, which[static_cast<std::size_t>(l)]);
      worst = std::max(worst, std::abs(miss[k]) / walls_[index(i)].volume());
    }
    if (worst <= 1e-15 || (worst >= before && worst <= 1e-14)) break;
    if (worst > before) {  // too far: back by half
      step *= 0.5;
      change -= step;
      if (step.norm() <= 1e-12 * (p0.norm() + change.norm()))
        return {p, "cavity '" + settings_.cavities[index(which.front())].name +
                       "': no pressure gives its fluid's volume"};
      continue;
    }
    // V must grow with the pressure on the way from the last one.
    const MatX symmetric = 0.5 * (slope + slope.transpose());
    if (Eigen::LLT<MatX>(symmetric).info() != Eigen::Success)
      return {p,
              "cavity '" + settings_.cavities[index(which.front())].name +
                  "': its volume does not grow with the pressure any more (limit point near p = " +
                  core::shown(p0[which.front()] + change[0]) + " Pa)"};
    before = worst;
    step = slope.partialPivLu().solve(-miss);
    change += step;
    if (solver == Solver::newton) break;
  }
  return {p + change};
}

double Cavities::line_gain(int cavity, const OwnedField& per_p) const
{
  const Wall& wall = walls_[index(cavity)];
  MatX y(wall.undeformed().size(), 2);
  y << wall.undeformed(), wall.at_vertices(per_p, *space_);
  const law::VolumeCubic cubic(wall.surface(), y);
  constexpr int points = 25;
  VecX p(points), ratio(points);
  for (int k = 0; k < points; ++k) {
    ratio[k] = 0.7 + 0.6 * k / (points - 1.0);
    VecX at = VecX::Zero(1);
    for (int iteration = 0; iteration < most_newton; ++iteration)
      at[0] -= (cubic.value(at) - ratio[k] * wall.volume()) / cubic.gradient(at)[0];
    p[k] = at[0];
  }
  const VecX r = ratio.array() - ratio.mean();
  return r.dot(p) / r.squaredNorm();
}

}  // namespace trocar::cavity
