#pragma once

#include <vector>

#include "fem/space.hpp"

namespace trocar::solve {

using fem::OwnedField;

/// A probe that touches many dofs, such as the volume gradient of a cavity. Its column is kept
/// until one of the same `id` comes with another `version`.
struct DistributedFunctional
{
  long long id;
  OwnedField vector;
  long long version = 0;
};

/// What a constraint set asks for: whole nodes (three unit dofs each, file numbering, sorted and
/// unique) and wide vectors. Slots are 3 * nodes, then the wide ones.
struct Probes
{
  std::vector<int> nodes;
  std::vector<const DistributedFunctional*> wide;

  int size() const { return static_cast<int>(3 * nodes.size() + wide.size()); }
};

/// Sᵀ f: nodal forces [N] of the owned nodes from f [N] by slot of the probes; fixed dofs get
/// theirs as well. Not collective.
OwnedField spread(const Probes& probes, const core::VecX& f, const fem::Space& space);

/// S u by slot of the probes, equal on every rank. Collective.
core::VecX read(const Probes& probes, const OwnedField& u, const fem::Space& space);

}  // namespace trocar::solve
