#pragma once

#include <functional>

#include "fem/space.hpp"

namespace trocar::fem {

/// Nodal forces that depend on the displacement, linearised: f(u + d) = force + stiffness(d).
struct Load
{
  OwnedField force{};  ///< [N]; empty: zero
  /// Product (∂f/∂u) d [N] for d [m], symmetric; empty: the forces do not depend on u. Collective.
  std::function<OwnedField(const OwnedField&)> stiffness{};
};

}  // namespace trocar::fem
