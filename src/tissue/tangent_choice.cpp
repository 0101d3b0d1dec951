#include "tissue/tangent_choice.hpp"

namespace trocar::tissue {

TangentChoice::TangentChoice(ElementSettings& settings, Elements& elements)
    : settings_(&settings),
      elements_(&elements),
      automatic_(settings.any(Model::corotational) && !settings.any(Model::neo_hookean) &&
                 settings.tangent == Tangent::automatic)
{
  // The tangent of neo-Hookean tissue is always exact. Held rotations in the corotational tissue
  // beside it would save nothing.
  if (settings.any(Model::neo_hookean) && settings.tangent == Tangent::automatic)
    set(Tangent::exact);
}

void TangentChoice::begin_step()
{
  dropped_ = false;
  if (automatic_ && exact()) set(Tangent::rotated);
}

bool TangentChoice::take_exact()
{
  if (!automatic_ || dropped_ || exact()) return false;
  set(Tangent::exact);
  return true;
}

bool TangentChoice::drop_exact()
{
  if (!automatic_ || !exact()) return false;
  dropped_ = true;
  set(Tangent::rotated);
  return true;
}

void TangentChoice::set(Tangent tangent)
{
  settings_->tangent = tangent;
  elements_->take(tangent);
}

}  // namespace trocar::tissue
