#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/time_step.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"
#include "solve/linearisation.hpp"
#include "tissue/balance.hpp"
#include "tissue/boundary.hpp"
#include "tissue/elements.hpp"
#include "tissue/tangent_choice.hpp"

namespace trocar::tissue {

using core::TimeStep;

struct TissueSettings : ElementSettings
{
  BoundaryConditions boundary;
  solve::LinearSettings linear;
  solve::Provider provider = solve::Provider::automatic;
  solve::Reuse reuse = solve::Reuse::exact;
  int stale_steps = 10;      ///< that share a factor with Reuse::stale
  double most_memory = 0.0;  ///< that a factor of our own may take [B], 0: a part of what is free
  std::vector<int> ordered_last;  ///< file nodes that needles are planned to reach
  /// Equilibrium that a step with an older factor must reach, of its load; 0: always factor anew.
  double lag_tolerance = 0.0;
  bool allow_inversion = false;  ///< of linear tissue, which feels nothing of it
  /// Part of the forces at a node that may be left unbalanced where steps are iterated to the end.
  double newton_tolerance = 1e-8;
};

/// What the factor of turning tissue was made from: enough to make it again.
struct FactorOrigin
{
  core::Rates rates;
  LinearisationPoint at;  ///< where
  bool exact = false;     ///< with the exact tangent

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("velocity_rate", "1/s", self.rates.velocity);
    v("acceleration_rate", "1/s", self.rates.acceleration);
    const auto by_point = [&](const char* name, const char* unit, auto& list) {
      fem::ByPoint values{list};
      v(name, unit, values);
    };
    by_point("rotation", "1", self.at.R);
    by_point("gradient", "1", self.at.G);
    by_point("pressure", "Pa", self.at.p);
    v("exact", "1", self.exact);
  }
};

/// Displacement and velocity of the owned nodes, and the factor that later steps may reuse. A value
/// type.
struct TissueState
{
  OwnedField u;                                  ///< [m]
  OwnedField v;                                  ///< [m/s]
  std::shared_ptr<const FactorOrigin> factor{};  ///< empty: none yet, or linear tissue
  solve::FactorAge age{};                        ///< of that factor

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("displacement", "m", self.u);
    v("velocity", "m/s", self.v);
    v("factor", "", self.factor);
    v("factor_uses", "1", self.age.uses);
    v("factor_sweeps", "1", self.age.sweeps);
    v("factor_last_sweeps", "1", self.age.last_sweeps);
  }
};

/// Tissue that nothing has moved.
inline TissueState at_rest(const fem::Space& space)
{
  return {space.zero(), space.zero(), {}, {}};
}

/// Energies at the end of a step and what went in and was lost in it [J].
struct Work
{
  double elastic = 0.0, kinetic = 0.0;
  double supplied = 0.0;  ///< by gravity, tractions and moving supports
  double damped = 0.0;    ///< by Rayleigh damping
};

/// Forces on the tissue [N], equal on every rank, by what holds it: prescribed displacements and
/// supports, as the boundary conditions list them.
struct Reactions
{
  std::vector<Vec3> tools, supports;
};

/// The deformable bodies: one or more volumes of the mesh in one operator
///   A = M/(h h̄) + B/h + K,  B = αM + βK   (static: A = K)    [N/m].
class Tissue
{
 public:
  /// Borrows mesh, space and ledger. Collective.
  Tissue(const mesh::Mesh& mesh, const fem::Space& space, TissueSettings settings,
         core::Ledger& ledger);

  /// Linearises at `iterate` within the step that began at `old`, under loads that are linearised
  /// there as well. `goes_on`: within the step from the last linearisation. Linear tissue keeps one
  /// assembled and factored operator per distinct rates. Refused where an element is turned inside
  /// out or an exact tangent has no factor. What it gives is good until the next one. Collective.
  core::Outcome<solve::Linearisation> linearise(const TissueState& old, const OwnedField& iterate,
                                                const TimeStep& step, const fem::Load& more = {},
                                                bool goes_on = false);

  /// The first tets that u turns inside out; what is not finite is no linear tissue's matter.
  /// Collective; equal on every rank.
  Folded folded(const OwnedField& u) const;

  TangentChoice& tangent() { return tangent_; }

  /// Writes down what the factor was made from and has served. Not collective.
  void remember_factor(TissueState& state) const;
  /// Forgets all that was made for earlier steps. Not collective.
  void drop_caches();
  /// The factor of the last linearisation.
  solve::LaggedFactor& factor() { return current_->factor; }
  const solve::LaggedFactor& factor() const { return current_->factor; }

  /// r = f_ext - f_int(u) - M(Δu/h - v)/h̄ - BΔu/h [N] on free dofs. Collective.
  OwnedField residual(const TissueState& old, const OwnedField& u, const TimeStep& step) const;
  /// The same with forces of rows and fluids, `more`, against what it is the rest of. Collective.
  Balance balance(const TissueState& past, const OwnedField& u, const TimeStep& step,
                  const OwnedField& more);

  /// Forces by which prescribed displacements and supports hold the tissue, `more` [N] being those
  /// of rows and cavities. Costs the elements there. Collective.
  Reactions reactions(const TissueState& old, const OwnedField& u, const TimeStep& step,
                      const OwnedField& more) const;

