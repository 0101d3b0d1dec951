#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/dense.hpp"
#include "law/problem.hpp"
#include "solve/probes.hpp"

namespace trocar::constraint {

using core::Vec3;

/// Where a row acts on the tissue: a material place as a weighted mean of nodes. A coupling point
/// has the nodes of its tet (4 or 10), a tip's support has the nodes around the tip.
struct Anchor
{
  std::vector<int> node;  ///< file nodes
  core::VecX weight;      ///< by node, sum 1; a node of weight zero is not probed

  /// Σ weight · value(node).
  template <class Value>
  Vec3 mean(const Value& value) const
  {
    Vec3 sum = Vec3::Zero();
    for (std::size_t a = 0; a < node.size(); ++a)
      sum += weight[static_cast<Eigen::Index>(a)] * value(node[a]);
    return sum;
  }

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("node", "1", self.node);
    v("weight", "1", self.weight);
  }
};

/// An anchor of these nodes and weights.
Anchor anchor_of(const std::map<int, double>& weight);

/// Displacement of a material place in a direction: direction · u(anchor).
struct TissueTerm
{
  Anchor anchor;
  Vec3 direction = Vec3::Zero();  ///< world frame
};

/// Term of one dof of the row's small body: -coefficient · w_dof.
struct BodyTerm
{
  int dof;
  double coefficient;
};

/// A functional of many tissue dofs: coefficient · (g·u), with g the functional number `probe` of
/// the set.
struct DistributedTerm
{
  int probe;
  double coefficient = 1.0;
};

/// One constraint row: δ = gap + Σ terms. λ > 0 pushes the tissue along the directions of the terms
/// and the small body against them.
struct Row
{
  double gap = 0.0;  ///< δ at zero increments [m]
  std::vector<TissueTerm> tissue{};
  int body = -1;  ///< index of the small body, -1: none
  std::vector<BodyTerm> on_body{};
  std::vector<DistributedTerm> distributed{};
  double compliance = 0.0;           ///< c of a compliant row of the law zero, δ = -c λ [m/N]
  double relative_compliance = 0.0;  ///< compliance to add, as a multiple of W_ii
  double start = 0.0;                ///< multiplier to start from [N]

  /// The usual row of a needle: direction · u(anchor) - Σ coefficient · w_dof.
  static Row between(TissueTerm tissue, int body,
                     const std::vector<std::pair<int, double>>& jacobian);
};

/// The rows of one linearisation, in blocks that share a law. Made anew in every linearisation.
class Set
{
 public:
  bool empty() const { return rows_.empty(); }
  int size() const { return static_cast<int>(rows_.size()); }
  /// Adds a block and returns its first row. `point`: number of the coupling point that the block
  /// belongs to, not less than that of the block before.
  int add(std::vector<Row> rows, const law::Law& law, int point);
  int add(Row row, const law::Law& law, int point);
  /// Adds a row as a coupling point of its own.
  int add(Row row, const law::Law& law = {}) { return add(std::move(row), law, next_point()); }
  int next_point() const { return blocks_.empty() ? 0 : blocks_.back().point + 1; }
  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<law::Block>& blocks() const { return blocks_; }
  core::VecX starts() const;  ///< multipliers to start from (rows) [N]

  /// Adds a functional and gives its index, for `DistributedTerm::probe`.
  int add_functional(std::shared_ptr<const solve::DistributedFunctional> probe);
  /// What the rows probe: file nodes with a non-zero weight, ascending, and the functionals. The
  /// result points to functionals of the set, so the set must outlive it.
  solve::Probes probes() const;

  /// Compliance between two rows, on top of that of tissue and bodies [m/N]: δ_i grows by
  /// `compliance` · λ_j and δ_j by `compliance` · λ_i; i may be j. The matrix of all couplings is
  /// positive semidefinite.
  struct Coupling
  {
    int i, j;
    double compliance;
  };
  std::vector<Coupling>& couplings() { return couplings_; }
  const std::vector<Coupling>& couplings() const { return couplings_; }
  /// Replaces a row's gap, which nonlinear laws change while they are met.
  void set_gap(int row, double gap) { rows_[static_cast<std::size_t>(row)].gap = gap; }

 private:
  std::vector<Row> rows_;
  std::vector<law::Block> blocks_;
  std::vector<std::shared_ptr<const solve::DistributedFunctional>> wide_;
  std::vector<Coupling> couplings_;
};

/// A body so small that its operator is dense and known to every rank: a needle.
/// The first `held` dofs are prescribed, the rest are free.
struct SmallBody
{
  int held = 0;
  core::Cholesky factor;      ///< of A_n on its free dofs
  core::VecX free_increment;  ///< A_n⁻¹ r on its free dofs [m, rad]
};

}  // namespace trocar::constraint
