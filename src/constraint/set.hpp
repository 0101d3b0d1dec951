#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/dense.hpp"
#include "law/problem.hpp"
#include "solve/isolated_compliance.hpp"

namespace trocar::constraint {

using core::Vec3;

/// Where a row takes hold of the tissue: a material place as a weighted mean of nodes. A coupling
/// point has the four of its tet, a tip's support those around it.
struct Anchor
{
  std::vector<int> node;  ///< file nodes
  core::VecX weight;      ///< by node, sum 1; a zero weight makes no probe

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

/// One constraint row: δ = gap + direction·u(anchor) - h·w, where w are the increments of the
/// small body (the needle). λ > 0 pushes the tissue along `direction` and the body against it.
/// A wide row takes hold of many dofs at once: δ = gap + g·u with the set's wide probe g.
struct Row
{
  Anchor anchor{};
  Vec3 direction = Vec3::Zero();              ///< unit, world frame
  int body = -1;                              ///< index of the small body, -1: nothing moves there
  std::vector<std::pair<int, double>> lever;  ///< (dof of the body, coefficient)
  double gap = 0.0;                           ///< δ at zero increments [m]
  law::RowKind kind = law::RowKind::bilateral;
  double bound = 0.0;              ///< F of a box or push row [N]
  int normal = -1;                 ///< row of this set whose λ gives the bound F = friction · λ
  double friction = 0.0;           ///< coefficient of such a row
  double softness = 0.0;           ///< c of a smooth row, δ = -c λ [m/N]
  double relative_softness = 0.0;  ///< more softness, in units of the row's own W_ii
  double start = 0.0;              ///< multiplier to start from [N]
  int point = 0;                   ///< coupling point, ascending along the set
  int wide = -1;                   ///< wide probe of the set, instead of an anchor
};

/// The rows of one step. Born and gone within it.
class Set
{
 public:
  bool empty() const { return rows_.empty(); }
  int size() const { return static_cast<int>(rows_.size()); }
  void add(Row row) { rows_.push_back(std::move(row)); }
  const std::vector<Row>& rows() const { return rows_; }
  core::VecX starts() const;  ///< multipliers to start from (rows) [N]

  /// Adds a wide probe and gives its index, for `Row::wide`.
  int add_wide(std::shared_ptr<const solve::WideProbe> probe);
  /// What the rows probe: file nodes with a non-zero weight, ascending, and the wide probes, which
  /// live as long as the set.
  solve::Probes probes() const;

  /// Rows that give way to each other's multipliers: δ_i grows by `softness` · λ_j and δ_j
  /// likewise [m/N]; i may be j. Positive semidefinite in all.
  struct Coupling
  {
    int i, j;
    double softness;
  };
  std::vector<Coupling>& couplings() { return couplings_; }
  const std::vector<Coupling>& couplings() const { return couplings_; }
  /// For what changes while laws are met: a row's gap.
  void set_gap(int row, double gap) { rows_[static_cast<std::size_t>(row)].gap = gap; }

 private:
  std::vector<Row> rows_;
  std::vector<std::shared_ptr<const solve::WideProbe>> wide_;
  std::vector<Coupling> couplings_;
};

/// A body so small that its operator is dense and known to every rank.
/// The first `held` dofs are prescribed, the rest are free.
struct SmallBody
{
  int held = 0;
  core::Cholesky factor;      ///< of A_n on its free dofs
  core::VecX free_increment;  ///< A_n⁻¹ r on its free dofs [m, rad]
};

}  // namespace trocar::constraint
