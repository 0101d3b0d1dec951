#include "tissue/elements.hpp"

#include "tissue/elements_of.hpp"

namespace trocar::tissue {

std::unique_ptr<Elements> Elements::make(const mesh::Mesh& mesh, const fem::Space& space,
                                         const ElementSettings& settings)
{
  if (mesh.quadratic()) return std::make_unique<ElementsOf<10>>(mesh, space, settings);
  return std::make_unique<ElementsOf<4>>(mesh, space, settings);
}

bool ElementSettings::any(Model one) const
{
  if (materials.empty()) return model == one;
  for (std::size_t volume = 0; volume < materials.size(); ++volume)
    if (model_of(volume) == one) return true;
  return false;
}

bool LinearisationPoint::operator==(const LinearisationPoint& other) const
{
  // Eigen cannot compare vectors of different length.
  return R == other.R && G == other.G && p.size() == other.p.size() && p == other.p;
}

}  // namespace trocar::tissue
