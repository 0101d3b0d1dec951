#pragma once

#include "tissue/elements.hpp"

namespace trocar::tissue {

/// Which tangent the operator has. With `Tangent::automatic` every step begins with the rotated
/// one, may take the exact one from some linearisation on, and goes back for the rest of the step
/// when that has no factor. Others never change.
class TangentChoice
{
 public:
  /// Borrows both, which it changes.
  TangentChoice(ElementSettings& settings, Elements& elements);

  bool exact() const { return settings_->exact_tangent(); }
  bool automatic() const { return automatic_; }
  Tangent now() const { return settings_->tangent; }

  void begin_step();
  /// Each returns whether anything changed.
  bool take_exact();
  bool drop_exact();
  void set(Tangent tangent);

 private:
  ElementSettings* settings_;
  Elements* elements_;
  bool automatic_;
  bool dropped_ = false;  ///< not to the exact one in this step
};

}  // namespace trocar::tissue
