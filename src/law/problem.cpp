#include "law/problem.hpp"

#include <algorithm>
#include <cmath>

#include "core/dense.hpp"

namespace trocar::law {
namespace {

double leader_of(const Law& law, const VecX& lambda)
{
  return law.leader < 0 ? 0.0 : lambda[law.leader];
}

/// Residual of rows that nothing can move [m]: zero if λ is that of `resisting`, else |δ|.
double unmet_gap(const Law& law, const Few& lambda, const Few& delta, double leader)
{
  if (law.set == Law::Set::zero) return std::abs(delta[0]);
  if (law.set == Law::Set::cone)
    return std::max(unmet_gap(Law::interval(0.0, law.upper), lambda.head<1>(), delta.head<1>(), 0),
                    unmet_gap(Law::disc(std::min(law.friction * lambda[0], law.shear)),
                              lambda.tail<2>(), delta.tail<2>(), 0));
  const Few asked = resisting(law, delta, leader);
  const bool met = asked.allFinite() && (lambda - asked).norm() <= 1e-9 * asked.norm();
  return met ? 0.0 : delta.norm();
}

}  // namespace

double kkt_residual(const Problem& problem, const VecX& lambda)
{
  VecX delta = problem.W * lambda + problem.g, compliance = problem.W.diagonal();
  if (problem.compliance.size() > 0) {
    delta += problem.compliance.cwiseProduct(lambda);
    compliance += problem.compliance;
  }
  if (!delta.allFinite()) return std::nan("");
  double worst = 0.0;
  for (const Block& block : problem.blocks) {
    const int n = block.law.rows();
    const Few mine = lambda.segment(block.first, n), opens = delta.segment(block.first, n);
    const double w = compliance.segment(block.first, n).mean();
    const double leader = leader_of(block.law, lambda);
    worst = std::max(worst, w > 0.0 ? residual(block.law, mine, opens, w, leader)
                                    : unmet_gap(block.law, mine, opens, leader));
  }
  return worst;
}

namespace {

enum class RowState : signed char { low = -1, held = 0, high = 1 };

/// State of a row whose λ lies in [lower, upper]. `slack`: error of limits that follow a multiplier
/// [N].
RowState place(double lower, double upper, double lambda, double slack)
{
  const double width = std::max(std::isfinite(upper) ? std::abs(upper) : 0.0, std::abs(lower));
  const double off = 1e-9 * width + slack;
  if (lambda >= upper - off) return RowState::high;
  return lambda <= lower + off ? RowState::low : RowState::held;
}

/// Appends the states of a block's rows. The two rows of a pair that slips are `high`; those of a
/// pair whose radius is zero are `low`. `slack`: error of limits that follow a multiplier [N].
void add_states(const Law& law, const Few& lambda, double leader, double slack,
                std::vector<RowState>& states)
{
  const auto slip = [&](const Few& t, double radius, double off) {
    const bool slips = t.norm() >= radius * (1.0 - 1e-9) - std::min(off, 0.5 * radius);
    const RowState state = radius > 0.0 ? RowState::high : RowState::low;
    states.insert(states.end(), 2, slips ? state : RowState::held);
  };
  switch (law.set) {
    case Law::Set::zero:
      states.push_back(RowState::held);
      break;
    case Law::Set::interval:
      states.push_back(place(law.lower, law.upper, lambda[0], 0.0));
      break;
    case Law::Set::follower: {
      const double bound = law.friction * std::max(leader, 0.0);
      states.push_back(place(-bound, bound, lambda[0], std::min(slack, 0.5 * bound)));
      break;
    }
    case Law::Set::disc:
      slip(lambda, law.upper, 0.0);
      break;
    case Law::Set::cone:
      states.push_back(place(0.0, law.upper, lambda[0], 0.0));
      slip(lambda.tail<2>(), std::min(law.friction * std::max(lambda[0], 0.0), law.shear), slack);
      break;
  }
}

std::vector<RowState> states_of(const Problem& problem, const VecX& lambda, double tolerance)
{
  std::vector<RowState> states;
  for (const Block& block : problem.blocks) {
    const int n = block.law.rows();
    const double w = problem.W.diagonal().segment(block.first, n).mean();
    add_states(block.law, lambda.segment(block.first, n), leader_of(block.law, lambda),
               w > 0.0 ? 2.0 * tolerance / w : 0.0, states);
  }
  return states;
}

}  // namespace

VecX response(const Problem& problem, const VecX& lambda, const VecX& dg, double tolerance)
{
  const std::vector<RowState> states = states_of(problem, lambda, tolerance);
  std::vector<int> held;
  for (int i = 0; i < static_cast<int>(problem.rows()); ++i)
    if (states[static_cast<std::size_t>(i)] == RowState::held) held.push_back(i);
  VecX change = VecX::Zero(problem.rows());
  if (held.empty()) return change;
  MatX W = problem.W(held, held);
  if (problem.compliance.size() > 0) W.diagonal() += problem.compliance(held);
  change(held) = -core::least_squares(W, dg(held));
  return change;
}

bool same_states(const Problem& problem, const VecX& a, const VecX& b, double tolerance)
{
  const std::vector<RowState> before = states_of(problem, a, tolerance);
  const std::vector<RowState> after = states_of(problem, b, tolerance);
  if (before != after) return false;
  for (const Block& block : problem.blocks) {
    const Law& law = block.law;
    if (law.set == Law::Set::follower && law.friction > 0.0) return false;
    const bool turns = law.set == Law::Set::cone ? law.friction > 0.0 : law.set == Law::Set::disc;
    if (turns && after[static_cast<std::size_t>(block.end() - 1)] == RowState::high) return false;
  }
  return true;
}

}  // namespace trocar::law
