#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/ledger.hpp"
#include "fem/dirichlet.hpp"
#include "solve/linear_system.hpp"
#include "solve/probes.hpp"

namespace trocar::solve {

/// Work for one compliance block; columns are counted in dofs.
struct ComplianceReport
{
  int probes = 0;        ///< dofs in the block
  int built = 0;         ///< columns computed for it
  int reused = 0;        ///< columns taken from the cache
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
  /// Columns of the step's own operator. Columns of an older factor serve only in iterations that
  /// lead to the same answer (docs/theory.md, algorithm 8.3).
  exact,
  stale,  ///< columns of a factor that several steps share, as in the needle paper (algorithm 8.4)
  none    ///< no columns of earlier steps: every step builds its own
};

/// The isolated compliance C = S A⁻¹ Sᵀ [m/N]; S selects the probed dofs. Dofs with a prescribed
/// displacement have zero rows and columns in C.
class IsolatedCompliance
{
 public:
  virtual ~IsolatedCompliance() = default;
  /// C for these probes, equal on every rank. Columns that are known for the current version of the
  /// operator are not computed again. Collective.
  virtual core::MatX block(const Probes& probes, ComplianceReport& report) = 0;
};

/// How new columns are computed.
enum class ColumnSolver {
  one_by_one,  ///< provider `ksp`: one KSP solve per isolated dof, the paper's route
  blocked      ///< provider `ksp_block`: KSPMatSolve on up to 64 columns
};

/// Columns by PETSc KSP, on any number of ranks. Only C is kept, not A⁻¹Sᵀ. A new column read at
/// the old probes also gives the old columns read at the new probe, because C is symmetric.
class KspCompliance final : public IsolatedCompliance
{
 public:
  /// Borrows the system and the fixed dofs; both must outlive this object.
  KspCompliance(LinearSystem& system, const fem::Dirichlet& fixed, ColumnSolver solver,
                core::Ledger& ledger);

  core::MatX block(const Probes& probes, ComplianceReport& report) override;
  void forget();  ///< discards all columns

 private:
  struct Column
  {
    int node = -1;  ///< file node, -1 for a wide probe
    int axis = 0;
    const DistributedFunctional* wide = nullptr;  ///< only valid while it is being built
    bool fixed = false;                           ///< prescribed dof: the column is zero
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
    OwnedField vector;  ///< copy, because later columns are read at this probe too
  };
  std::map<long long, Wide> wides_;
  core::MatX C_;
};

}  // namespace trocar::solve
