#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/time_step.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"
#include "solve/step_solver.hpp"
#include "tissue/approach.hpp"
#include "tissue/balance.hpp"
#include "tissue/boundary.hpp"
#include "tissue/elements.hpp"

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
  std::vector<int> pinned;   ///< file nodes that needles are planned to reach
  /// Equilibrium that a step with an older factor must reach, of its load; 0: always factor anew.
  double lag_tolerance = 0.0;
  bool allow_inversion = false;  ///< of linear tissue, which feels nothing of it
  /// Part of the forces at a node that may be left unbalanced where steps are iterated to the end.
  double newton_tolerance = 1e-8;
};

/// Displacement and velocity of every owned node. A value.
struct TissueState
{
  OwnedField u;  ///< [m]
  OwnedField v;  ///< [m/s]
};

/// Answer of the tissue alone to one linearisation: u_free = base + A⁻¹ r, half solved.
struct FreeMotion
{
  OwnedField base;                       ///< the iterate, with prescribed displacements [m]
  solve::HalfSolution half;              ///< of A⁻¹ r; with an approach only after `start_from`
  std::optional<std::string> trouble{};  ///< why the step cannot be taken; equal on all ranks
  core::VecX pushed{};                   ///< multipliers that r holds already (rows, or none) [N]
  std::optional<Approach> approach{};    ///< with a factor of an older operator
};

/// Energies at the end of a step and what went in and was lost in it [J].
struct Work
{
  double elastic = 0.0, kinetic = 0.0;
  double supplied = 0.0;  ///< by gravity, tractions and moving supports
  double damped = 0.0;    ///< by Rayleigh damping
};

/// Forces on the tissue [N], equal on every rank, by what holds it: prescribed displacements and
/// supports, as the boundary conditions list them.
struct HolderForces
{
  std::vector<Vec3> tools, supports;
};

/// The deformable bodies: one or more volumes of the mesh in one operator
///   A = M/(h h̄) + B/h + K,  B = αM + βK   (static: A = K)    [N/m].
class Tissue
{
 public:
  /// Passes of an approach, beside those that cost as much as a factor, before one is made.
  static constexpr int most_passes = 8;
  /// Passes of one with a factor of its own, under loads that follow.
  static constexpr int most_passes_of_own = 200;

  /// Borrows mesh, space and ledger. Collective.
  Tissue(const mesh::Mesh& mesh, const fem::Space& space, TissueSettings settings,
         core::Ledger& ledger);

  TissueState at_rest() const { return {space_->zero(), space_->zero()}; }

  /// Linearises at `iterate` within the step that began at `old` and solves for the motion without
  /// constraints, under loads that are linearised there as well; those that follow the tissue make
  /// it an approach. `goes_on`: within the step from the last linearisation. Linear tissue keeps
  /// one assembled and factored operator per distinct rates. Collective.
  FreeMotion free_motion(const TissueState& old, const OwnedField& iterate, const TimeStep& step,
                         const fem::Load& more = {}, bool goes_on = false);

  /// The first tet that u, or a part of it that is not finite, turns inside out, in file numbering;
  /// -1: none. Collective; equal on every rank.
  int folded(const OwnedField& u) const;

  /// Tangents of `automatic`: every step begins with the rotated one, may take the exact one from
  /// some linearisation on, and goes back for good when that has no factor. Each returns whether
  /// anything changed.
  void begin_step();
  bool take_exact();
  bool drop_exact();
  bool exact_tangent() const { return settings_.exact_tangent(); }

  /// u_free - u at the probes [m], by slot. Collective.
  core::VecX at(const solve::Probes& probes, const FreeMotion& motion, const OwnedField& u);

  /// u_free + A⁻¹ Sᵀ f [m] for forces f [N] by slot of the probes; without probes u_free.
  /// Collective.
  OwnedField finish(const FreeMotion& motion, const solve::Probes& probes, const core::VecX& f);

