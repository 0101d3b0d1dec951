#pragma once

#include <memory>
#include <vector>

#include "cavity/settings.hpp"
#include "cavity/state.hpp"
#include "cavity/wall.hpp"
#include "core/ledger.hpp"
#include "core/time_step.hpp"
#include "fem/load.hpp"
#include "solve/probes.hpp"

namespace trocar::cavity {

using core::TimeStep;

inline std::size_t index(int i)
{
  return static_cast<std::size_t>(i);
}

/// The fluid-filled cavities of a scene: their walls, and the forces of pressures on the walls.
/// network.hpp has the fluids, rows.hpp the rows, frozen.hpp the pressures of the frozen model.
/// Functions that take a field are collective. All results but fields are equal on every rank.
class Cavities
{
 public:
  /// Borrows space and ledger. Throws Failure (65) as `Wall` does, and Failure (64) when two
  /// cavities share a node of their walls.
  Cavities(const mesh::Mesh& mesh, const fem::Space& space, Settings settings,
           core::Ledger& ledger);

  int size() const { return static_cast<int>(walls_.size()); }
  const Settings& settings() const { return settings_; }
  const CavitySettings& one(int i) const { return settings_.cavities[index(i)]; }
  const Wall& wall(int i) const { return walls_[index(i)]; }
  const fem::Space& space() const { return *space_; }
  core::Ledger& ledger() const { return *ledger_; }
  bool any(Model model) const;
  bool follows() const { return any(Model::follower); }  ///< if so, steps are iterated
  /// True when some cavity's volume is that of its deformed wall.
  bool exact() const { return follows() || any(Model::frozen); }

  Shape shape(const OwnedField& u) const;  ///< of the walls at u; collective
  VecX volumes(const Shape& shape) const;  ///< [m³]
  /// Force of a unit pressure by vertex [m²]: ∂V/∂x of a follower's deformed wall, else g_0.
  VecX gradient(int i, const Shape& shape) const;
  OwnedField unit_load(int i) const;  ///< g_0 [m²]: force of a unit pressure on the undeformed wall
  /// The probe g_0 / area of a cavity of the linear model.
  std::shared_ptr<const solve::DistributedFunctional> undeformed_probe(int i) const
  {
    return undeformed_probe_[index(i)];
  }
  /// A new version number for the probe of a follower, so that no old compliance column is reused.
  long long next_version() { return ++versions_; }

  /// Forces of given pressures and of the fluids' weight, without the pressures that are solved
  /// for. Not collective, but the load's `stiffness` is.
  fem::Load load(const State& state, const Shape& shape, const TimeStep& now) const;
  /// Forces of all pressures and of the fluids' weight on the walls at `shape` [N]. Not collective.
  OwnedField forces(const State& state, const Shape& shape, const TimeStep& now) const;
  double given_pressure(int i, const TimeStep& now) const;  ///< [Pa]

 private:
  void add_weight(int i, const Shape& shape, const TimeStep& now, VecX& forces) const;

  const fem::Space* space_;
  core::Ledger* ledger_;
  Settings settings_;
  std::vector<Wall> walls_;
  std::vector<VecX> g0_;  ///< volume gradient of the undeformed walls, by vertex [m²]
  std::vector<std::shared_ptr<const solve::DistributedFunctional>>
      undeformed_probe_;  ///< empty but for cavities of the linear model
  long long versions_ = 0;
};

VecX pressures(const State& state);  ///< [Pa]

}  // namespace trocar::cavity
