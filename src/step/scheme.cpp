#include "step/scheme.hpp"

namespace trocar::step {
namespace {

using core::Vec3;

/// Coefficients in v = u' + m u'' + q u''' for a velocity v at the time τ from the end of the step,
/// with the derivatives at the end (see the constructor of Scheme).
struct Moments
{
  double m, q;  ///< [s], [s²]

  Moments operator-(const Moments& other) const { return {m - other.m, q - other.q}; }
};

/// Error terms of the velocity (u - u_n)/h.
Differenced differenced_once(double h)
{
  return {0.5 * h, h * h / 6.0};
}

Moments moments(const Differenced& v, double tau)
{
  return {tau - v.lag, 0.5 * tau * tau - v.lag * tau + v.curvature};
}

/// Coefficients u and v in û = u_n + u (u_n - u_before) and v̂ = v_n + v (v_n - v_before).
struct Extrapolation
{
  double u, v;
};

void extrapolate(double c, const Vec3& before, Vec3& value)
{
  value += c * (value - before);
}

void extrapolate(const Extrapolation& past, const needle::NeedleState& before,
                 needle::NeedleState& needle)
{
  for (std::size_t i = 0; i < needle.v.size(); ++i) {
    extrapolate(past.u, before.shaft.x[i], needle.shaft.x[i]);
    const core::Mat3 turn = needle.shaft.R[i] * before.shaft.R[i].transpose();
    needle.shaft.R[i] = core::rotation_exp(past.u * core::rotation_log(turn)) * needle.shaft.R[i];
    extrapolate(past.v, before.v[i], needle.v[i]);
    extrapolate(past.v, before.w[i], needle.w[i]);
  }
}

/// Error terms of the velocity of `state`, from which a step of length h begins. The velocity of
/// the start is exact. If nothing is driven there, no force depends on these terms. The start then
/// counts as the end of a step of length h, so that the first step has the operator of all others.
Differenced velocity_of(const Model& model, const State& state, double h)
{
  if (state.h > 0.0) return state.velocity;
  return model.driven_at_start ? Differenced{} : differenced_once(h);
}

}  // namespace

// Rows and supports prescribe positions exactly. Velocities are differences of positions, and their
// error changes with the length of the step. The acceleration is a difference of velocities, so
// this error would be divided by the step length. The forces of driven masses, of fluids and of
// stuck needles would then have an error that does not vanish with h (the constrained motion is of
// index 3). The scheme therefore takes this error into account. A velocity v_i at τ_i ≤ 0 from the
// end of the step equals  u' + m_i u'' + q_i u'''  at the end, with m = τ - lag and
// q = τ²/2 - lag τ + curvature. The acceleration is  a = Σ c_i v_i  with  Σ c_i = 0,  Σ c_i m_i = 1
// and, from three velocities, also  Σ c_i q_i = 0. Equal steps give the classical formulas.
//
// Backward Euler, v = (u - u_n)/h: the lag is h/2. Hence a = (v - v_n)/h̄, where h̄ is the mean
// length of this step and the one before. After a start, where v_n is exact, h̄ is h/2.
//
// BDF2 (Hairer, Norsett and Wanner 1993, III.5): with r = h/h_before
//   h v = lead (u - û),  lead = (1 + 2r)/(1 + r),  û = u_n + r²/(1 + 2r) (u_n - u_before).
// The lag is 0 and the curvature -h (h + h_before)/6. Backward Euler takes the first step, and any
// step with r outside `shortest` to `longest`. Where the three velocities have no sound
// acceleration, the last two give one of first order.
Scheme::Scheme(const Model& model, const State& old, const core::TimeStep& asked, int order)
    : now_(asked), past_(&old), old_velocity_(velocity_of(model, old, asked.h))
{
  if (now_.is_static && now_.proximal == 0.0) now_.proximal = model.proximal;
  if (now_.is_static) return;
  constexpr double longest = 2.0 + 1e-6, shortest = 0.2 - 1e-6;  // stable for r <= 1 + √2
  const double h = now_.h, r = old.h > 0.0 ? h / old.h : 0.0;
  velocity_ = differenced_once(h);
  now_.interval = h - velocity_.lag + old_velocity_.lag;
  if (order == 2 && old.before && r <= longest && r >= shortest) extrapolate(old, r);
}

void Scheme::extrapolate(const State& old, double r)
{
  const double h = now_.h;
  now_.lead = (1.0 + 2.0 * r) / (1.0 + r);
  velocity_ = {0.0, -h * (h + old.h) / 6.0};
  const Moments end = moments(velocity_, 0.0);
  const Moments one = moments(old.velocity, -h) - end;
  const Moments two = moments(old.before->velocity, -h - old.h) - end;
  // h̄ = 1/c with the coefficient c of the new velocity, from the three conditions above. After some
  // sequences of steps (halves of halves) they have no solution, or are nearly singular.
  constexpr double least = 0.25, most = 2.5;  // limits of h̄/h
  const double interval = (one.m * two.q - two.m * one.q) / (one.q - two.q);
  const bool three = interval >= least * h && interval <= most * h;
  now_.interval = three ? interval : -moments(old.velocity, -h).m;
  const Extrapolation by{r * r / (1.0 + 2.0 * r), three ? -one.q / (one.q - two.q) : 0.0};
  State& past = extrapolated_;
  past.tissue = old.tissue;
  past.tissue.u.value += by.u * (old.tissue.u.value - old.before->tissue.u.value);
  past.tissue.v.value += by.v * (old.tissue.v.value - old.before->tissue.v.value);
  past.needles = old.needles;
  for (std::size_t i = 0; i < past.needles.size(); ++i)
    step::extrapolate(by, old.before->needles[i], past.needles[i]);
  past_ = &past;
}

}  // namespace trocar::step
