#pragma once

#include <vector>

#include "fem/space.hpp"

namespace trocar::solve {

using fem::OwnedField;

/// A wide probe: a functional of many dofs, such as the volume gradient of a cavity. Its compliance
/// column is kept until a functional with the same `id` has another `version`.
struct DistributedFunctional
{
  long long id;
  OwnedField vector;
  long long version = 0;
};

/// The probes of a set of rows: nodes with all three dofs (file numbering, sorted, unique), and
/// wide probes. Slots: the dofs of the nodes (3 per node), then the wide probes.
struct Probes
{
  std::vector<int> nodes;
  std::vector<const DistributedFunctional*> wide;

  int size() const { return static_cast<int>(3 * nodes.size() + wide.size()); }
};

/// Sᵀ f: forces on the owned nodes [N] from f [N] by slot of the probes. Forces on fixed dofs are
/// not cleared. Not collective.
OwnedField spread(const Probes& probes, const core::VecX& f, const fem::Space& space);

/// S u [m] by slot of the probes, equal on every rank. Collective.
core::VecX read(const Probes& probes, const OwnedField& u, const fem::Space& space);

}  // namespace trocar::solve
