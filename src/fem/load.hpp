#pragma once

#include <functional>

#include "fem/space.hpp"

namespace trocar::fem {

/// Nodal forces that depend on the displacement, linearised: f(u + d) = force + stiffness(d).
struct Load
{
  OwnedField force{};  ///< [N]; empty: none
  /// ∂f/∂u d [N] for d [m], symmetric; empty: the forces do not follow. Collective.
  std::function<OwnedField(const OwnedField&)> stiffness{};
};

}  // namespace trocar::fem
