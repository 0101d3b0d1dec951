#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cavity/settings.hpp"
#include "cavity/wall.hpp"
#include "constraint/set.hpp"
#include "core/ledger.hpp"
#include "core/outcome.hpp"
#include "core/time_step.hpp"
#include "fem/load.hpp"

namespace trocar::cavity {

using core::MatX;
using core::TimeStep;

/// State of one cavity. A value, equal on every rank.
struct CavityState
{
  double pressure = 0.0;        ///< at the reference point of its wall [Pa]
  double amount = 0.0;          ///< V_f: volume of the fluid at its reference pressure [m³]
  double whole = 0.0;           ///< amount that a curve scales [m³]
  double start_pressure = 0.0;  ///< [Pa]
  double reference = 0.0;       ///< pressure at which the fluid takes its amount [Pa]
  bool given = false;           ///< the pressure is given: always, or only at the start
  bool held = false;            ///< the amount is held whatever the fluid (P-V curves)

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("pressure", "Pa", self.pressure);
    v("amount", "m^3", self.amount);
    v("whole", "m^3", self.whole);
    v("start_pressure", "Pa", self.start_pressure);
    v("reference", "Pa", self.reference);
    v("given", "1", self.given);
    v("held", "1", self.held);
  }
};

struct EdgeState
{
  bool pierced = false;    ///< a needle came through
  bool needle_in = false;  ///< and is still there
  double channel = 0.0;    ///< tissue that it went through up to the wall [m]
  double flow = 0.0;       ///< [m³/s]
  double moved = 0.0;      ///< since the start [m³]

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("pierced", "1", self.pierced);
    v("needle_in", "1", self.needle_in);
    v("channel", "m", self.channel);
    v("flow", "m^3/s", self.flow);
    v("moved", "m^3", self.moved);
  }
};

struct State
{
  std::vector<CavityState> cavity;
  std::vector<EdgeState> edge;

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("cavity", "", self.cavity);
    v("edge", "", self.edge);
  }
};

/// A stretch of a needle's path that lies in no tissue.
struct VoidPiece
{
  Vec3 place;      ///< on the needle, in the stretch [m]
  double channel;  ///< length of the path in tissue up to it [m]
};

/// Volume and compliance of the fluids at given pressures, the network over a step included.
struct Fluid
{
  VecX volume;      ///< V_law(p) (cavities) [m³]
  MatX compliance;  ///< D = -∂V_law/∂p, symmetric positive semidefinite [m³/Pa]
  VecX round_off;   ///< of the volume: flows are differences of pressures (cavities) [m³]
};

/// Coordinates of all walls' vertices, each from its reference point [m].
using Shape = std::vector<VecX>;

/// Rows of cavities in a set: row `first + k` is that of cavity `cavity[k]`.
struct CavityRows
{
  int first = 0;
  std::vector<int> cavity;
  VecX held;      ///< volume at zero increments, by row [m³]
  VecX pressure;  ///< at which the fluids were linearised, by cavity [Pa]
  Fluid fluid;    ///< there
  State state;    ///< that the fluids were linearised for
  TimeStep now;
};

/// How tissue and rows answer to the pressures of frozen cavities.
struct PressureAnswers
{
  std::vector<OwnedField> per_p;  ///< displacement per unit of every one [m/Pa]
  VecX gain;                      ///< K_p of the proportional solver [Pa]
};

/// What one cavity did in a step.
struct CavityReport
{
  double pressure = 0.0, volume = 0.0;  ///< [Pa], [m³] of the deformed wall
  double error = 0.0;                   ///< |V - V_law| / V_0, of the deformed wall
  int iterations = 0;                   ///< linearisations or pressure updates
  bool alarm = false;
};

/// The fluid-filled cavities of a scene and the network between them. A row of the constraint
/// system has the multiplier p·area [N] and the gap (V - V_law)/area [m]. Collective where it
/// meets fields; all answers but fields are equal on every rank.
class Cavities
{
 public:
  /// Borrows mesh, space and ledger. Throws Failure (64, 65) as `Wall` does, and for two cavities
  /// on one wall.
  Cavities(const mesh::Mesh& mesh, const fem::Space& space, Settings settings,
           core::Ledger& ledger);

  int size() const { return static_cast<int>(walls_.size()); }
  const Settings& settings() const { return settings_; }
  const Wall& wall(int i) const { return walls_[index(i)]; }
  bool any(Model model) const;
  bool follows() const { return any(Model::follower); }  ///< steps are iterated
  /// Some volume is that of the deformed wall.
  bool exact() const { return follows() || any(Model::frozen); }

  State start() const;
  /// Events and amounts of a step, decided before the solve: what the needles have opened, what is
  /// injected by curves. `voids`: by needle; `u`: displacement at the start of the step.
  /// Collective.
  State advance(const State& old, double t_old, double t,
                const std::vector<std::vector<VoidPiece>>& voids, const OwnedField& u) const;

