#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cavity/cavities.hpp"
#include "core/dense.hpp"
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

/// One step of the proportional control, p += K_p (V_law - V)/V_0.
VecX Cavities::proportional_step(const State& state, const Shape& shape, const VecX& gain,
                                 const TimeStep& now) const
{
  const VecX V = volumes(shape);
  const Fluid fluids = fluid(state, pressures(state), now);
  const std::vector<int> which = frozen(state);
  VecX p = pressures(state)(which);
  for (std::size_t k = 0; k < which.size(); ++k)
    p[static_cast<Eigen::Index>(k)] += gain[static_cast<Eigen::Index>(k)] *
                                       (fluids.volume[which[k]] - V[which[k]]) /
                                       walls_[index(which[k])].volume();
  return p;
}

/// Cubics of the frozen cavities' volumes over changes of their pressures.
std::vector<law::VolumeCubic> Cavities::cubics(const std::vector<int>& which, const Shape& shape,
                                               const std::vector<OwnedField>& per_p) const
{
  std::vector<law::VolumeCubic> cubics;
  for (int i : which) {
    const Wall& wall = walls_[index(i)];
    MatX y(wall.undeformed().size(), 1 + static_cast<Eigen::Index>(which.size()));
    y.col(0) = shape[index(i)];
    for (std::size_t k = 0; k < which.size(); ++k)
      y.col(1 + static_cast<Eigen::Index>(k)) = wall.at_vertices(per_p[k], *space_);
    cubics.emplace_back(wall.surface(), y);
  }
  return cubics;
}

/// What the volumes miss their fluids' by, and its slope, where the pressures have changed.
Cavities::Miss Cavities::miss(const State& state, const std::vector<int>& which,
                              const std::vector<law::VolumeCubic>& cubics, const VecX& change,
                              const TimeStep& now) const
{
  VecX p = pressures(state);
  p(which) += change;
  const Fluid fluids = fluid(state, p, now);
  Miss miss{VecX(change.size()), fluids.compliance(which, which), 0.0, 0, 0.0};
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    miss.volume[k] = cubics[at].value(change) - fluids.volume[which[at]];
    miss.slope.row(k) += cubics[at].gradient(change);
    const double V0 = walls_[index(which[at])].volume();
    miss.round_off = std::max(miss.round_off, fluids.round_off[which[at]] / V0);
    if (std::abs(miss.volume[k]) / V0 < miss.worst) continue;
    miss.worst = std::abs(miss.volume[k]) / V0;
    miss.at = static_cast<int>(k);
  }
  return miss;
}

core::Outcome<VecX> Cavities::next_pressures(const State& state, const Shape& shape,
                                             const PressureAnswers& answers,
                                             const TimeStep& now) const
{
  if (proportional()) return proportional_step(state, shape, answers.gain, now);
  const std::vector<int> which = frozen(state);
  const bool to_the_root = settings_.cavities[index(which.front())].solver == Solver::exact;
  const std::vector<law::VolumeCubic> curves = cubics(which, shape, answers.per_p);
  const VecX p = pressures(state)(which);
  const auto refused = [&](const Miss& here, const std::string& what) {
    const int cavity = which[static_cast<std::size_t>(here.at)];
    return core::Refusal{"cavity '" + settings_.cavities[index(cavity)].name + "': " + what};
  };
  VecX change = VecX::Zero(p.size()), step = change;
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_newton; ++iteration) {
    const Miss here = miss(state, which, curves, change, now);
    const double enough = 1e-14 + here.round_off;
    if (here.worst <= 1e-15 || (here.worst >= before && here.worst <= enough)) break;
    if (here.worst > before) {  // too far: back by half
      step *= 0.5;
      change -= step;
      if (step.norm() <= 1e-12 * (p.norm() + change.norm()))
        return refused(here, "no pressure gives its fluid's volume");
      continue;
    }
    // V must grow with the pressure on the way from the last one.
    const MatX symmetric = 0.5 * (here.slope + here.slope.transpose());
    if (!core::Cholesky(symmetric).regular())
      return refused(here,
                     "its volume does not grow with the pressure any more (limit point near p = " +
                         core::shown(p[here.at] + change[here.at]) + " Pa)");
    before = here.worst;
    step = core::solve_square(here.slope, -here.volume);
    change += step;
    if (!to_the_root) break;
  }
  return VecX(p + change);
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
  const double gain = r.dot(p) / r.squaredNorm();
  if (!(gain > 0.0 && std::isfinite(gain)))
    throw core::solver_error("cavity '" + settings_.cavities[index(cavity)].name +
                             "': no line through its volumes between 0.7 and 1.3 V_0: give "
                             "-cavity_gain");
  return gain;
}

}  // namespace trocar::cavity
