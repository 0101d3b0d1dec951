#pragma once

#include <optional>
#include <vector>

#include "cavity/pressure_search.hpp"
#include "contact/contacts.hpp"
#include "mesh/partition.hpp"
#include "step/scene.hpp"
#include "tissue/bodies.hpp"

namespace trocar::step {

/// The bodies of a scene and their caches. Results depend on the caches only within the tolerances
/// of the solvers. Everything that changes from step to step is in `State`.
struct Model
{
  /// Borrows the scene. Collective.
  Model(const Scene& scene, const base::Comm& comm);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  bool beams() const;          ///< some needle is a flexible beam
  bool follows() const;        ///< some pressure acts on the deformed wall
  bool exact_volumes() const;  ///< some cavity's volume is that of its deformed wall
  /// The cavity walls at displacement u; empty when no volume is that of a deformed wall. Callers
  /// keep the result, so that it is computed once per displacement. Collective.
  cavity::Shape walls(const fem::OwnedField& u) const;
  /// Forgets operators, factors and pressure responses of earlier steps. Not collective.
  void drop_caches();

  const Scene& scene;
  core::Ledger ledger{};
  fem::Space space;
  tissue::Tissue tissue;
  std::vector<needle::Needle> needles{};
  bool driven_at_start = false;            ///< rows or supports prescribe motion from the start on
  std::optional<mesh::Locator> locator{};  ///< only with needles
  std::optional<insertion::Ground> ground{};  ///< only with needles
  std::vector<contact::Pair> contact{};
  tissue::Bodies bodies{};  ///< only in statics where contact holds some
  double proximal = 0.0;    ///< see core::TimeStep::proximal; 0: the supports hold every body
  std::optional<cavity::Cavities> cavities{};               ///< only with cavities
  std::optional<cavity::PressureSearch> pressure_search{};  ///< only with cavities

 private:
  void hold_bodies();
  bool in_contact(std::size_t body) const;
};

}  // namespace trocar::step