  /// Starts an approach from multipliers and what they push with, Hᵀλ [N]: with a factor in single
  /// precision only what is not yet balanced may go through it. Collective.
  void start_from(FreeMotion& motion, const core::VecX& lambda, const OwnedField& forces);
  /// The way from u to u + A⁻¹ f for nodal forces f [N], with the operator of the last
  /// `free_motion`. Collective.
  FreeMotion pushed(const OwnedField& u, const OwnedField& forces);
  /// True when u is the answer to this linearisation; else `motion` becomes the next pass of the
  /// approach to it, or has its trouble: no stable equilibrium under loads that follow.
  /// `tolerance`: of ‖r + Hᵀλ - AΔu‖ against ‖r‖ + ‖Hᵀλ‖. Collective.
  bool converged(FreeMotion& motion, const OwnedField& u, const Push& push, double tolerance);
  /// Factors the present operator and goes on with it, from where the approach stands. Collective.
  void give_up(FreeMotion& motion);
  /// The factor is that of an older operator.
  bool lags() const { return current_->older; }
  /// A⁻¹ f [m] for nodal forces f [N] with the operator of the last `free_motion`. Collective.
  OwnedField answer(const OwnedField& forces);
  /// Counts the factors made: compliance columns of one version belong together.
  int factor_version() const { return factor_version_; }
  /// Linearisations that the factor has served.
  int factor_age() const { return current_->uses; }

  /// A⁻¹ f for nodal forces f [N] with the operator of the last `free_motion`, half solved.
  /// Collective.
  solve::HalfSolution begin(const OwnedField& forces);

  /// r = f_ext - f_int(u) - M(Δu/h - v)/h̄ - BΔu/h [N] on free dofs. Collective.
  OwnedField residual(const TissueState& old, const OwnedField& u, const TimeStep& step) const;
  /// The same with forces of rows and fluids, `more`, against what it is the rest of. Collective.
  Balance balance(const TissueState& past, const OwnedField& u, const TimeStep& step,
                  const OwnedField& more);

  /// Forces by which prescribed displacements and supports hold the tissue, `more` [N] being those
  /// of rows and cavities. Costs the elements there. Collective.
  HolderForces holder_forces(const TissueState& old, const OwnedField& u, const TimeStep& step,
                             const OwnedField& more) const;

  /// In file order, equal on every rank. Only on request: an element loop, and all tets on every
  /// rank. Collective.
  StressField stresses(const OwnedField& u) const;

  /// Energy account of an accepted step; `push` is Hᵀλ, and time derivatives count from `past`,
  /// which is `old` with backward Euler. Only on request: an element loop more. Collective.
  Work work(const TissueState& old, const TissueState& past, const TissueState& next,
            const TimeStep& step, const OwnedField& push) const;

  /// The compliance that belongs to the operator of the last `free_motion`.
  solve::IsolatedCompliance& compliance() { return current_->solver->compliance(); }

  /// Where the operator is linearised at u. False when an element is turned inside out, on every
  /// rank. Collective.
  bool configure(const fem::GhostedField& u, Configuration& at) const;
  /// Fills the values of the operator. Not collective.
  void assemble(const Configuration& at, const core::Rates& rate);

  /// A d with the matrix assembled last [N]. Collective.
  OwnedField times(const OwnedField& d) const { return values_.times(*space_, d); }
  /// The same element by element, supports left out. Collective.
  OwnedField operate_by_elements(const Configuration& at, const core::Rates& rate,
                                 const OwnedField& d) const
  {
    return elements_->operate(at, rate, space_->with_ghosts(d));
  }

  const fem::Dirichlet& fixed() const { return fixed_; }
  const mesh::Mesh& mesh() const { return *mesh_; }
  const fem::Space& space() const { return *space_; }
  std::string describe_solver() const;
  double factor_bytes() const { return current_->solver->factor_bytes(); }  ///< 0: not ours [B]
  double memory_bytes() const { return current_->solver->memory_bytes(); }  ///< estimate, likewise
  /// Makes the solver and its symbolic analysis, so that its memory is known before it is taken.
  /// Collective.
  void analyse();
  /// Builds and factors the operator of a step from rest, so that `-check` can stop. Collective.
  void prepare(const TimeStep& step);