  /// In file order, equal on every rank. Only on request: an element loop, and all tets on every
  /// rank. Collective.
  StressField stresses(const OwnedField& u) const;

  /// Energy account of an accepted step; `push` is Hᵀλ, and time derivatives count from `past`,
  /// which is `old` with backward Euler. Only on request: an element loop more. Collective.
  Work work(const TissueState& old, const TissueState& past, const TissueState& next,
            const TimeStep& step, const OwnedField& push) const;

  /// Where the operator is linearised at u. False when an element is turned inside out, on every
  /// rank. Collective.
  bool configure(const fem::GhostedField& u, LinearisationPoint& at) const;
  /// Fills the values of the operator. Not collective.
  void assemble(const LinearisationPoint& at, const core::Rates& rate);

  /// A d with the matrix assembled last [N]. Collective.
  OwnedField times(const OwnedField& d) const { return values_.times(*space_, d); }
  /// The same element by element, supports left out. Collective.
  OwnedField operate_by_elements(const LinearisationPoint& at, const core::Rates& rate,
                                 const OwnedField& d) const
  {
    return elements_->operate(at, rate, space_->with_ghosts(d));
  }

  const fem::Dirichlet& fixed() const { return fixed_; }
  /// Makes the solver and its symbolic analysis, so that its memory is known before it is taken.
  /// Collective.
  void analyse();
  /// Builds and factors the operator of a step from rest, so that `-check` can stop. Collective.
  void prepare(const TimeStep& step);

 private:
  struct Operator
  {
    solve::LaggedFactor factor;
    std::optional<core::Rates> rate{};           ///< none: not assembled yet, or to be again
    LinearisationPoint at{};                     ///< it was assembled with; empty for linear tissue
    std::shared_ptr<const FactorOrigin> made{};  ///< from what its factor was; linear tissue: none
  };

  bool linearise_at(const OwnedField& iterate, bool goes_on);
  core::Outcome<core::Done> use_operator(const LinearisationPoint& at, const TimeStep& step);
  core::Outcome<core::Done> make_factor(const LinearisationPoint& at);
  core::Outcome<core::Done> go_on_with_factor(const TissueState& old, const TimeStep& step);
  core::Refusal without_factor(const core::Refusal& refusal) const;
  solve::Linearisation with_operator(const fem::Load& more);
  bool may_lag() const;
  Operator& operator_for(const core::Rates& rate);
  bool factor_worn() const;
  std::vector<Mat3> node_rotations(const std::vector<Mat3>& R,
                                   const std::vector<Mat3>& R_factor) const;
  OwnedField prescribed_increment(const OwnedField& iterate, const TimeStep& step) const;
  OwnedField forces(const TissueState& old, const OwnedField& u, const LinearisationPoint& at,
                    const TimeStep& step, Sizes* sizes = nullptr) const;
  bool forces_known(const TissueState& old, const OwnedField& u, bool goes_on) const;
  OwnedField forces_from_balance(const TissueState& old, const OwnedField& u, const TimeStep& step,
                                 bool goes_on) const;
  OwnedField forces_of(const std::vector<std::size_t>& elements, const TissueState& old,
                       const OwnedField& u, const LinearisationPoint& at,
                       const TimeStep& step) const;
  Kinematics kinematics(const TissueState& old, const OwnedField& u, const TimeStep& step) const;
  Sizes no_sizes() const;
  /// Norm of what need not be balanced: a part of the sizes, and what rounding leaves [N].
  /// Collective.
  double least_rest(const Sizes& sizes, double part) const;
  void find_holders();
  OwnedField external(const TimeStep& step) const;

  const mesh::Mesh* mesh_;
  const fem::Space* space_;
  TissueSettings settings_;
  core::Ledger* ledger_;
  fem::Dirichlet fixed_;
  std::unique_ptr<Elements> elements_;
  TangentChoice tangent_;
  fem::BlockPattern pattern_;
  fem::BlockMatrix values_;
  LinearisationPoint at_;  ///< of the present linearisation
  OwnedField u_at_;        ///< where that is, with an exact tangent [m]
  bool exact_at_ = false;  ///< it is that of an exact tangent; equal on all ranks
  struct
  {
    std::optional<OwnedField> u;
    bool exact = false;  ///< what an exact tangent needs is there
    LinearisationPoint at;
    Sizes sizes;
  } configured_;        ///< where the balance was looked at last: often the next step begins there
  bool known_ = false;  ///< the present linearisation is there
  bool damped_by_stiffness_;  ///< any of the tissue
  OwnedField weight_;         ///< ∫ N_a ρ g of every node [N]
  std::vector<OwnedField> traction_;
  /// Owned dofs that are held, and by which displacement or, after these, support.
  std::vector<std::pair<Eigen::Index, std::size_t>> held_dofs_;
  std::vector<std::size_t> held_elements_;  ///< that touch them
  /// One per distinct pair of rates for linear tissue. Else one, filled again when these or any
  /// rotation change.
  std::vector<Operator> operators_;
  Operator* current_ = nullptr;
};

}  // namespace trocar::tissue
