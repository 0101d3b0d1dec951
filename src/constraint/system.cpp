#include "constraint/system.hpp"

#include <algorithm>

namespace trocar::constraint {
namespace {

using Sparse = System::Sparse;
using Entries = std::vector<Eigen::Triplet<double>>;

Sparse matrix(Eigen::Index rows, Eigen::Index columns, const Entries& entries)
{
  Sparse made(rows, columns);
  made.setFromTriplets(entries.begin(), entries.end());
  return made;
}

/// Adds the entries of one term; `slot` gives the first of a node's three columns.
template <class Slot>
void add_term(int row, const TissueTerm& term, const Slot& slot, Entries& entries)
{
  for (std::size_t a = 0; a < term.anchor.node.size(); ++a) {
    const double weight = term.anchor.weight[static_cast<Eigen::Index>(a)];
    if (weight == 0.0) continue;
    const int first = slot(term.anchor.node[a]);
    for (int axis = 0; axis < 3; ++axis)
      entries.emplace_back(row, first + axis, weight * term.direction[axis]);
  }
}

Sparse rows_on_probes(const Set& set, const solve::Probes& probes)
{
  Entries entries;
  const int wides = 3 * static_cast<int>(probes.nodes.size());
  const auto slot = [&](int node) {
    const auto at = std::lower_bound(probes.nodes.begin(), probes.nodes.end(), node);
    return 3 * static_cast<int>(at - probes.nodes.begin());
  };
  for (int i = 0; i < set.size(); ++i) {
    const Row& row = set.rows()[static_cast<std::size_t>(i)];
    for (const DistributedTerm& term : row.distributed)
      entries.emplace_back(i, wides + term.probe, term.coefficient);
    for (const TissueTerm& term : row.tissue) add_term(i, term, slot, entries);
  }
  return matrix(set.size(), probes.size(), entries);
}

Sparse jacobians_of(const Set& set, int body, Eigen::Index dofs)
{
  Entries entries;
  for (int i = 0; i < set.size(); ++i) {
    const Row& row = set.rows()[static_cast<std::size_t>(i)];
    if (row.body != body) continue;
    for (const auto& [dof, coefficient] : row.on_body) entries.emplace_back(i, dof, coefficient);
  }
  return matrix(set.size(), dofs, entries);
}

}  // namespace

System::System(Set set, std::vector<SmallBody> bodies)
    : set_(std::move(set)),
      bodies_(std::move(bodies)),
      probes_(set_.probes()),
      H_(rows_on_probes(set_, probes_))
{
  Entries entries;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Eigen::Index dofs = bodies_[b].free_increment.size();
    jacobians_.push_back(jacobians_of(set_, static_cast<int>(b), bodies_[b].held + dofs));
    if (dofs == 0) continue;
    // Only rows on this body contribute: rows on other bodies do not move it.
    std::vector<int> mine;
    for (int i = 0; i < set_.size(); ++i)
      if (set_.rows()[static_cast<std::size_t>(i)].body == static_cast<int>(b)) mine.push_back(i);
    const core::MatX all = jacobians_.back().rightCols(dofs);
    const core::MatX H = all(mine, Eigen::all).transpose();
    core::MatX W = H.transpose() * bodies_[b].factor.solve(H);
    W = 0.5 * (W + W.transpose()).eval();
    for (std::size_t i = 0; i < mine.size(); ++i)
      for (std::size_t j = 0; j < mine.size(); ++j)
        entries.emplace_back(mine[i], mine[j],
                             W(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  }
  of_bodies_ = matrix(set_.size(), set_.size(), entries);
  gather_compliance();
}

void System::gather_compliance()
{
  Entries entries;
  for (const Set::Coupling& c : set_.couplings()) {
    entries.emplace_back(c.i, c.j, c.compliance);
    if (c.i != c.j) entries.emplace_back(c.j, c.i, c.compliance);
  }
  own_ = of_bodies_ + matrix(set_.size(), set_.size(), entries);
}

bool System::settle(const core::VecX& lambda)
{
  if (!relinearise || !relinearise(lambda, set_)) return false;
  gather_compliance();
  return true;
}

core::MatX System::compliance(const core::MatX& C) const
{
  const core::MatX HC = H_ * C;
  core::MatX W = HC * H_.transpose();
  W = 0.5 * (W + W.transpose()).eval();
  W += own_;
  return W;
}

law::Problem System::problem(const core::MatX& W, const core::VecX& free) const
{
  law::Problem problem;
  problem.W = W;
  problem.g = H_ * free;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Eigen::Index dofs = bodies_[b].free_increment.size();
    if (dofs > 0) problem.g -= jacobians_[b].rightCols(dofs) * bodies_[b].free_increment;
  }
  problem.start = set_.starts();
  problem.blocks = set_.blocks();
  problem.compliance.resize(size());
  for (int i = 0; i < size(); ++i) {
    const Row& row = set_.rows()[static_cast<std::size_t>(i)];
    problem.g[i] += row.gap;
    problem.compliance[i] = row.compliance + row.relative_compliance * W(i, i);
  }
  return problem;
}

solve::OwnedField System::forces(const core::VecX& lambda, const fem::Space& space) const
{
  if (empty()) return space.zero();
  return solve::spread(probes_, probe_forces(lambda), space);
}

core::VecX System::body_forces(const core::VecX& lambda, int body) const
{
  const Sparse& H = jacobians_[static_cast<std::size_t>(body)];
  if (lambda.size() == 0) return core::VecX::Zero(H.cols());
  return H.transpose() * lambda;
}

double System::yielded(const core::VecX& a, const core::VecX& b) const
{
  double sum = a.dot(own_ * b);
  for (int i = 0; i < size(); ++i)
    sum += set_.rows()[static_cast<std::size_t>(i)].compliance * a[i] * b[i];
  return sum;
}

}  // namespace trocar::constraint
