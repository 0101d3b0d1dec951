#include "constraint/reduce.hpp"

#include <Eigen/Sparse>
#include <algorithm>

namespace trocar::constraint {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Ĥ (rows x slots of the probes): the rows in terms of the probes.
Sparse rows_on_probes(const Set& set)
{
  const solve::Probes probes = set.probes();
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < set.size(); ++i) {
    const Row& row = set.rows()[static_cast<std::size_t>(i)];
    if (row.wide >= 0)
      entries.emplace_back(i, 3 * static_cast<int>(probes.nodes.size()) + row.wide, 1.0);
    for (std::size_t a = 0; a < row.anchor.node.size(); ++a) {
      const double weight = row.anchor.weight[static_cast<Eigen::Index>(a)];
      if (weight == 0.0) continue;
      const auto at =
          std::lower_bound(probes.nodes.begin(), probes.nodes.end(), row.anchor.node[a]);
      const int slot = 3 * static_cast<int>(at - probes.nodes.begin());
      for (int axis = 0; axis < 3; ++axis)
        entries.emplace_back(i, slot + axis, weight * row.direction[axis]);
    }
  }
  Sparse H(set.size(), probes.size());
  H.setFromTriplets(entries.begin(), entries.end());
  return H;
}

/// H_nᵀ of one body (its dofs x rows), zero columns for rows of other bodies.
core::MatX levers(const Set& set, int body, Eigen::Index dofs)
{
  core::MatX H = core::MatX::Zero(dofs, set.size());
  for (int i = 0; i < set.size(); ++i) {
    const Row& row = set.rows()[static_cast<std::size_t>(i)];
    if (row.body != body) continue;
    for (const auto& [dof, coefficient] : row.lever) H(dof, i) += coefficient;
  }
  return H;
}

}  // namespace

int Set::add_wide(std::shared_ptr<const solve::WideProbe> probe)
{
  wide_.push_back(std::move(probe));
  return static_cast<int>(wide_.size()) - 1;
}

solve::Probes Set::probes() const
{
  solve::Probes probes;
  for (const Row& row : rows_)
    for (std::size_t a = 0; a < row.anchor.node.size(); ++a)
      if (row.anchor.weight[static_cast<Eigen::Index>(a)] != 0.0)
        probes.nodes.push_back(row.anchor.node[a]);
  std::sort(probes.nodes.begin(), probes.nodes.end());
  probes.nodes.erase(std::unique(probes.nodes.begin(), probes.nodes.end()), probes.nodes.end());
  for (const auto& wide : wide_) probes.wide.push_back(wide.get());
  return probes;
}

core::VecX Set::starts() const
{
  core::VecX start(size());
  for (int i = 0; i < size(); ++i) start[i] = rows_[static_cast<std::size_t>(i)].start;
  return start;
}

law::Problem reduce(const Set& set, const core::MatX& C, const core::VecX& free,
                    const std::vector<SmallBody>& bodies)
{
  law::Problem problem;
  const Sparse H = rows_on_probes(set);
  const core::MatX HC = H * C;
  problem.W = HC * H.transpose();
  problem.g = H * free;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Eigen::Index dofs = bodies[b].free_increment.size();
    if (dofs == 0) continue;
    const core::MatX H_t = levers(set, static_cast<int>(b), bodies[b].held + dofs).bottomRows(dofs);
    problem.W.noalias() += H_t.transpose() * bodies[b].factor.solve(H_t);
    problem.g -= H_t.transpose() * bodies[b].free_increment;
  }
  problem.W = 0.5 * (problem.W + problem.W.transpose()).eval();
  for (const Set::Coupling& c : set.couplings()) {
    problem.W(c.i, c.j) += c.softness;
    if (c.i != c.j) problem.W(c.j, c.i) += c.softness;
  }

  problem.bound.resize(set.size());
  problem.start.resize(set.size());
  problem.softness.resize(set.size());
  problem.friction.resize(set.size());
  for (int i = 0; i < set.size(); ++i) {
    const Row& row = set.rows()[static_cast<std::size_t>(i)];
    problem.g[i] += row.gap;
    problem.bound[i] = row.bound;
    problem.softness[i] = row.softness + row.relative_softness * problem.W(i, i);
    problem.start[i] = row.start;
    problem.friction[i] = row.friction;
    problem.normal.push_back(row.normal);
    problem.kind.push_back(row.kind);
    problem.group.push_back(row.point);
  }
  return problem;
}

core::VecX row_displacements(const Set& set, const core::VecX& probed)
{
  return rows_on_probes(set) * probed;
}

core::VecX probe_forces(const Set& set, const core::VecX& lambda)
{
  return rows_on_probes(set).transpose() * lambda;
}

double yielding(const Set& set, const std::vector<SmallBody>& bodies, const core::VecX& a,
                const core::VecX& b)
{
  double sum = 0.0;
  for (int i = 0; i < set.size(); ++i)
    sum += set.rows()[static_cast<std::size_t>(i)].softness * a[i] * b[i];
  for (const Set::Coupling& c : set.couplings())
    sum += c.softness * (c.i == c.j ? a[c.i] * b[c.i] : a[c.i] * b[c.j] + a[c.j] * b[c.i]);
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    const Eigen::Index dofs = bodies[n].free_increment.size();
    if (dofs == 0) continue;
    const auto on_free = [&](const core::VecX& lambda) -> core::VecX {
      return body_forces(set, lambda, static_cast<int>(n), bodies[n].held + dofs).tail(dofs);
    };
    sum += on_free(a).dot(bodies[n].factor.solve(on_free(b)));
  }
  return sum;
}

core::VecX body_forces(const Set& set, const core::VecX& lambda, int body, Eigen::Index dofs)
{
  return levers(set, body, dofs) * lambda;
}

}  // namespace trocar::constraint
