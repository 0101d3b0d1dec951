#include "solve/probes.hpp"

namespace trocar::solve {

OwnedField spread(const Probes& probes, const core::VecX& f, const fem::Space& space)
{
  OwnedField forces = space.zero();
  for (std::size_t k = 0; k < probes.nodes.size(); ++k) {
    const int local = space.owned_local(probes.nodes[k]);
    if (local >= 0) forces.node(local) = f.segment<3>(3 * static_cast<Eigen::Index>(k));
  }
  for (std::size_t k = 0; k < probes.wide.size(); ++k)
    forces.value +=
        f[static_cast<Eigen::Index>(3 * probes.nodes.size() + k)] * probes.wide[k]->vector.value;
  return forces;
}

core::VecX read(const Probes& probes, const OwnedField& u, const fem::Space& space)
{
  core::VecX values = core::VecX::Zero(probes.size());
  for (std::size_t k = 0; k < probes.nodes.size(); ++k) {
    const int local = space.owned_local(probes.nodes[k]);
    if (local >= 0) values.segment<3>(3 * static_cast<Eigen::Index>(k)) = u.node(local);
  }
  for (std::size_t k = 0; k < probes.wide.size(); ++k)
    values[static_cast<Eigen::Index>(3 * probes.nodes.size() + k)] =
        probes.wide[k]->vector.value.dot(u.value);
  space.comm().sum(values);
  return values;
}

}  // namespace trocar::solve