  Shape shape(const OwnedField& u) const;    ///< collective: one pass over the walls' nodes
  VecX volumes(const Shape& shape) const;    ///< [m³]
  VecX pressures(const State& state) const;  ///< [Pa]
  /// Forces of given pressures and of the fluids' weight; those of rows are not in it. Collective.
  fem::Load load(const State& state, const Shape& shape, const TimeStep& now) const;
  /// All forces of pressures and weight where the walls are now [N]. Not collective.
  OwnedField forces(const State& state, const Shape& shape, const TimeStep& now) const;
  Fluid fluid(const State& state, const VecX& p, const TimeStep& now) const;

  /// Rows of linear and follower cavities at the iterate u. Collective.
  CavityRows add_rows(const State& state, const Shape& shape, const OwnedField& u,
                      const TimeStep& now, constraint::Set& set);
  /// A cavity whose fluid has flowed out whole, of which more than nothing is wanted; -1: none.
  static int drained(const Fluid& fluid);
  /// Linearises the fluids anew where the multipliers have led; false when they were right.
  bool refresh(const VecX& lambda, CavityRows& rows, constraint::Set& set) const;
  /// Pressures from multipliers, and given ones of this time.
  void take(const CavityRows& rows, const VecX& lambda, const TimeStep& now, State& state) const;

  /// True when every exact volume is that of its fluid, to its tolerance.
  bool closed(const State& state, const Shape& shape, const TimeStep& now) const;
  /// Ends a step: flows are booked, and what is to be known of it. Collective.
  std::vector<CavityReport> accept(State& state, const OwnedField& u, const Shape& shape,
                                   const TimeStep& now) const;

  // Cavities of the frozen model: their pressures are found outside the constraint system.
  std::vector<int> frozen(const State& state) const;
  OwnedField unit_load(int cavity) const;  ///< g_0 [m²]: force of a unit pressure
  /// Next pressures of the frozen cavities from where the walls are [Pa]; refused where there are
  /// none. Collective.
  core::Outcome<VecX> next_pressures(const State& state, const Shape& shape,
                                     const PressureAnswers& answers, const TimeStep& now) const;
  static void set_pressures(const std::vector<int>& which, const VecX& p, State& state);
  int most_updates() const;   ///< of pressures in one step
  bool proportional() const;  ///< the solver of the frozen cavities
  /// Slope dP/d(V/V_0) of the line through V(p) between 0.7 and 1.3 V_0 [Pa]; `per_p`: displacement
  /// per unit pressure, everything else at rest. Collective.
  double line_gain(int cavity, const OwnedField& per_p) const;
  /// For P-V curves: the cavity holds this volume, whatever its law. Not collective.
  static void hold_volume(int cavity, double volume, State& state);

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  const law::FluidLaw& law_of(int i, const State& state) const;
  law::Edge edge(int e, const State& state, double t) const;
  law::Flows flows(const State& state, const VecX& p, double t) const;
  double amount_at_reference(int i, const State& state, double at_zero) const;
  const VoidPiece* entered(int cavity, const std::vector<VoidPiece>& voids,
                           const Shape& shape) const;
  VecX gradient(int i, const Shape& shape) const;
  void add_weight(int i, const Shape& shape, const TimeStep& now, VecX& forces) const;
  double linear_volume(int i, const OwnedField& u) const;
  void set_gaps(const CavityRows& rows, constraint::Set& set) const;
  double given_pressure(int i, const TimeStep& now) const;

  struct Miss
  {
    VecX volume;       ///< V - V_law [m³]
    MatX slope;        ///< by the pressures [m³/Pa]
    double worst;      ///< largest |V - V_law| / V_0
    int at;            ///< of this cavity
    double round_off;  ///< of that
  };
  VecX proportional_step(const State& state, const Shape& shape, const VecX& gain,
                         const TimeStep& now) const;
  std::vector<law::VolumeCubic> cubics(const std::vector<int>& which, const Shape& shape,
                                       const std::vector<OwnedField>& per_p) const;
  Miss miss(const State& state, const std::vector<int>& which,
            const std::vector<law::VolumeCubic>& cubics, const VecX& change,
            const TimeStep& now) const;

  const fem::Space* space_;
  core::Ledger* ledger_;
  Settings settings_;
  std::vector<Wall> walls_;
  std::vector<VecX> g0_;  ///< volume gradient of the undeformed walls, by vertex [m²]
  std::vector<std::shared_ptr<const solve::WideProbe>> undeformed_probe_;  ///< of linear cavities
  long long versions_ = 0;  ///< of the probes of follower cavities
};

}  // namespace trocar::cavity
