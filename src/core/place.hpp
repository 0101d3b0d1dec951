#pragma once

#include <string>

#include "core/math.hpp"

namespace trocar::core {

/// A place as messages name it: "(x, y, z) m".
std::string shown(const Vec3& x);

}  // namespace trocar::core
