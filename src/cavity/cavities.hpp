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

/// The fluid-filled cavities of a scene: their walls, and how pressures push on them. What their
/// fluids do is in network.hpp, their rows in rows.hpp, the pressures of the frozen model in
/// frozen.hpp. Collective where it meets fields; all answers but fields are equal on every rank.
class Cavities
{
 public:
  /// Borrows mesh, space and ledger. Throws Failure (64, 65) as `Wall` does, and for two cavities
  /// on one wall.
  Cavities(const mesh::Mesh& mesh, const fem::Space& space, Settings settings,
           core::Ledger& ledger);

  int size() const { return static_cast<int>(walls_.size()); }
  const Settings& settings() const { return settings_; }
  const CavitySettings& one(int i) const { return settings_.cavities[index(i)]; }
  const Wall& wall(int i) const { return walls_[index(i)]; }
  const fem::Space& space() const { return *space_; }
  core::Ledger& ledger() const { return *ledger_; }
  bool any(Model model) const;
  bool follows() const { return any(Model::follower); }  ///< steps are iterated
  /// Some volume is that of the deformed wall.
  bool exact() const { return follows() || any(Model::frozen); }

  Shape shape(const OwnedField& u) const;  ///< collective: one pass over the walls' nodes
  VecX volumes(const Shape& shape) const;  ///< [m³]
  /// Volume gradient of the wall as its pressure sees it, by vertex [m²].
  VecX gradient(int i, const Shape& shape) const;
  OwnedField unit_load(int i) const;  ///< g_0 [m²]: force of a unit pressure on the wall at rest
  /// The probe g_0 / area of a linear cavity.
  std::shared_ptr<const solve::DistributedFunctional> undeformed_probe(int i) const
  {
    return undeformed_probe_[index(i)];
  }
  /// Counts the probes of follower cavities, so that no column is taken for another's.
  long long next_version() { return ++versions_; }

  /// Forces of given pressures and of the fluids' weight; those of rows are not in it. Collective.
  fem::Load load(const State& state, const Shape& shape, const TimeStep& now) const;
  /// All forces of pressures and weight where the walls are now [N]. Not collective.
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
      undeformed_probe_;  ///< of linear cavities
  long long versions_ = 0;
};

VecX pressures(const State& state);  ///< [Pa]

}  // namespace trocar::cavity
