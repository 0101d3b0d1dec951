#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/ledger.hpp"
#include "fem/dirichlet.hpp"
#include "solve/linear_system.hpp"
#include "solve/probes.hpp"

namespace trocar::solve {

/// How a compliance block was come by, in dofs.
struct ComplianceReport
{
  int probes = 0;        ///< dofs in the block
  int built = 0;         ///< columns computed for it
  int reused = 0;        ///< columns served from the cache
  double seconds = 0.0;  ///< this rank's wall time, factorisation excluded

  ComplianceReport& operator+=(const ComplianceReport& more)
  {
    probes = more.probes;
    built += more.built;
    reused += more.reused;
    seconds += more.seconds;
    return *this;
  }
};

/// Which columns of the isolated compliance a step may use.
enum class Reuse {
  exact,  ///< those of its own operator, or laws repeated until they are met as with those
  stale,  ///< those of a factor that some steps share, the needle paper's way
  none    ///< all are built in every step
};

/// The isolated compliance C = S A⁻¹ Sᵀ [m/N] on the probed dofs; S selects them. Dofs with a
/// prescribed displacement are never probes: their rows and columns are zero.
class IsolatedCompliance
{
 public:
  virtual ~IsolatedCompliance() = default;
  /// C for these probes, equal on every rank. Columns of the current operator version that are
  /// already known are not computed again. Collective.
  virtual core::MatX block(const Probes& probes, ComplianceReport& report) = 0;
};

/// How new columns are computed.
enum class ColumnSolver {
  one_by_one,  ///< provider `ksp`: one KSP solve per isolated dof, the paper's route
  blocked      ///< provider `ksp_block`: KSPMatSolve on up to 64 columns
};

/// Columns by PETSc KSP on any rank count. Only C is kept, not A⁻¹Sᵀ: a new column read at the old
/// probes gives, by symmetry, the old columns read at the new probe.
class KspCompliance final : public IsolatedCompliance
{
 public:
  /// Borrows the system and the fixed set; both must outlive this object.
  KspCompliance(LinearSystem& system, const fem::Dirichlet& fixed, ColumnSolver solver,
                core::Ledger& ledger);

  core::MatX block(const Probes& probes, ComplianceReport& report) override;
  void forget();  ///< all columns

 private:
  struct Column
  {
    int node = -1;  ///< file node, -1 for a wide probe
    int axis = 0;
    const DistributedFunctional* wide = nullptr;  ///< only valid while it is being built
    bool fixed = false;                           ///< zero by definition, never solved for
  };

  std::vector<int> slots_of(const Probes& probes, std::vector<int>& missing);
  void build(const std::vector<int>& missing);
  core::MatX right_hand_sides(const std::vector<int>& slots) const;
  core::MatX read_at_probes(const core::MatX& columns) const;

  LinearSystem* system_;
  const fem::Dirichlet* fixed_;
  ColumnSolver solver_;
  core::Ledger* ledger_;
  int version_ = -1;
  std::vector<Column> columns_;            ///< by slot
  std::map<int, int> first_slot_of_node_;  ///< file node -> slot of its x dof
  std::map<long long, int> slot_of_wide_;
  struct Wide
  {
    long long version;
    OwnedField vector;  ///< a copy: old wide rows meet new columns
  };
  std::map<long long, Wide> wides_;
  core::MatX C_;
};

}  // namespace trocar::solve
