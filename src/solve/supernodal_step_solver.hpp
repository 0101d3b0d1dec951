#pragma once

#include <map>
#include <optional>

#include "solve/domain.hpp"
#include "solve/interface_block.hpp"
#include "solve/reach_columns.hpp"
#include "solve/step_solver.hpp"

namespace trocar::solve {

/// Step solver by supernodal Cholesky (CHOLMOD, ordered by METIS on the graph of the free nodes).
/// One forward and one backward half-sweep per step serve free motion, constraints and correction.
/// A compliance column costs one path of the elimination tree (docs/theory.md section 8). Every
/// rank eliminates the inside of its domain. The Schur complement on the interface between the
/// domains is a dense block on rank 0.
class SupernodalStepSolver final : public StepSolver, private IsolatedCompliance
{
 public:
  /// If the interface has more than `most_shared` dofs, only `shared_dofs` of this object may be
  /// used.
  SupernodalStepSolver(const StepSolverParts& parts, int most_shared);

  void set_operator(const fem::BlockMatrix& values) override;
  HalfSolution begin(const OwnedField& b) override;
  core::VecX at(const Probes& probes, const HalfSolution& half) override;
  OwnedField finish(const HalfSolution& half, const Probes& probes, const core::VecX& f) override;
  IsolatedCompliance& compliance() override { return *this; }
  void turn(const std::vector<core::Mat3>& R) override;
  bool can_turn() const override { return true; }
  double sweeps_per_factor() const override { return sweeps_per_factor_; }
  double factor_bytes() const override { return bytes_; }
  double memory_bytes() const override { return memory_; }
  int shared_dofs() const override { return static_cast<int>(interface_.size()); }
  std::string describe() const override;

 private:
  core::MatX block(const Probes& probes, ComplianceReport& report) override;
  void forget_columns();
  WholePattern gather_pattern(const StepSolverParts& parts);
  Domain hand_out(Dissection& dissection);
  void weigh(bool turns);
  std::vector<double> gather_values(const fem::BlockMatrix& values) const;
  core::MatX interface_of(const std::vector<double>& values) const;
  std::vector<double> entries_for_me(const std::vector<double>& values,
                                     const core::VecX& sums) const;
  void gather_open_blocks(const core::VecX& sums, core::MatX& interface) const;

  std::vector<int> slots_of(const Probes& probes, ComplianceReport& report);
  void add_nodes(const std::vector<int>& nodes);
  void add_wides(const Probes& probes, ComplianceReport& report);
  HalfSolution forward(const OwnedField& b, bool single);
  core::VecX read_here(const Probes& probes, const std::vector<int>& slots,
                       const HalfSolution& half) const;
  void add_to_interface(core::MatX& columns);
  OwnedField turned_back(const OwnedField& field) const;
  core::VecX turned_back(const Probes& probes, const core::VecX& f) const;
  void turn_rows(const Probes& probes, core::MatX& rows) const;
  const core::Mat3& turned(int file_node) const { return R_[static_cast<std::size_t>(file_node)]; }

  core::VecX mine(const OwnedField& field) const;
  core::VecX interface_part(const OwnedField& field) const;
  core::VecX sum_on_root(const core::VecX& values) const;
  void add_left_over(const core::VecX& y, core::VecX& interface) const;
  OwnedField assembled(const core::VecX& y, const core::VecX& interface) const;

  const fem::Space* space_;
  const fem::Dirichlet* fixed_;
  core::Ledger* ledger_;
  bool reuse_;
  double bytes_ = 0.0, memory_ = 0.0;
  double sweeps_per_factor_ = 0.0;
  int ordered_last_ = 0;                         ///< number of nodes that are eliminated last
  std::vector<int> value_count_, value_start_;   ///< count and offset of each rank's block values
  std::vector<int> interface_;                   ///< global dofs of the interface, ascending
  std::vector<int> open_;                        ///< index into `interface_` of every open dof
  std::map<int, int> interface_index_;           ///< index into `interface_` by global dof
  std::vector<std::vector<long long>> sources_;  ///< `Dissection::source`, on rank 0
  std::vector<Dissection::InterfaceEntry> interface_entries_;  ///< on rank 0
  std::vector<int> index_;                  ///< by owned dof: dof of the domain, or -1
  std::optional<SupernodalFactor> factor_;  ///< of the domain; none if the domain is empty
  std::optional<ReachColumns> columns_;     ///< of X; there is one where there is a factor
  InterfaceBlock interface_block_;          ///< on rank 0
  std::map<int, int> first_slot_of_node_;   ///< file node -> slot of its x dof
  struct Wide
  {
    long long version;
    HalfSolution half;
  };
  std::map<long long, Wide> wides_;  ///< columns of the wide probes by id
  int slots_ = 0;                    ///< number of slots of nodal columns
  std::vector<core::Mat3> R_;        ///< rotations since factoring, by file node; empty: none
};

}  // namespace trocar::solve
