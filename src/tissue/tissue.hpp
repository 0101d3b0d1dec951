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
  int stale_steps = 10;      ///< linearisations that share a factor with Reuse::stale
  double most_memory = 0.0;  ///< memory limit of a supernodal factor [B]; 0: 70 % of what is free
  std::vector<int> ordered_last;  ///< file nodes near the planned needle paths, eliminated last
  /// Residual over load that a step with a lagged factor must reach; 0: factor in every step.
  double lag_tolerance = 0.0;
  bool allow_inversion = false;  ///< accept inverted elements in linear tissue
  /// Part of the forces at a node that may stay unbalanced in a step that is iterated to the end.
  double newton_tolerance = 1e-8;
};

/// Data from which the factor of turning tissue was made. They suffice to make it again.
struct FactorOrigin
{
  core::Rates rates;
  LinearisationPoint at;  ///< where the operator was linearised
  bool exact = false;     ///< the operator had the exact tangent

  /// Names every member and its unit, see core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("velocity_rate", "1/s", self.rates.velocity);
    v("acceleration_rate", "1/s", self.rates.acceleration);
    v("mass_rate", "1/s^2", self.rates.mass);
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
  std::shared_ptr<const FactorOrigin> factor{};  ///< empty: no factor yet, or linear tissue
  solve::FactorAge age{};                        ///< how often that factor was used

  /// Names every member and its unit, see core/visit.hpp.
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

/// Undeformed tissue at rest.
inline TissueState at_rest(const fem::Space& space)
{
  return {space.zero(), space.zero(), {}, {}};
}

/// Energies at the end of a step, and work supplied and dissipated in the step [J].
struct Work
{
  double elastic = 0.0, kinetic = 0.0;
  double supplied = 0.0;  ///< by gravity, tractions and moving supports
  double damped = 0.0;    ///< by Rayleigh damping
};

/// Forces on the tissue [N] by its holders, in the order of the boundary conditions: one by each
/// prescribed displacement (`tools`) and one by each support. Equal on every rank.
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

  /// Linearises the tissue at `iterate`. `more`: further loads, linearised at `iterate` as well.
  /// Velocities are differences to `old`. `goes_on`: this step has been linearised before. Linear
  /// tissue keeps two factored operators, each for its own step length (`core::Rates`). Refused
  /// when an element is inverted or an exact tangent has no factor. The result is valid until the
  /// next call. Collective.
  core::Outcome<solve::Linearisation> linearise(const TissueState& old, const OwnedField& iterate,
                                                const TimeStep& step, const fem::Load& more = {},
                                                bool goes_on = false);

  /// The first inverted tets at u. A u that is not finite counts as an inversion of tet 0 in
  /// `other`, so that no option accepts it. Collective; equal on every rank.
  Folded folded(const OwnedField& u) const;

  TangentChoice& tangent() { return tangent_; }

  /// Stores in `state` what the factor was made from and how often it was used. Not collective.
  void remember_factor(TissueState& state) const;
  /// Forgets the operators, factors and forces of earlier steps. Not collective.
  void drop_caches();
  /// The factor of the last linearisation.
  solve::LaggedFactor& factor() { return current_->factor; }
  const solve::LaggedFactor& factor() const { return current_->factor; }

  /// r = f_ext - f_int(u) - M(Δu/h - v)/h̄ - BΔu/h [N]; 0 on fixed dofs. Collective.
  OwnedField residual(const TissueState& old, const OwnedField& u, const TimeStep& step) const;
  /// Adds the forces `more` of rows and fluids [N] to the residual and compares the sum with the
  /// magnitudes of its terms. Keeps the forces at u, which the next `linearise` may use.
  /// Collective.
  Balance balance(const TissueState& past, const OwnedField& u, const TimeStep& step,
                  const OwnedField& more);

  /// Forces by which prescribed displacements and supports hold the tissue. `more`: forces of rows
  /// and cavities [N]. Visits only the elements at held nodes. Collective.
  Reactions reactions(const TissueState& old, const OwnedField& u, const TimeStep& step,
                      const OwnedField& more) const;

  /// Stress of all tets in file order, equal on every rank. Computed only on request, because it
  /// costs an element loop and memory for all tets on every rank. Collective.
  StressField stresses(const OwnedField& u) const;

  /// Energies and work of an accepted step. `push`: forces of rows and fluids [N]. Velocities
  /// are differences to `past`, which is `old` with backward Euler. Computed only on request,
  /// because it costs an element loop. Collective.
  Work work(const TissueState& old, const TissueState& past, const TissueState& next,
            const TimeStep& step, const OwnedField& push) const;

  /// Sets the linearisation point `at` for the displacement u. False on every rank when an element
  /// of any rank is inverted. Collective.
  bool configure(const fem::GhostedField& u, LinearisationPoint& at) const;
  /// Assembles the matrix A for `at` and `rate`. Fixed dofs keep only their diagonal entry. Not
  /// collective.
  void assemble(const LinearisationPoint& at, const core::Rates& rate);

  /// A d with the matrix assembled last [N]. Collective.
  OwnedField times(const OwnedField& d) const { return values_.times(*space_, d); }
  /// The product of A with d, element by element, as if no dof were fixed [N]. Collective.
  OwnedField operate_by_elements(const LinearisationPoint& at, const core::Rates& rate,
                                 const OwnedField& d) const
  {
    return elements_->operate(at, rate, space_->with_ghosts(d));
  }

  const fem::Dirichlet& fixed() const { return fixed_; }
  /// Makes the solver with its symbolic analysis. The memory of the factor is then known before it
  /// is allocated. Collective.
  void analyse();
  /// Assembles and factors the operator of undeformed tissue, after which `-check` can stop. Throws
  /// Failure (70) when there is no factor. Collective.
  void prepare(const TimeStep& step);

 private:
  struct Operator
  {
    solve::LaggedFactor factor;
    std::optional<core::Rates> rate{};  ///< of the assembled matrix; empty: it must be assembled
    LinearisationPoint at{};            ///< where the matrix was assembled; empty for linear tissue
    std::shared_ptr<const FactorOrigin> made{};  ///< source of the factor; empty for linear tissue
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
  /// Norm of a residual that need not be reduced further [N]: `part` of the sizes plus the rounding
  /// error. Collective.
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
  OwnedField u_at_;        ///< displacement of at_, kept for exact tangents only [m]
  bool exact_at_ = false;  ///< at_ belongs to an exact tangent; equal on all ranks
  struct
  {
    std::optional<OwnedField> u;
    bool exact = false;  ///< `at` has what an exact tangent needs
    LinearisationPoint at;
    Sizes sizes;
  } configured_;              ///< from the last `balance`; the next step often begins at this u
  bool known_ = false;        ///< at_ was copied from configured_
  bool damped_by_stiffness_;  ///< some volume has stiffness damping
  OwnedField weight_;         ///< weight at every owned node [N]
  std::vector<OwnedField> traction_;
  /// Held owned dofs, each with the index of its holder: displacements first, then supports.
  std::vector<std::pair<Eigen::Index, std::size_t>> held_dofs_;
  std::vector<std::size_t> held_elements_;  ///< local elements that touch held nodes
  /// Linear tissue: one for each of the last two pairs of rates. Other tissue: one, assembled again
  /// when the rates or its linearisation point change.
  std::vector<Operator> operators_;
  Operator* current_ = nullptr;
};

}  // namespace trocar::tissue
