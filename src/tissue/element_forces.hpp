#pragma once

#include <vector>

#include "tissue/elements_of.hpp"

// Forces, energies and stress of the tets: definitions that only linear_tets.cpp and
// quadratic_tets.cpp include.
namespace trocar::tissue {

template <int N>
typename ElementsOf<N>::Nodal ElementsOf<N>::nodal(const GhostedField& field, std::size_t e) const
{
  Nodal values;
  const auto nodes = space_->nodes(e);
  for (std::size_t a = 0; a < N; ++a)
    values.col(static_cast<Eigen::Index>(a)) = field.node(nodes[a]);
  return values;
}

/// Adds the values to the owned nodes of tet e only. The other nodes get theirs on the ranks that
/// own them, because those ranks visit this tet too.
template <int N>
void ElementsOf<N>::scatter(const Nodal& values, std::size_t e, OwnedField& field) const
{
  const auto nodes = space_->nodes(e);
  for (std::size_t a = 0; a < N; ++a)
    if (nodes[a] < space_->owned())
      field.node(nodes[a]) += values.col(static_cast<Eigen::Index>(a));
}

template <int N>
core::VecX ElementsOf<N>::pressure_of(const core::VecX& theta) const
{
  core::VecX p(theta.size());
  for (std::size_t e = 0; e < tets(); ++e) {
    const double lambda = lambda_at_point(material(e));
    for (auto i = static_cast<Eigen::Index>(points * e);
         i < static_cast<Eigen::Index>(points * (e + 1)); ++i)
      p[i] = lambda * theta[i];
  }
  if (averaged()) add_averaged(theta, p);
  return p;
}

/// Adds to p the averaged θ times the part of λ that belongs to it [Pa].
template <int N>
void ElementsOf<N>::add_averaged(const core::VecX& theta, core::VecX& p) const
{
  if (!patches_) {
    for (std::size_t e = 0; e < tets(); ++e) {
      double sum = 0.0;
      for (std::size_t point = points * e; point < points * (e + 1); ++point)
        sum += shapes_[point].volume * theta[static_cast<Eigen::Index>(point)];
      p.segment<static_cast<int>(points)>(static_cast<Eigen::Index>(points * e)).array() +=
          lambda_of_mean(material(e)) * sum / volume_[e];
    }
    return;
  }
  const auto share = fem::corner_weights<N>();
  core::VecX of_patch(static_cast<Eigen::Index>(patches_->size()));
  for (std::size_t v = 0; v < patches_->size(); ++v) {
    double sum = 0.0;
    for (std::size_t k = patches_->start[v]; k < patches_->start[v + 1]; ++k)
      for (std::size_t q = 0; q < points; ++q) {
        const std::size_t point = points * patches_->member[k].tet + q;
        sum += share(patches_->member[k].corner, static_cast<Eigen::Index>(q)) *
               shapes_[point].volume * theta[static_cast<Eigen::Index>(point)];
      }
    const auto region = static_cast<std::size_t>(patches_->region[v]);
    of_patch[static_cast<Eigen::Index>(v)] =
        lambda_of_mean(settings_.materials[region]) * sum / patches_->measure[v];
  }
  for (std::size_t e = 0; e < tets(); ++e)
    for (std::size_t a = 0; a < 4; ++a) {
      const int v = patches_->of_tet[e][a];
      for (std::size_t q = 0; v >= 0 && q < points; ++q)
        p[static_cast<Eigen::Index>(points * e + q)] +=
            share(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(q)) * of_patch[v];
    }
}

/// ∂θ/∂F : grad d at every integration point; d is a displacement increment or a velocity.
template <int N>
core::VecX ElementsOf<N>::dilatation_rates(const LinearisationPoint& at,
                                           const GhostedField& d) const
{
  core::VecX theta(static_cast<Eigen::Index>(shapes_.size()));
  for (std::size_t e = 0; e < tets(); ++e) {
    const Nodal w = nodal(d, e);
    for (std::size_t point = points * e; point < points * (e + 1); ++point)
      theta[static_cast<Eigen::Index>(point)] =
          dilatation_gradient(at, point).cwiseProduct(gradient(w, point)).sum();
  }
  return theta;
}

/// Writes θ + β θ̇ (dilatation with stiffness damping) at the integration points of tet e.
template <int N>
void ElementsOf<N>::put_dilatations(std::size_t e, const LinearisationPoint& at,
                                    const Kinematics& motion, core::VecX& theta) const
{
  const double beta = material(e).rayleigh_stiffness;
  const Nodal u = nodal(motion.u, e);
  for (std::size_t point = points * e; point < points * (e + 1); ++point) {
    const Mat3& R = at.R[point];
    const Mat3 G = gradient(u, point);
    double& mine = theta[static_cast<Eigen::Index>(point)];
    mine = energy::dilatation(model(e), R, G);
    if (beta > 0.0 && motion.v.value.size() > 0)
      mine += beta * energy::dilatation_gradient(model(e), R, G)
                         .cwiseProduct(gradient(nodal(motion.v, e), point))
                         .sum();
  }
}

/// Pressures λ(θ + β θ̇) at the integration points, averaged as `Dilatation` says [Pa].
template <int N>
core::VecX ElementsOf<N>::pressures(const LinearisationPoint& at, const Kinematics& motion) const
{
  core::VecX theta(static_cast<Eigen::Index>(shapes_.size()));
  for (std::size_t e = 0; e < tets(); ++e) put_dilatations(e, at, motion, theta);
  return pressure_of(theta);
}

template <int N>
core::VecX ElementsOf<N>::linearised_pressures(const LinearisationPoint& last,
                                               const GhostedField& d) const
{
  core::VecX theta = dilatation_rates(last, d);
  for (std::size_t point = 0; point < shapes_.size(); ++point)
    theta[static_cast<Eigen::Index>(point)] +=
        energy::dilatation(model(point / points), last.R[point], last.G[point]);
  return pressure_of(theta);
}

template <int N>
void ElementsOf<N>::add_tet_forces(std::size_t e, const LinearisationPoint& at,
                                   const Kinematics& motion, const core::VecX& p,
                                   ForceSums& sums) const
{
  const Material& m = material(e);
  const bool moves = motion.v.value.size() > 0;
  const Nodal u = nodal(motion.u, e);
  const Nodal v = moves ? nodal(motion.v, e) : Nodal::Zero();
  const double beta = moves ? m.rayleigh_stiffness : 0.0;
  Nodal force = Nodal::Zero(), damping = Nodal::Zero();
  for (std::size_t point = points * e; point < points * (e + 1); ++point) {
    const Mat3& R = at.R[point];
    const Mat3 G = gradient(u, point);
    const Mat3 by = energy::dilatation_gradient(model(e), R, G);
    const Mat3 P = m.mu() * energy::shear_gradient(model(e), R, G);
    const double pressure = averaged() ? p[static_cast<Eigen::Index>(point)]
                                       : m.lambda() * energy::dilatation(model(e), R, G);
    force += shapes_[point].volume * (P + pressure * by) * shapes_[point].gradient;
    if (beta == 0.0) continue;
    const Mat3 D = gradient(v, point);
    Mat3 viscous = m.mu() * energy::viscous_shear(model(e), R, G, D);
    if (!averaged()) viscous += m.lambda() * by.cwiseProduct(D).sum() * by;
    damping += beta * shapes_[point].volume * viscous * shapes_[point].gradient;
  }
  force += damping;
  if (beta > 0.0 && sums.damping.value.size() > 0) scatter(damping, e, sums.damping);
  scatter(force, e, sums.internal);
  Nodal inertia = Nodal::Zero();
  if (motion.a.value.size() > 0) {
    const Nodal w = nodal(motion.a, e) + m.rayleigh_mass * v;
    inertia = m.density * mass_factor(e) * w * mass_form(e);
    scatter(inertia, e, sums.inertia);
  }
  if (sums.size.size() > 0) add_sizes(e, motion, force, inertia, sums);
}

template <int N>
void ElementsOf<N>::add_forces(const LinearisationPoint& at, const Kinematics& motion,
                               ForceSums& sums) const
{
  const core::VecX p = averaged() ? pressures(at, motion) : core::VecX();
  for (std::size_t e = 0; e < tets(); ++e) add_tet_forces(e, at, motion, p, sums);
}

template <int N>
void ElementsOf<N>::add_forces_of(const std::vector<std::size_t>& tets,
                                  const LinearisationPoint& at, const Kinematics& motion,
                                  ForceSums& sums) const
{
  core::VecX p;
  if (averaged()) {  // p is valid only in these tets
    core::VecX theta = core::VecX::Zero(static_cast<Eigen::Index>(shapes_.size()));
    for (std::size_t e : with_patches(tets)) put_dilatations(e, at, motion, theta);
    p = pressure_of(theta);
  }
  for (std::size_t e : tets) add_tet_forces(e, at, motion, p, sums);
}

template <int N>
OwnedField ElementsOf<N>::operate(const LinearisationPoint& at, const core::Rates& rate,
                                  const GhostedField& d) const
{
  core::VecX p;  // pressure increment of the averaged θ, by point
  if (averaged())
    add_averaged(dilatation_rates(at, d), p.setZero(static_cast<Eigen::Index>(shapes_.size())));
  OwnedField product = space_->zero();
  for (std::size_t e = 0; e < tets(); ++e) {
    const Material& m = material(e);
    const double scale_k = 1.0 + m.rayleigh_stiffness * rate.velocity;
    const double scale_m =
        ((rate.acceleration + m.rayleigh_mass) * rate.velocity + rate.mass) * m.density;
    const Nodal w = nodal(d, e);
    Nodal force = scale_m * mass_factor(e) * w * mass_form(e);
    for (std::size_t point = points * e; point < points * (e + 1); ++point) {
      Mat3 P = increment(at, rate, point, gradient(w, point));
      if (averaged())
        P += scale_k * p[static_cast<Eigen::Index>(point)] * dilatation_gradient(at, point);
      force += shapes_[point].volume * P * shapes_[point].gradient;
    }
    scatter(force, e, product);
  }
  return product;
}

template <int N>
TetWork ElementsOf<N>::work(const LinearisationPoint& at, const Kinematics& motion) const
{
  TetWork work;
  const core::VecX p = pressures(at, {motion.u, {}, {}});
  const bool moves = motion.v.value.size() > 0;
  core::VecX rate, p_rate;
  if (moves) {
    rate = dilatation_rates(at, motion.v);
    p_rate = pressure_of(rate);
  }
  for (std::size_t e = 0; e < tets(); ++e) {
    if (space_->nodes(e)[0] >= space_->owned()) continue;
    const Material& m = material(e);
    const Nodal u = nodal(motion.u, e);
    const Nodal v = moves ? nodal(motion.v, e) : Nodal::Zero();
    for (std::size_t point = points * e; point < points * (e + 1); ++point) {
      const Mat3& R = at.R[point];
      const Mat3 G = gradient(u, point);
      const double theta = energy::dilatation(model(e), R, G);
      work.elastic += shapes_[point].volume * (m.mu() * energy::shear(model(e), R, G) +
                                               0.5 * p[static_cast<Eigen::Index>(point)] * theta);
      if (!moves || m.rayleigh_stiffness == 0.0) continue;
      const auto i = static_cast<Eigen::Index>(point);
      const Mat3 D = gradient(v, point);
      const Mat3 viscous = energy::viscous_shear(model(e), R, G, D);
      work.damping_power_stiffness +=
          m.rayleigh_stiffness * shapes_[point].volume *
          (m.mu() * viscous.cwiseProduct(D).sum() + p_rate[i] * rate[i]);
    }
    if (!moves) continue;
    const double inertia = m.density * mass_factor(e) * v.cwiseProduct(v * mass_form(e)).sum();
    work.kinetic += 0.5 * inertia;
    work.damping_power_mass += m.rayleigh_mass * inertia;
  }
  return work;
}

template <int N>
StressField ElementsOf<N>::stresses(const LinearisationPoint& at, const GhostedField& u) const
{
  const auto count = static_cast<Eigen::Index>(tets());
  StressField sums{core::VecX::Zero(6 * count), core::VecX::Zero(N == 4 ? 0 : 24 * count),
                   core::VecX::Zero(count)};
  using AtPoints = Eigen::Matrix<double, 6, static_cast<int>(points)>;
  Eigen::Matrix4d to_corners = Eigen::Matrix4d::Identity();
  if constexpr (N == 10) to_corners = fem::corner_weights<N>().inverse();
  const core::VecX p = pressures(at, {u, {}, {}});
  for (std::size_t e = 0; e < tets(); ++e) {
    const Material& m = material(e);
    const Nodal values = nodal(u, e);
    AtPoints of_point;
    for (std::size_t point = points * e; point < points * (e + 1); ++point) {
      const Mat3& R = at.R[point];
      const Mat3 G = gradient(values, point);
      const double pressure = p[static_cast<Eigen::Index>(point)];
      const Mat3 P = m.mu() * energy::shear_gradient(model(e), R, G) +
                     pressure * energy::dilatation_gradient(model(e), R, G);
      const Mat3 s = model(e) == Model::linear ? P : cauchy_stress(P, Mat3::Identity() + G);
      const double part = shapes_[point].volume / volume_[e];
      auto six = of_point.col(static_cast<Eigen::Index>(point - points * e));
      six << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2);
      sums.stress.segment<6>(6 * static_cast<Eigen::Index>(e)) += part * six;
      sums.energy[static_cast<Eigen::Index>(e)] +=
          part * (m.mu() * energy::shear(model(e), R, G) +
                  0.5 * pressure * energy::dilatation(model(e), R, G));
    }
    if constexpr (N == 10)
      sums.corner.segment<24>(24 * static_cast<Eigen::Index>(e)) =
          (of_point * to_corners).reshaped();
  }
  return sums;
}

}  // namespace trocar::tissue
