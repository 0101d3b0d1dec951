#include "core/place.hpp"

#include <sstream>

#include "core/words.hpp"

namespace trocar::core {

std::string shown(const Vec3& x)
{
  std::ostringstream text;
  text << '(' << shown(x.x()) << ", " << shown(x.y()) << ", " << shown(x.z()) << ") m";
  return text.str();
}

}  // namespace trocar::core
