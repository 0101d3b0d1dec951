#pragma once

#include "tissue/elements.hpp"

namespace trocar::tissue {

/// Chooses the tangent of the operator. With `Tangent::automatic` every step begins with the
/// rotated tangent and may switch to the exact tangent. It switches back for the rest of the step
/// when the exact tangent has no factor. With any other setting, or beside neo-Hookean tissue, the
/// tangent never changes.
class TangentChoice
{
 public:
  /// Borrows and changes both arguments.
  TangentChoice(ElementSettings& settings, Elements& elements);

  bool exact() const { return settings_->exact_tangent(); }
  bool automatic() const { return automatic_; }
  Tangent now() const { return settings_->tangent; }

  void begin_step();
  /// Switches to the exact tangent if it is automatic and was not dropped in this step. True when
  /// the tangent changed.
  bool take_exact();
  /// Switches back to the rotated tangent for the rest of the step. True when the tangent changed.
  bool drop_exact();
  void set(Tangent tangent);

 private:
  ElementSettings* settings_;
  Elements* elements_;
  bool automatic_;
  bool dropped_ = false;  ///< the exact tangent is ruled out for the rest of the step
};

}  // namespace trocar::tissue
