#include "driver/simulation.hpp"

namespace trocar::driver {
namespace {

void extrapolate(double c, const Vec3& before, Vec3& value)
{
  value += c * (value - before);
}

void extrapolate(double c, const needle::NeedleState& before, needle::NeedleState& needle)
{
  for (std::size_t i = 0; i < needle.v.size(); ++i) {
    extrapolate(c, before.shaft.x[i], needle.shaft.x[i]);
    const core::Mat3 turn = needle.shaft.R[i] * before.shaft.R[i].transpose();
    needle.shaft.R[i] = core::rotation_exp(c * core::rotation_log(turn)) * needle.shaft.R[i];
    extrapolate(c, before.v[i], needle.v[i]);
    extrapolate(c, before.w[i], needle.w[i]);
  }
}

}  // namespace

// BDF2 with a varying step is backward Euler from an extrapolated past: with r = h/h_before,
//   h u' = lead (u - û),  lead = (1 + 2r)/(1 + r),  û = u_n + r²/(1 + 2r) (u_n - u_before),
// and the same for v' (Hairer, Norsett and Wanner 1993, III.5). The first step is backward Euler's,
// and one that is much longer than that before.
const State& Simulation::past_of(const State& old, core::TimeStep& now, State& extrapolated) const
{
  if (now.is_static || !old.before) return old;
  const double r = now.h / old.before->h;
  constexpr double longest = 2.0;  // BDF2 is stable up to 1 + √2
  if (r > longest) return old;
  now.lead = (1.0 + 2.0 * r) / (1.0 + r);
  const double c = r * r / (1.0 + 2.0 * r);
  extrapolated.tissue = old.tissue;
  extrapolated.tissue.u.value += c * (old.tissue.u.value - old.before->tissue.u.value);
  extrapolated.tissue.v.value += c * (old.tissue.v.value - old.before->tissue.v.value);
  extrapolated.needles = old.needles;
  for (std::size_t i = 0; i < needles_.size(); ++i)
    extrapolate(c, old.before->needles[i], extrapolated.needles[i]);
  return extrapolated;
}

}  // namespace trocar::driver
