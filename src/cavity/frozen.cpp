#include "cavity/frozen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/dense.hpp"
#include "core/words.hpp"

namespace trocar::cavity {
namespace {

constexpr int most_newton = 100;

}  // namespace

std::vector<int> frozen(const Cavities& cavities, const State& state)
{
  std::vector<int> list;
  for (int i = 0; i < cavities.size(); ++i)
    if (cavities.one(i).model == Model::frozen && !state.cavity[index(i)].given) list.push_back(i);
  return list;
}

void set_pressures(const std::vector<int>& which, const VecX& p, State& state)
{
  for (std::size_t k = 0; k < which.size(); ++k)
    state.cavity[index(which[k])].pressure = p[static_cast<Eigen::Index>(k)];
}

int most_updates(const Cavities& cavities)
{
  int most = 0;
  for (const CavitySettings& one : cavities.settings().cavities)
    most = std::max(most, one.most_updates);
  return most;
}

bool proportional(const Cavities& cavities)
{
  for (const CavitySettings& one : cavities.settings().cavities)
    if (one.model == Model::frozen) return one.solver == Solver::proportional;
  return false;
}

namespace {

/// One step of the proportional control, p += K_p (V_law - V)/V_0.
VecX proportional_step(const Cavities& cavities, const State& state, const Shape& shape,
                       const VecX& gain, const TimeStep& now)
{
  const VecX V = cavities.volumes(shape);
  const Fluid fluids = fluid(cavities, state, pressures(state), now);
  const std::vector<int> which = frozen(cavities, state);
  VecX p = pressures(state)(which);
  for (std::size_t k = 0; k < which.size(); ++k)
    p[static_cast<Eigen::Index>(k)] += gain[static_cast<Eigen::Index>(k)] *
                                       (fluids.volume[which[k]] - V[which[k]]) /
                                       cavities.wall(which[k]).volume();
  return p;
}

/// Cubics of the frozen cavities' volumes over changes of their pressures.
std::vector<law::VolumeCubic> volume_cubics(const Cavities& cavities, const std::vector<int>& which,
                                            const Shape& shape,
                                            const std::vector<OwnedField>& per_p)
{
  std::vector<law::VolumeCubic> cubics;
  for (int i : which) {
    const Wall& wall = cavities.wall(i);
    MatX y(wall.undeformed().size(), 1 + static_cast<Eigen::Index>(which.size()));
    y.col(0) = shape[index(i)];
    for (std::size_t k = 0; k < which.size(); ++k)
      y.col(1 + static_cast<Eigen::Index>(k)) = wall.at_vertices(per_p[k], cavities.space());
    cubics.emplace_back(wall.surface(), y);
  }
  return cubics;
}

/// Data of the search for pressures. Volumes of frozen cavities are cubics in the pressure changes.
struct Search
{
  const Cavities& cavities;
  const State& state;
  const std::vector<int>& which;
  const std::vector<law::VolumeCubic>& cubics;
  const TimeStep& now;
};

struct Miss
{
  VecX volume;       ///< V - V_law, by frozen cavity [m³]
  MatX slope;        ///< ∂volume/∂p, by frozen cavity [m³/Pa]
  double worst;      ///< largest |V - V_law| / V_0
  int at;            ///< cavity of the largest error, index in `which`
  double round_off;  ///< largest round-off of V_law / V_0
};

/// Errors of the volumes and their slope when the pressures have changed by `change` [Pa].
Miss miss(const Search& search, const VecX& change)
{
  const Cavities& cavities = search.cavities;
  const std::vector<int>& which = search.which;
  VecX p = pressures(search.state);
  p(which) += change;
  const Fluid fluids = fluid(cavities, search.state, p, search.now);
  Miss miss{VecX(change.size()), fluids.compliance(which, which), 0.0, 0, 0.0};
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    miss.volume[k] = search.cubics[at].value(change) - fluids.volume[which[at]];
    miss.slope.row(k) += search.cubics[at].gradient(change);
    const double V0 = cavities.wall(which[at]).volume();
    miss.round_off = std::max(miss.round_off, fluids.round_off[which[at]] / V0);
    if (std::abs(miss.volume[k]) / V0 < miss.worst) continue;
    miss.worst = std::abs(miss.volume[k]) / V0;
    miss.at = static_cast<int>(k);
  }
  return miss;
}

}  // namespace

core::Outcome<VecX> next_pressures(const Cavities& cavities, const State& state, const Shape& shape,
                                   const PressureResponses& answers, const TimeStep& now)
{
  if (proportional(cavities)) return proportional_step(cavities, state, shape, answers.gain, now);
  const std::vector<int> which = frozen(cavities, state);
  const bool to_the_root = cavities.one(which.front()).solver == Solver::exact;
  const std::vector<law::VolumeCubic> curves = volume_cubics(cavities, which, shape, answers.per_p);
  const Search search{cavities, state, which, curves, now};
  const VecX p = pressures(state)(which);
  const auto refused = [&](const Miss& here, const std::string& what) {
    const int cavity = which[static_cast<std::size_t>(here.at)];
    return core::Refusal{"cavity '" + cavities.one(cavity).name + "': " + what};
  };
  VecX change = VecX::Zero(p.size()), step = change;
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_newton; ++iteration) {
    const Miss here = miss(search, change);
    const double enough = 1e-14 + here.round_off;
    if (here.worst <= 1e-15 || (here.worst >= before && here.worst <= enough)) break;
    if (here.worst > before) {  // the step went too far: take half of it back
      step *= 0.5;
      change -= step;
      if (step.norm() <= 1e-12 * (p.norm() + change.norm()))
        return refused(here, "no pressure gives its fluid's volume");
      continue;
    }
    // On the way from the last pressures V - V_law must grow with p.
    const MatX symmetric = 0.5 * (here.slope + here.slope.transpose());
    if (!core::Cholesky(symmetric).regular())
      return refused(here,
                     "its volume does not grow with the pressure any more (limit point near p = " +
                         core::shown(p[here.at] + change[here.at]) + " Pa)");
    before = here.worst;
    step = core::Square(here.slope).solve(-here.volume);
    change += step;
    if (!to_the_root) break;
  }
  return VecX(p + change);
}

double line_gain(const Cavities& cavities, int cavity, const OwnedField& per_p)
{
  const Wall& wall = cavities.wall(cavity);
  MatX y(wall.undeformed().size(), 2);
  y << wall.undeformed(), wall.at_vertices(per_p, cavities.space());
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
    throw core::solver_error("cavity '" + cavities.one(cavity).name +
                             "': no line through its volumes between 0.7 and 1.3 V_0: give "
                             "-cavity_gain");
  return gain;
}

}  // namespace trocar::cavity
