#pragma once

#include "tissue/elements_of.hpp"

// Inertia and weight of the tets, and the scales that residuals are compared with: definitions that
// only linear_tets.cpp and quadratic_tets.cpp include.
namespace trocar::tissue {

/// Adds the part of tet e to ForceSums::size and ForceSums::rounding. Rounding changes the
/// displacement gradient by ε Σ|∇N_b||u_b|, and F by ε where F = 1 + G is formed. The largest wave
/// modulus, λ + 2μ, turns both errors into stress. Damping and inertia have a factor 2, because
/// velocity and acceleration are differences of displacements.
template <int N>
void ElementsOf<N>::add_sizes(std::size_t e, const Kinematics& motion, const Nodal& force,
                              const Nodal& inertia, ForceSums& sums) const
{
  const Material& m = material(e);
  const Nodal u = nodal(motion.u, e);
  const Eigen::Matrix<double, N, 1> moved = u.colwise().template lpNorm<1>().transpose();
  const double formed = model(e) == Model::linear ? 0.0 : 1.0;
  const double damped = 1.0 + 2.0 * m.rayleigh_stiffness * motion.rates.velocity;
  const double modulus = m.lambda() + 2.0 * m.mu();
  Eigen::Matrix<double, N, 1> rounding =
      Eigen::Matrix<double, N, 1>::Constant(2.0 * m.density * volume_[e] / N *
                                            motion.rates.velocity *
                                            (motion.rates.acceleration + m.rayleigh_mass))
          .cwiseProduct(moved);
  for (std::size_t point = points * e; point < points * (e + 1); ++point) {
    const Eigen::Matrix<double, N, 1> slope =
        shapes_[point].gradient.colwise().template lpNorm<1>().transpose();
    rounding += shapes_[point].volume * modulus * (formed + damped * slope.dot(moved)) * slope;
  }
  const auto nodes = space_->nodes(e);
  for (std::size_t a = 0; a < N; ++a) {
    if (nodes[a] >= space_->owned()) continue;
    const auto i = static_cast<Eigen::Index>(a);
    sums.size[nodes[a]] += force.col(i).norm() + inertia.col(i).norm();
    sums.rounding[nodes[a]] += rounding[i];
  }
}

template <int N>
void ElementsOf<N>::add_inertia(const Kinematics& motion, OwnedField& inertia) const
{
  for (std::size_t e = 0; e < tets(); ++e) {
    const Material& m = material(e);
    const Nodal w = nodal(motion.a, e) + m.rayleigh_mass * nodal(motion.v, e);
    scatter(m.density * mass_factor(e) * w * mass_form(e), e, inertia);
  }
}

template <int N>
void ElementsOf<N>::add_weight(const core::Vec3& gravity, OwnedField& force) const
{
  for (std::size_t e = 0; e < tets(); ++e) {
    const Eigen::Matrix<double, 1, N> share = mass_factor(e) * mass_form(e).colwise().sum();
    scatter(material(e).density * gravity * share, e, force);
  }
}

}  // namespace trocar::tissue
