#include "needle/needle.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::needle {

bool NeedleState::finite() const
{
  for (std::size_t i = 0; i < shaft.x.size(); ++i)
    if (!shaft.x[i].allFinite() || !shaft.R[i].allFinite()) return false;
  return true;
}

Needle::Needle(NeedleSettings settings)
    : settings_(std::move(settings)),
      element_stiffness_(
          beam_stiffness(settings_.section, settings_.motion.length / settings_.elements))
{
}

Shaft Needle::straight(const Pose& base) const
{
  Shaft shaft;
  shaft.length = settings_.motion.length;
  shaft.radius = settings_.section.outer;
  shaft.bevel = settings_.bevel;
  for (int i = 0; i <= settings_.elements; ++i) {
    shaft.x.push_back(base.x + i * shaft.length / settings_.elements * base.R.col(0));
    shaft.R.push_back(base.R);
  }
  return shaft;
}

NeedleState Needle::initial() const
{
  const std::vector<Vec3> still(static_cast<std::size_t>(settings_.elements) + 1, Vec3::Zero());
  return {straight(settings_.motion.at(0.0)), still, still, 0.0};
}

NeedleState Needle::predict(const NeedleState& old, double t) const
{
  const Pose base = settings_.motion.at(t);
  NeedleState next = old;
  const Vec3 along = 0.5 * (old.shaft.R.front().col(0) + base.R.col(0));
  next.travel += along.dot(base.x - old.shaft.x.front());
  if (settings_.model == Model::rigid) {
    next.shaft = straight(base);
    return next;
  }
  const Mat3 turn = base.R * old.shaft.R.front().transpose();
  for (std::size_t i = 0; i < old.shaft.x.size(); ++i) {
    next.shaft.x[i] = base.x + turn * (old.shaft.x[i] - old.shaft.x.front());
    next.shaft.R[i] = turn * old.shaft.R[i];
  }
  next.shaft.R.front() = base.R;
  return next;
}

double Needle::nodal_mass(int node) const
{
  const double element =
      settings_.density * settings_.section.area() * settings_.motion.length / settings_.elements;
  return node == 0 || node == settings_.elements ? 0.5 * element : element;
}

Mat3 Needle::rotary_inertia(int node, const Mat3& R) const
{
  const Section& s = settings_.section;
  const double l = settings_.motion.length / settings_.elements;
  const double share = nodal_mass(node) / s.area();
  // Half an element on each side turns with the node and adds m l²/12 to the section's inertia.
  const double across = share * s.second_moment() + nodal_mass(node) * l * l / 12.0;
  const Vec3 axes(share * s.polar_moment(), across, across);
  return R * axes.asDiagonal() * R.transpose();
}

VecX Needle::weight_and_inertia(const NeedleState& old, const NeedleState& at,
                                const core::TimeStep& step) const
{
  VecX force(dofs());
  const core::Rates rate = step.rates();
  for (int i = 0; i <= settings_.elements; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double mass = nodal_mass(i);
    const Mat3& R = at.shaft.R[n];
    const Vec3 v = rate.velocity * (at.shaft.x[n] - old.shaft.x[n]);
    const Vec3 w = rate.velocity * core::rotation_log(R * old.shaft.R[n].transpose());
    force.segment<3>(6 * i) =
        step.load * mass * settings_.gravity - mass * rate.acceleration * (v - old.v[n]);
    force.segment<3>(6 * i + 3) = -rate.acceleration * rotary_inertia(i, R) * (w - old.w[n]);
  }
  return force;
}

Linearised Needle::linearise(const NeedleState& old, const NeedleState& iterate,
                             const core::TimeStep& step) const
{
  Linearised linear;
  const Shaft& shaft = iterate.shaft;
  linear.A = MatX::Zero(dofs(), dofs());
  linear.r = weight_and_inertia(old, iterate, step);
  const core::Rates rate = step.rates();
  for (int i = 0; i <= settings_.elements; ++i) {
    const auto n = static_cast<std::size_t>(i);
    linear.A.block<3, 3>(6 * i, 6 * i).diagonal().array() +=
        nodal_mass(i) * rate.acceleration * rate.velocity;
    linear.A.block<3, 3>(6 * i + 3, 6 * i + 3) +=
        rate.acceleration * rate.velocity * rotary_inertia(i, shaft.R[n]);
  }
  if (settings_.model == Model::rigid) {
    linear.held = dofs();
    return linear;
  }
  for (int e = 0; e < settings_.elements; ++e) {
    const auto a = static_cast<std::size_t>(e);
    const BeamForce beam =
        corotational_beam(element_stiffness_, shaft.element_length(), {shaft.x[a], shaft.R[a]},
                          {shaft.x[a + 1], shaft.R[a + 1]});
    linear.r.segment<12>(6 * e) -= beam.force;
    linear.A.block<12, 12>(6 * e, 6 * e) += beam.tangent;
  }
  const Eigen::Index free = dofs() - linear.held;
  linear.factor.compute(linear.A.bottomRightCorner(free, free));
  linear.free_increment = linear.factor.solve(VecX(linear.r.tail(free)));
  return linear;
}

