#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "constraint/system.hpp"
#include "contact/mortar.hpp"
#include "contact/settings.hpp"
#include "contact/state.hpp"
#include "core/ledger.hpp"
#include "fem/dirichlet.hpp"

// Bodies and obstacles that touch: unilateral contact and friction (docs/theory.md section 14).
namespace trocar::contact {

/// The pairs of a scene. Throws Failure (64, 65) for unknown or unfit surfaces. Corners whose
/// displacement is prescribed, or that are slave of a pair before, carry no multiplier.
std::vector<Pair> pairs_of(const Settings& settings, const mesh::Mesh& mesh,
                           const fem::Dirichlet& fixed);

/// The state of bodies as they are given. With `Pair::closed` an overlap of corners is kept. Throws
/// Failure (65) with the place where it is more than the search distance. Not collective.
State start(const std::vector<Pair>& pairs, const Deformation& now, core::Ledger& ledger);

/// Pairs and their state at the start of the step. Borrows everything.
struct Contacts
{
  const std::vector<Pair>& pairs;
  const State& state;
  const fem::GlobalField& start;  ///< displacement at the start of the step
  double start_t = 0.0;           ///< time there [s]
};

/// The rows of one slave corner: the normal one, and with friction two tangential ones.
struct Group
{
  int pair;
  Meeting meeting;
  const Touch* touch;  ///< where it touched before, or nothing
  core::Mat3 frame;    ///< columns n, t1, t2
  int first = -1;      ///< its first row in the set
  int rows = 1;
};

/// All rows of a geometry, in a set.
struct Rows
{
  std::vector<Group> groups;
  int first = 0, count = 0;  ///< rows of the set
  int queries = 0;           ///< pairs whose surfaces were clipped with each other
};

/// Adds the rows of all pairs at the displacement of `now`. λ > 0 of a normal row pushes the bodies
/// apart; its δ is the weighted gap. A tangential δ is the slip since the corner slipped last.
/// Rows start from the multipliers of the last step. Not collective.
Rows add_rows(const Contacts& contacts, const Deformation& now, constraint::Set& set);

/// Multipliers by row of `rows`, taken from the rows of another geometry by pair and node; zero
/// where a corner was not in reach.
core::VecX carried(const Rows& from, const core::VecX& lambda, const Rows& rows);

/// What is left of the laws at the end of a linearisation: rows of the geometry that it led to, and
/// the multipliers there.
struct Ending
{
  Rows rows;
  constraint::System system;  ///< without bodies; its gaps are those of the geometry
  core::VecX lambda;
  double residual = 0.0;  ///< largest residual of a law [m]
};
/// `solved`: rows and multipliers of the linearisation, `mobility` of its rows [m/N].
Ending ending(const Contacts& contacts, const Deformation& now, const Rows& solved,
              const core::VecX& lambda, const core::VecX& mobility);

/// What a slave corner in reach of the master does. The force acts on the master.
struct CornerReport
{
  enum State : std::uint8_t { apart = 0, slips = 1, sticks = 2 };
  int node;     ///< file node
  double gap;   ///< weighted gap [m]
  double area;  ///< covered ∫φ [m²]
  State state = apart;
  double pressure = 0.0;      ///< normal force over area [Pa]
  Vec3 force = Vec3::Zero();  ///< [N]
};

/// Results of one pair. Forces act on the master.
struct PairReport
{
  Vec3 force = Vec3::Zero();  ///< [N]
  double area = 0.0;          ///< of the touching corners [m²]
  double weighted_gap = 0.0;  ///< least of the corners in reach [m]; 0: none is
  /// Farthest that a point of the slave lies in the master, in spite of closed weighted gaps [m].
  double largest_penetration = 0.0;
  std::vector<CornerReport> corners{};  ///< in reach, ascending nodes
  int sticking = 0, slipping = 0;       ///< touching corners; without friction all slip
  double friction_work = 0.0;           ///< Σ λ·slip of the step, not positive [J]
  /// Work of the normal forces in the step: what closing gaps takes from the bodies' motion, not
  /// positive but for normals that turn [J].
  double normal_work = 0.0;
  double obstacle_work = 0.0;  ///< by an obstacle that moves, in the step [J]
};

/// The state after the step, and the results. Slips up to `tolerance` [m] count as sticking.
State accept(const Contacts& contacts, const Ending& ending, const Deformation& now,
             double tolerance, std::vector<PairReport>& reports);

}  // namespace trocar::contact
