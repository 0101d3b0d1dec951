#include "step/scheme.hpp"

namespace trocar::step {
namespace {

using core::Vec3;

/// What a velocity at τ from the end of the step stands for there; see past_of.
struct Moments
{
  double m, q;  ///< [s], [s²]

  Moments operator-(const Moments& other) const { return {m - other.m, q - other.q}; }
};

/// (u - u_n)/h.
Differenced differenced_once(double h)
{
  return {0.5 * h, h * h / 6.0};
}

Moments moments(const Differenced& v, double tau)
{
  return {tau - v.lag, 0.5 * tau * tau - v.lag * tau + v.curvature};
}

/// û = u_n + u (u_n - u_before), and v̂ likewise.
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

/// How the velocity of a state, from which a step of length h begins, was differenced. At a start
/// it is exact. Where nothing is driven no force shows that, and the first step may have the
/// operator of all others: the start then counts as one more step of the same length.
Differenced velocity_of(const Model& model, const State& state, double h)
{
  if (state.h > 0.0) return state.velocity;
  return model.driven_at_start ? Differenced{} : differenced_once(h);
}

}  // namespace

// Velocities of positions that rows prescribe are exact differences, whose error changes with the
// length of the step; differenced again for the acceleration it would be divided by that length:
// forces of driven masses, of fluids and of stuck needles would be off by a part that does not
// vanish (the constrained motion is of index 3). So it is counted in. A velocity v_i at τ_i ≤ 0
// from the end of the step stands for  u' + m_i u'' + q_i u'''  there, with m = τ - lag and q =
// τ²/2 - lag τ + curvature, and  a = Σ c_i v_i  has  Σ c_i = 0,  Σ c_i m_i = 1  and, with three of
// them, Σ c_i q_i = 0. With equal steps these are the classical formulas.
//
// Backward Euler, v = (u - u_n)/h: lag h/2, so that a = (v - v_n)/h̄ with h̄ the mean of both steps'
// lengths, and half the step from a start where v_n is exact.
//
// BDF2 (Hairer, Norsett and Wanner 1993, III.5): with r = h/h_before
//   h v = lead (u - û),  lead = (1 + 2r)/(1 + r),  û = u_n + r²/(1 + 2r) (u_n - u_before),
// no lag, curvature -h (h + h_before)/6. Its first step is backward Euler's, and one whose length
// is out of proportion to that before; where the three velocities have no sound acceleration, the
// last two make it, to first order.
Scheme::Scheme(const Model& model, const State& old, const core::TimeStep& asked)
    : now_(asked), past_(&old), old_velocity_(velocity_of(model, old, asked.h))
{
  if (now_.is_static) return;
  constexpr double longest = 2.0 + 1e-6, shortest = 0.2 - 1e-6;  // stable up to 1 + √2
  const double h = now_.h, r = old.h > 0.0 ? h / old.h : 0.0;
  velocity_ = differenced_once(h);
  now_.interval = h - velocity_.lag + old_velocity_.lag;
  if (old.before && r <= longest && r >= shortest) extrapolate(old, r);
}

void Scheme::extrapolate(const State& old, double r)
{
  const double h = now_.h;
  now_.lead = (1.0 + 2.0 * r) / (1.0 + r);
  velocity_ = {0.0, -h * (h + old.h) / 6.0};
  const Moments end = moments(velocity_, 0.0);
  const Moments one = moments(old.velocity, -h) - end;
  const Moments two = moments(old.before->velocity, -h - old.h) - end;
  // 1/Σc and c_two/Σc of the three: some sequences (halves of halves) have no such acceleration, or
  // a nearly singular one.
  constexpr double least = 0.25, most = 2.5;  // of h
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