 private:
  struct Operator
  {
    std::optional<core::Rates> rate;         ///< none: not assembled yet, or to be again
    Configuration at;                        ///< it was assembled with; empty for linear tissue
    std::vector<Mat3> R_factor;              ///< rotations its factor was made with
    bool older = false;                      ///< the factor is that of an older operator
    int uses = 0;                            ///< linearisations that the factor has served
    double sweeps = 0.0, last_sweeps = 0.0;  ///< they took in all, and the last one
    std::unique_ptr<solve::StepSolver> solver;
  };

  bool linearise_at(const OwnedField& iterate, bool goes_on);
  void use_operator(const Configuration& at, const TimeStep& step);
  void factor(const std::vector<Mat3>& R);
  std::optional<std::string> why_not(const std::function<void()>& make_operator);
  bool factor_worn() const;
  std::vector<Mat3> turned_nodes(const std::vector<Mat3>& R,
                                 const std::vector<Mat3>& R_factor) const;
  void begin_approach(const TissueState& old, const TimeStep& step, const OwnedField& r,
                      const fem::Load& more, double least, bool goes_on, FreeMotion& motion);
  void change_rows(Approach& approach, const OwnedField& d, const OwnedField& A_d,
                   const core::VecX& more, const OwnedField& pushed, const Push& push,
                   bool same_laws) const;
  bool advance(Approach& approach, OwnedField d, OwnedField A_d, core::VecX more,
               const Push& push) const;
  void end_approach(FreeMotion& motion, bool convex);
  OwnedField operate(const Approach& approach, const OwnedField& d) const;
  OwnedField forces(const TissueState& old, const OwnedField& u, const Configuration& at,
                    const TimeStep& step, Sizes* sizes = nullptr) const;
  bool forces_known(const TissueState& old, const OwnedField& u, bool goes_on) const;
  OwnedField forces_from_balance(const TissueState& old, const OwnedField& u, const TimeStep& step,
                                 bool goes_on) const;
  OwnedField forces_of(const std::vector<std::size_t>& elements, const TissueState& old,
                       const OwnedField& u, const Configuration& at, const TimeStep& step) const;
  Kinematics kinematics(const TissueState& old, const OwnedField& u, const TimeStep& step) const;
  Sizes no_sizes() const;
  void take(Tangent tangent);
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
  fem::BlockPattern pattern_;
  fem::BlockMatrix values_;
  Configuration at_;       ///< of the present linearisation
  OwnedField u_at_;        ///< where that is, with an exact tangent [m]
  bool exact_at_ = false;  ///< it is that of an exact tangent; equal on all ranks
  struct
  {
    std::optional<OwnedField> u;
    Configuration at;
    Sizes sizes;
  } configured_;        ///< where the balance was looked at last: often the next step begins there
  bool known_ = false;  ///< the present linearisation is there
  bool damped_by_stiffness_;  ///< any of the tissue
  bool automatic_;            ///< the tangent may change within a step
  bool dropped_ = false;      ///< not to the exact one in this step
  OwnedField weight_;         ///< ∫ N_a ρ g of every node [N]
  std::vector<OwnedField> traction_;
  /// Owned dofs that are held, and by which displacement or, after these, support.
  std::vector<std::pair<Eigen::Index, std::size_t>> held_dofs_;
  std::vector<std::size_t> held_elements_;  ///< that touch them
  /// One per distinct pair of rates for linear tissue. Else one, filled again when these or any
  /// rotation change.
  std::vector<Operator> operators_;
  Operator* current_ = nullptr;
  int factor_version_ = 0;
};

}  // namespace trocar::tissue
