#include "cavity/cavities.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trocar::cavity {

double PressureCurve::at(double t) const
{
  const double wave = mean + amplitude * std::sin(2.0 * std::numbers::pi * t / period);
  return curve ? wave * core::interpolate(*curve, 1, t) : wave;
}

Cavities::Cavities(const mesh::Mesh& mesh, const fem::Space& space, Settings settings,
                   core::Ledger& ledger)
    : space_(&space), ledger_(&ledger), settings_(std::move(settings))
{
  std::vector<int> owner(mesh.x.size(), -1);
  for (const CavitySettings& one : settings_.cavities) {
    const int i = size();
    const Wall& wall = walls_.emplace_back(mesh, one.surface, one.caps);
    for (int node : wall.nodes()) {
      int& mine = owner[index(node)];
      if (mine >= 0)
        throw core::option_error("option -cavities: '" + settings_.cavities[index(mine)].name +
                                 "' and '" + one.name + "' share a wall: one law for each");
      mine = i;
    }
    g0_.push_back(law::volume_gradient(wall.surface(), wall.undeformed()));
    ++ledger_->surface_passes;
    auto probe = std::make_shared<solve::DistributedFunctional>();
    if (one.model == Model::linear) *probe = {i, wall.to_nodes(g0_.back() / wall.area(), space)};
    undeformed_probe_.push_back(std::move(probe));
  }
}

bool Cavities::any(Model model) const
{
  return std::any_of(settings_.cavities.begin(), settings_.cavities.end(),
                     [&](const CavitySettings& one) { return one.model == model; });
}

Shape Cavities::shape(const OwnedField& u) const
{
  Shape shape;
  for (const Wall& wall : walls_) shape.push_back(wall.undeformed() + wall.at_vertices(u, *space_));
  ++ledger_->surface_passes;
  return shape;
}

VecX Cavities::volumes(const Shape& shape) const
{
  VecX volumes(size());
  for (int i = 0; i < size(); ++i)
    volumes[i] = law::volume(walls_[index(i)].surface(), shape[index(i)]);
  return volumes;
}

VecX pressures(const State& state)
{
  VecX p(static_cast<Eigen::Index>(state.cavity.size()));
  for (std::size_t i = 0; i < state.cavity.size(); ++i)
    p[static_cast<Eigen::Index>(i)] = state.cavity[i].pressure;
  return p;
}

double Cavities::given_pressure(int i, const TimeStep& now) const
{
  const CavitySettings& one = settings_.cavities[index(i)];
  if (one.fluid.kind != law::FluidLaw::Kind::pressure) return now.load * *one.initial_pressure;
  return now.load * one.pressure.at(now.t);
}

VecX Cavities::gradient(int i, const Shape& shape) const
{
  if (settings_.cavities[index(i)].model != Model::follower) return g0_[index(i)];
  return law::volume_gradient(walls_[index(i)].surface(), shape[index(i)]);
}

OwnedField Cavities::unit_load(int i) const
{
  return walls_[index(i)].to_nodes(g0_[index(i)], *space_);
}

/// Adds the forces of the fluid's weight: on the deformed wall of a follower, else on the
/// undeformed.
void Cavities::add_weight(int i, const Shape& shape, const TimeStep& now, VecX& forces) const
{
  const CavitySettings& one = settings_.cavities[index(i)];
  const Wall& wall = walls_[index(i)];
  if (one.weight.isZero(0.0)) return;
  const VecX& x = one.model == Model::follower ? shape[index(i)] : wall.undeformed();
  forces += now.load * law::moment_gradient(wall.surface(), x, one.weight);
}

fem::Load Cavities::load(const State& state, const Shape& shape, const TimeStep& now) const
{
  fem::Load load;
  std::vector<double> p(walls_.size(), 0.0);
  bool follows = false;
  for (int i = 0; i < size(); ++i) {
    const CavitySettings& one = settings_.cavities[index(i)];
    const Wall& wall = walls_[index(i)];
    const bool given = state.cavity[index(i)].given;
    const bool follower = one.model == Model::follower;
    p[index(i)] = given ? given_pressure(i, now) : state.cavity[index(i)].pressure;
    VecX f = VecX::Zero(wall.undeformed().size());
    if (given) f += p[index(i)] * gradient(i, shape);
    add_weight(i, shape, now, f);
    follows = follows || (follower && (p[index(i)] != 0.0 || !one.weight.isZero(0.0)));
    if (f.isZero(0.0)) continue;
    if (load.force.value.size() == 0) load.force = space_->zero();
    load.force.value += wall.to_nodes(f, *space_).value;
  }
  if (!follows) return load;
  load.stiffness = [this, shape, p, share = now.load](const OwnedField& d) {
    OwnedField f = space_->zero();
    for (int i = 0; i < size(); ++i) {
      const CavitySettings& one = settings_.cavities[index(i)];
      if (one.model != Model::follower) continue;
      const Wall& wall = walls_[index(i)];
      const VecX& x = shape[index(i)];
      const VecX d_wall = wall.at_vertices(d, *space_);
      VecX change = p[index(i)] * law::volume_hessian_times(wall.surface(), x, d_wall);
      if (!one.weight.isZero(0.0))
        change += share * law::moment_hessian_times(wall.surface(), x, one.weight, d_wall);
      f.value += wall.to_nodes(change, *space_).value;
    }
    ++ledger_->surface_passes;
    return f;
  };
  return load;
}

OwnedField Cavities::forces(const State& state, const Shape& shape, const TimeStep& now) const
{
  OwnedField f = space_->zero();
  for (int i = 0; i < size(); ++i) {
    VecX mine = state.cavity[index(i)].pressure * gradient(i, shape);
    add_weight(i, shape, now, mine);
    f.value += walls_[index(i)].to_nodes(mine, *space_).value;
  }
  return f;
}

}  // namespace trocar::cavity
