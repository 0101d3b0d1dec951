#include "tissue/tissue.hpp"

// Where the tissue is linearised, with which tangent, and when that cannot be.
namespace trocar::tissue {

/// `goes_on`: from the last linearisation, whose pressures then lead to those of the tangent.
bool Tissue::linearise_at(const OwnedField& iterate, bool goes_on)
{
  const bool led = goes_on && exact_at_ && exact_tangent();
  core::VecX p;
  if (led) p = elements_->led_pressures(at_, space_->with_ghosts({iterate.value - u_at_.value}));
  const bool known = configured_.u && !exact_tangent() && configured_.u->value == iterate.value;
  bool upright = true;  // else the balance would have been found where an element is folded
  known_ = space_->comm().all(known);
  if (known_)
    at_ = configured_.at;
  else
    upright = configure(space_->with_ghosts(iterate), at_);
  exact_at_ = upright && settings_.exact_tangent();
  if (exact_at_) u_at_ = iterate;
  if (led && upright) at_.p = std::move(p);
  return upright;
}

/// Exact tangents may be indefinite on the way to an equilibrium: a smaller step may do. Agreed by
/// all ranks, as the failures of a factor are. Otherwise the operator fails for good.
std::optional<std::string> Tissue::why_not(const std::function<void()>& make_operator)
{
  try {
    make_operator();
  } catch (const core::Failure& failure) {
    if (!settings_.exact_tangent() || failure.code() != core::ExitCode::solver) throw;
    current_->older = false;
    current_->rate.reset();
    current_->uses = 0;
    return "the exact tangent has no factor (an instability, or too large a step): " +
           std::string(failure.what());
  }
  return std::nullopt;
}

int Tissue::folded(const OwnedField& u) const
{
  const int none = mesh_->tet_count();
  int mine = elements_->folded(space_->with_ghosts(u));
  if (mine < 0) mine = u.value.allFinite() ? none : 0;
  const auto first = static_cast<int>(-space_->comm().max(-static_cast<double>(mine)));
  return first == none ? -1 : first;
}

void Tissue::begin_step()
{
  dropped_ = false;
  if (automatic_ && exact_tangent()) take(Tangent::rotated);
}

bool Tissue::take_exact()
{
  if (!automatic_ || dropped_ || exact_tangent()) return false;
  take(Tangent::exact);
  return true;
}

bool Tissue::drop_exact()
{
  if (!automatic_ || !exact_tangent()) return false;
  dropped_ = true;
  take(Tangent::rotated);
  return true;
}

void Tissue::take(Tangent tangent)
{
  settings_.tangent = tangent;
  elements_->take(tangent);
  configured_.u.reset();  // it has what the other tangent needs
}

}  // namespace trocar::tissue
