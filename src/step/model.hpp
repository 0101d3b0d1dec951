#pragma once

#include <optional>
#include <vector>

#include "cavity/pressure_search.hpp"
#include "mesh/partition.hpp"
#include "step/scene.hpp"

namespace trocar::step {

/// What steps are taken with: the bodies of a scene, and caches that no result depends on beyond
/// their tolerances. All that changes is in `State`.
struct Model
{
  /// Borrows the scene. Collective.
  Model(const Scene& scene, const base::Comm& comm);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  bool beams() const;          ///< some needle bends
  bool follows() const;        ///< some pressure follows its wall
  bool exact_volumes() const;  ///< some volume is that of the deformed wall
  /// Walls where the state has them: looked at once for every place of the tissue, and only when
  /// some load or volume is theirs. Collective.
  cavity::Shape walls(const fem::OwnedField& u) const;
  /// Forgets all that was made for earlier steps. Not collective.
  void drop_caches();

  const Scene& scene;
  core::Ledger ledger{};
  fem::Space space;
  tissue::Tissue tissue;
  std::vector<needle::Needle> needles{};
  bool driven_at_start = false;  ///< motion that rows or supports prescribe from the start on
  std::optional<mesh::Locator> locator{};                   ///< only with needles
  std::optional<insertion::Ground> ground{};                ///< only with needles
  std::optional<cavity::Cavities> cavities{};               ///< only with cavities
  std::optional<cavity::PressureSearch> pressure_search{};  ///< likewise
};

}  // namespace trocar::step