VecX Needle::increment(const Linearised& linear, const VecX& coupling) const
{
  VecX d = VecX::Zero(dofs());
  const Eigen::Index free = dofs() - linear.held;
  if (free > 0)
    d.tail(free) = linear.free_increment - linear.factor.solve(VecX(coupling.tail(free)));
  return d;
}

NeedleState Needle::correct(const NeedleState& old, const NeedleState& iterate,
                            const Linearised& linear, const VecX& coupling,
                            const core::TimeStep& step) const
{
  const VecX d = increment(linear, coupling);
  NeedleState next = iterate;
  for (int i = 0; i <= settings_.elements; ++i) {
    const auto n = static_cast<std::size_t>(i);
    next.shaft.x[n] += d.segment<3>(6 * i);
    next.shaft.R[n] = core::rotation_exp(d.segment<3>(6 * i + 3)) * next.shaft.R[n];
    next.v[n] = step.rates().velocity * (next.shaft.x[n] - old.shaft.x[n]);
    next.w[n] =
        step.rates().velocity * core::rotation_log(next.shaft.R[n] * old.shaft.R[n].transpose());
  }
  return next;
}

VecX Needle::residual(const NeedleState& old, const NeedleState& at,
                      const core::TimeStep& step) const
{
  VecX r = weight_and_inertia(old, at, step);
  if (settings_.model == Model::rigid) return r;
  const Shaft& shaft = at.shaft;
  for (std::size_t e = 0; e + 1 < shaft.x.size(); ++e)
    r.segment<12>(6 * static_cast<Eigen::Index>(e)) -=
        corotational_beam(element_stiffness_, shaft.element_length(), {shaft.x[e], shaft.R[e]},
                          {shaft.x[e + 1], shaft.R[e + 1]})
            .force;
  return r;
}

double Needle::relative_increment(const Linearised& linear, const VecX& coupling) const
{
  const VecX d = increment(linear, coupling);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < d.size(); ++i)
    largest = std::max(largest, std::abs(d[i]) * (i % 6 < 3 ? 1.0 / settings_.motion.length : 1.0));
  return largest;
}

Energy Needle::energy(const NeedleState& old, const NeedleState& next) const
{
  Energy energy;
  const Shaft& shaft = next.shaft;
  for (int i = 0; i <= settings_.elements; ++i) {
    const auto n = static_cast<std::size_t>(i);
    energy.kinetic += 0.5 * (nodal_mass(i) * next.v[n].squaredNorm() +
                             next.w[n].dot(rotary_inertia(i, shaft.R[n]) * next.w[n]));
    energy.weight += nodal_mass(i) * settings_.gravity.dot(shaft.x[n] - old.shaft.x[n]);
  }
  if (settings_.model == Model::rigid) return energy;
  for (std::size_t e = 0; e + 1 < shaft.x.size(); ++e)
    energy.elastic += corotational_beam(element_stiffness_, shaft.element_length(),
                                        {shaft.x[e], shaft.R[e]}, {shaft.x[e + 1], shaft.R[e + 1]})
                          .energy;
  return energy;
}

Wrench Needle::base_wrench(const NeedleState& iterate, const Linearised& linear,
                           const VecX& coupling) const
{
  const VecX holder = linear.A * increment(linear, coupling) - linear.r + coupling;
  Wrench wrench;
  const auto& x = iterate.shaft.x;
  // The holder acts on every held node: all nodes of a rigid needle, the first node of a beam.
  for (int i = 0; 6 * i < linear.held; ++i) {
    const Vec3 force = holder.segment<3>(6 * i);
    wrench.force += force;
    wrench.moment +=
        holder.segment<3>(6 * i + 3) + (x[static_cast<std::size_t>(i)] - x.front()).cross(force);
  }
  return wrench;
}

}  // namespace trocar::needle
