#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/time_step.hpp"
#include "mesh/mesh.hpp"
#include "solve/step_solver.hpp"
#include "tissue/boundary.hpp"
#include "tissue/elastic.hpp"

namespace trocar::tissue {

using core::TimeStep;
using fem::OwnedField;

enum class Model { linear, corotational };
enum class Mass { consistent, lumped };

struct TissueSettings
{
  Model model = Model::corotational;
  Mass mass = Mass::consistent;
  std::vector<Material> materials;  ///< by volume of the mesh
  BoundaryConditions boundary;
  solve::LinearSettings linear;
  solve::Provider provider = solve::Provider::automatic;
  bool reuse_columns = true;
  double most_memory = 0.0;  ///< that a factor of our own may take [B], 0: a part of what is free
  std::vector<int> pinned;   ///< file nodes that needles are planned to reach
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
  OwnedField base;                     ///< the iterate, with prescribed displacements [m]
  solve::HalfSolution half;            ///< of A⁻¹ r
  std::optional<std::string> trouble;  ///< why the step cannot be taken; equal on all ranks
};

/// Energies at the end of a step and what went in and was lost in it [J].
struct Work
{
  double elastic = 0.0, kinetic = 0.0;
  double supplied = 0.0;  ///< by gravity, tractions and moving supports
  double damped = 0.0;    ///< by Rayleigh damping
};

/// The deformable bodies: one or more volumes of the mesh in one operator
///   A = M/h² + B/h + K,  B = αM + βK   (static: A = K)    [N/m].
class Tissue
{
 public:
  /// Borrows mesh, space and ledger. Collective.
  Tissue(const mesh::Mesh& mesh, const fem::Space& space, TissueSettings settings,
         core::Ledger& ledger);

  TissueState at_rest() const { return {space_->zero(), space_->zero()}; }

  /// Linearises at `iterate` within the step that began at `old` and solves for the motion without
  /// constraints. Linear tissue keeps one assembled and factored operator per distinct h.
  /// Collective.
  FreeMotion free_motion(const TissueState& old, const OwnedField& iterate, const TimeStep& step);

  /// False when a displacement is not finite or turns a corotational element inside out.
  /// Collective.
  bool possible(const OwnedField& u) const;

  /// u_free - u at the probes [m], by slot. Collective.
  core::VecX at(const solve::Probes& probes, const FreeMotion& motion, const OwnedField& u);

  /// u_free + A⁻¹ Sᵀ f [m] for forces f [N] by slot of the probes; without probes u_free.
  /// Collective.
  OwnedField finish(const FreeMotion& motion, const solve::Probes& probes, const core::VecX& f);

  /// A⁻¹ f for nodal forces f [N] with the operator of the last `free_motion`, half solved.
  /// Collective.
  solve::HalfSolution begin(const OwnedField& forces);

  /// r = f_ext - f_int(u) - M(Δu/h - v)/h - BΔu/h [N] on free dofs, and the size of its terms.
  /// `scale` gets ‖f_ext‖ + ‖f_int‖ + ‖inertia‖, but at least 1e-5 E V^(2/3): an unloaded body is
  /// in balance although its round-off is as large as its forces. Collective.
  OwnedField residual(const TissueState& old, const OwnedField& u, const TimeStep& step,
                      double& scale) const;

  /// Energy account of an accepted step; `push` is Hᵀλ. Only on request: an element loop more.
  /// Collective.
  Work work(const TissueState& old, const TissueState& next, const TimeStep& step,
            const OwnedField& push) const;

  /// The compliance that belongs to the operator of the last `free_motion`.
  solve::IsolatedCompliance& compliance() { return current_->solver->compliance(); }

  const fem::Dirichlet& fixed() const { return fixed_; }
  const mesh::Mesh& mesh() const { return *mesh_; }
  const fem::Space& space() const { return *space_; }
  std::string describe_solver() const;
  double factor_bytes() const { return current_->solver->factor_bytes(); }  ///< 0: not ours [B]
  /// Builds and factors the operator of a step from rest, so that `-check` can stop. Collective.
  void prepare(const TimeStep& step);

 private:
  struct Element
  {
    fem::TetShape shape;
    int region;
  };
  struct Operator
  {
    double inverse_h = -1.0;
    std::vector<Mat3> R;  ///< rotations it was assembled with; empty for linear tissue
    std::unique_ptr<solve::StepSolver> solver;
  };

  bool rotations(const fem::GhostedField& u, std::vector<Mat3>& R) const;
  void use_operator(const std::vector<Mat3>& R, const TimeStep& step);
  void assemble(const std::vector<Mat3>& R, double inverse_h);
  OwnedField forces(const TissueState& old, const OwnedField& u, const std::vector<Mat3>& R,
                    const TimeStep& step, double* scale) const;
  OwnedField external(const TimeStep& step) const;
  OwnedField apply_operator(const OwnedField& d, const std::vector<Mat3>& R,
                            double inverse_h) const;

  const mesh::Mesh* mesh_;
  const fem::Space* space_;
  TissueSettings settings_;
  core::Ledger* ledger_;
  fem::Dirichlet fixed_;
  fem::BlockPattern pattern_;
  fem::BlockMatrix values_;
  double smallest_scale_ = 0.0;    ///< 1e-5 E V^(2/3) [N]
  std::vector<Element> elements_;  ///< by local tet
  OwnedField weight_;              ///< ρ g V/4 per node [N]
  std::vector<OwnedField> traction_;
  /// One per distinct h for linear tissue. Else one, filled again when h or any rotation changes.
  std::vector<Operator> operators_;
  Operator* current_ = nullptr;
};

}  // namespace trocar::tissue
