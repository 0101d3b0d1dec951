#include "tissue/element_forces.hpp"
#include "tissue/element_geometry.hpp"
#include "tissue/element_sizes.hpp"

namespace trocar::tissue {

template class ElementsOf<10>;

}  // namespace trocar::tissue
