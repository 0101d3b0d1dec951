#include "cavity/rows.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace trocar::cavity {
namespace {

/// Sets gaps and couplings of δ = (V - V_law(p))/area, with V_law linearised about `rows.pressure`.
void set_gaps(const Cavities& cavities, const CavityRows& rows, constraint::Set& set)
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
             rows.fluid.compliance(i, j) / cavities.wall(i).area() / cavities.wall(j).area()});
    }
    set.set_gap(rows.first + k, gap / cavities.wall(i).area());
  }
}

}  // namespace

CavityRows add_rows(Cavities& cavities, const State& state, const Configuration& at,
                    constraint::Set& set)
{
  CavityRows rows;
  rows.first = set.size();
  std::vector<double> held;
  for (int i = 0; i < cavities.size(); ++i) {
    const CavitySettings& one = cavities.one(i);
    if (one.model == Model::frozen || state.cavity[index(i)].given) continue;
    const Wall& wall = cavities.wall(i);
    std::shared_ptr<const solve::DistributedFunctional> probe = cavities.undeformed_probe(i);
    if (one.model == Model::follower)
      probe = std::make_shared<solve::DistributedFunctional>(solve::DistributedFunctional{
          i, wall.to_nodes(cavities.gradient(i, at.shape) / wall.area(), cavities.space()),
          cavities.next_version()});
    held.push_back(one.model == Model::follower ? law::volume(wall.surface(), at.shape[index(i)])
                                                : linear_volume(cavities, i, at.u));
    constraint::Row row;
    row.distributed = {{set.add_functional(std::move(probe))}};
    row.start = state.cavity[index(i)].pressure * wall.area();
    set.add(std::move(row));
    rows.cavity.push_back(i);
  }
  rows.held = Eigen::Map<VecX>(held.data(), static_cast<Eigen::Index>(held.size()));
  rows.pressure = pressures(state);
  rows.fluid = fluid(cavities, state, rows.pressure, at.now);
  rows.state = state;
  rows.now = at.now;
  set_gaps(cavities, rows, set);
  return rows;
}

bool refresh(const Cavities& cavities, const VecX& lambda, CavityRows& rows, constraint::Set& set)
{
  if (rows.cavity.empty()) return false;
  VecX p = rows.pressure;
  for (std::size_t k = 0; k < rows.cavity.size(); ++k) {
    const int i = rows.cavity[k];
    p[i] = lambda[rows.first + static_cast<Eigen::Index>(k)] / cavities.wall(i).area();
  }
  Fluid there = fluid(cavities, rows.state, p, rows.now);
  // Pressures at which more fluid flows out of a cavity than it has lie beyond the solution.
  constexpr int most_halvings = 30;
  for (int k = 0; k < most_halvings && drained(there) >= 0; ++k) {
    p = 0.5 * (p + rows.pressure);
    there = fluid(cavities, rows.state, p, rows.now);
  }
  const VecX expected = rows.fluid.volume - rows.fluid.compliance * (p - rows.pressure);
  bool right = true;
  for (int i : rows.cavity)
    right = right && std::abs(there.volume[i] - expected[i]) <=
                         1e-13 * cavities.wall(i).volume() + there.round_off[i];
  if (right) return false;
  rows.pressure = p;
  rows.fluid = there;
  set_gaps(cavities, rows, set);
  return true;
}

void take_pressures(const Cavities& cavities, const CavityRows& rows, const VecX& lambda,
                    const TimeStep& now, State& state)
{
  for (int i = 0; i < cavities.size(); ++i)
    if (state.cavity[index(i)].given)
      state.cavity[index(i)].pressure = cavities.given_pressure(i, now);
  for (std::size_t k = 0; k < rows.cavity.size(); ++k) {
    const int i = rows.cavity[k];
    state.cavity[index(i)].pressure =
        lambda[rows.first + static_cast<Eigen::Index>(k)] / cavities.wall(i).area();
  }
}

}  // namespace trocar::cavity
