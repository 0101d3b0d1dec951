#include "tissue/element.hpp"

namespace trocar::tissue {

Work Tissue::work(const TissueState& old, const TissueState& next, const TimeStep& step,
                  const OwnedField& push) const
{
  const auto u_g = space_->with_ghosts(next.u);
  const auto v_g = space_->with_ghosts(next.v);
  std::vector<Mat3> R;
  rotations(u_g, R);
  Work work;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const auto& tet = space_->tets()[e];
    if (tet.nodes[0] >= space_->owned()) continue;  // the owner of its first node counts it
    const fem::TetShape& shape = elements_[e].shape;
    const Material& m = settings_.materials[static_cast<std::size_t>(elements_[e].region)];
    const Nodal v = nodal_values(v_g, tet);
    const Mat3 F = Mat3::Identity() + nodal_gradient(shape, nodal_values(u_g, tet));
    work.elastic += 0.5 * shape.volume * strain_square(m, corotational_strain(R[e], F));
    if (step.is_static) continue;
    const double inertia =
        v.cwiseProduct(mass_times(v, m.density * shape.volume, settings_.mass)).sum();
    const Mat3 rate = R[e].transpose() * nodal_gradient(shape, v);
    work.kinetic += 0.5 * inertia;
    work.damped += step.h * (m.rayleigh_mass * inertia +
                             m.rayleigh_stiffness * shape.volume *
                                 strain_square(m, 0.5 * (rate + rate.transpose())));
  }
  work.elastic = space_->comm().sum(work.elastic);
  work.kinetic = space_->comm().sum(work.kinetic);
  work.damped = space_->comm().sum(work.damped);
  // Loads, and the supports where they move: they carry what is out of balance on their dofs.
  const OwnedField moved{next.u.value - old.u.value};
  OwnedField support{-forces(old, next.u, R, step, nullptr).value - push.value};
  OwnedField elsewhere = support;
  fixed_.clear(elsewhere);
  support.value -= elsewhere.value;
  work.supplied = space_->dot(external(step), moved) + space_->dot(support, moved);
  return work;
}

}  // namespace trocar::tissue
