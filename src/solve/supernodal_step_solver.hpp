#pragma once

#include <map>
#include <optional>

#include "solve/reach_columns.hpp"
#include "solve/step_solver.hpp"

namespace trocar::solve {

/// Supernodal Cholesky on rank 0 (CHOLMOD, METIS on the graph of the free nodes): one forward and
/// one backward half-sweep per step serve free motion, constraints and correction, and compliance
/// columns cost a path of the elimination tree (docs/theory.md section 8). Other ranks assemble and
/// wait.
class SupernodalStepSolver final : public StepSolver, private IsolatedCompliance
{
 public:
  explicit SupernodalStepSolver(const StepSolverParts& parts);

  void set_operator(const fem::BlockMatrix& values) override;
  HalfSolution begin(const OwnedField& b) override;
  core::VecX at(const Probes& probes, const HalfSolution& half) override;
  OwnedField finish(const HalfSolution& half, const Probes& probes, const core::VecX& f) override;
  IsolatedCompliance& compliance() override { return *this; }
  bool turn(const std::vector<core::Mat3>& R) override;
  double sweeps_per_factor() const override { return sweeps_per_factor_; }
  double factor_bytes() const override { return bytes_; }
  std::string describe() const override;

 private:
  /// Upper block pattern of the whole matrix in global node numbers, on rank 0.
  struct Blocks
  {
    std::vector<int> row, column;
  };

  core::MatX block(const Probes& probes, ComplianceReport& report) override;
  void forget_columns();
  void number_free_dofs();
  Blocks gather_blocks(const fem::BlockPattern& pattern);
  void analyse(const Blocks& blocks, const std::vector<int>& pinned);
  std::vector<int> dof_order(const std::vector<std::vector<int>>& neighbours,
                             const std::vector<int>& pinned) const;
  std::vector<int> slots_of(const Probes& probes, ComplianceReport& report);
  core::VecX gather_free(const OwnedField& field) const;
  OwnedField scatter_free(const core::VecX& y) const;
  void turn_rows(const Probes& probes, core::MatX& rows) const;
  core::VecX turned_back(const Probes& probes, const core::VecX& f) const;
  const core::Mat3& turned(int file_node) const { return R_[static_cast<std::size_t>(file_node)]; }

  const fem::Space* space_;
  const fem::Dirichlet* fixed_;
  core::Ledger* ledger_;
  bool reuse_;
  double bytes_ = 0.0;
  double sweeps_per_factor_ = 0.0;
  int pinned_ = 0;                              ///< nodes put last
  std::vector<int> value_count_, value_start_;  ///< doubles of every rank's blocks
  std::vector<int> dof_count_, dof_start_;      ///< dofs of every rank
  std::vector<int> free_;                       ///< free number by global dof, -1 when fixed
  int free_count_ = 0;
  std::vector<std::size_t> source_;  ///< by matrix entry: where its value stands in the blocks
  std::optional<SupernodalFactor> factor_;  ///< on rank 0
  std::optional<ReachColumns> columns_;     ///< on rank 0
  std::map<int, int> first_slot_of_node_;   ///< file node -> slot of its x dof
  std::map<long long, int> slot_of_wide_;
  int slots_ = 0;
  std::vector<core::Mat3> R_;  ///< see `turn`
};

}  // namespace trocar::solve
