#include "driver/log.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

#include "base/blas.hpp"
#include "core/words.hpp"
#include "driver/provenance.hpp"

namespace trocar::driver {

Log::Log(const step::Model& model, const Scenario& scenario) : model_(&model), scenario_(&scenario)
{
}

bool Log::speaks() const
{
  return model_->space.comm().root() && !scenario_->output.quiet;
}

void Log::plan() const
{
  const double bytes = model_->tissue.factor().solver().memory_bytes();
  if (speaks() && bytes > 0.0) std::printf("tissue solver: about %.0f MB\n", 1e-6 * bytes);
}

void Log::set_up(double seconds) const
{
  const std::string solver = model_->tissue.factor().solver().describe();
  if (!speaks()) return;
  const Scenario& scenario = *scenario_;
  const mesh::Mesh& mesh = scenario.mesh;
  const mesh::Quality q = mesh::quality(mesh);
  std::printf("%s\n", build_description().c_str());
  std::printf("mesh %s: %d nodes, %d tets, %d dofs, volume %.6g m^3, edges %.3g-%.3g m\n",
              mesh.file.c_str(), mesh.node_count(), mesh.tet_count(), 3 * mesh.node_count(),
              q.volume, q.shortest_edge, q.longest_edge);
  std::printf("  quality: mean %.3f, worst %.3f (tet %lld)\n", q.mean, q.smallest, q.worst_tag);
  for (const std::string& remark : mesh.remarks)
    std::printf("  note: %s\n", core::printable(remark, 400).c_str());
  std::printf("ranks %d, tissue solver %s, set-up %.2f s\n", model_->space.comm().size(),
              solver.c_str(), seconds);
  const double rate = base::blas_rate();
  const std::string library = base::blas_library();
  std::printf("dense products %.0f Gflop/s\n", 1e-9 * rate);
  if (base::slow_blas(rate, library))
    std::printf(
        "warning: the BLAS is slow (%s): install libopenblas0-serial, and set OMP_THREAD_LIMIT=1 "
        "and, on AVX-512 processors, OPENBLAS_CORETYPE=SkylakeX\n",
        library.c_str());
  if (model_->cavities) cavities(*model_->cavities);
  for (const std::string& warning : scenario.warnings)
    std::printf("warning: %s\n", core::printable(warning, 400).c_str());
  std::fflush(stdout);
}

void Log::cavities(const cavity::Cavities& cavities) const
{
  const Scenario& scenario = *scenario_;
  double softest = std::numeric_limits<double>::infinity(), density = 0.0;
  for (const tissue::Material& m : scenario.tissue.materials) {
    softest = std::min(softest, 0.5 * m.young / (1.0 + m.poisson));
    density = std::max(density, m.density);
  }
  for (int i = 0; i < cavities.size(); ++i) {
    const cavity::Wall& wall = cavities.wall(i);
    std::printf("cavity %s: volume %.6g m^3, area %.6g m^2, %zu wall nodes, %zu caps\n",
                scenario.cavities.cavities[static_cast<std::size_t>(i)].name.c_str(), wall.volume(),
                wall.area(), wall.nodes().size(), wall.rims().size());
    for (const std::vector<int>& rim : wall.rims()) {
      std::printf("  cap between nodes");
      for (int node : rim)
        std::printf(" %lld", scenario.mesh.node_tag[static_cast<std::size_t>(node)]);
      std::printf("\n");
    }
    // The fluid is modelled without inertia. This is wrong when the steps are short enough to
    // resolve shear waves that pass the cavity.
    const double crossing = std::cbrt(wall.volume()) * std::sqrt(density / softest);
    if (!scenario.time.is_static && scenario.time.step < crossing && scenario.time.end > 0.0)
      std::printf(
          "warning: the fluid has no inertia, but steps of %.3g s resolve waves past the "
          "cavity (%.3g s)\n",
          scenario.time.step, crossing);
  }
}

void Log::step(int number, const step::State& state, const step::StepReport& report)
{
  if (!speaks()) return;
  warn(state, report);
  energy_ = state.energy;
  for (const step::NeedleReport& needle : report.needles) {
    friction_ -= needle.coupling.friction_work;
    cutting_ -= needle.coupling.cutting_work;
  }
  if (lines_++ % 40 == 0) {
    std::printf("%6s %10s %11s %10s %6s %6s %10s %12s ", "step", "time [s]", "travel [mm]",
                "depth [mm]", "rows", "iters", "resid [m]", "base [N]");
    if (!report.cavities.empty()) std::printf("%12s ", "p [Pa]");
    std::printf("%8s\n", "ETA [s]");
  }
  double travel = state.needles.empty() ? 0.0 : state.needles.front().travel;
  double depth = 0.0, force = 0.0;
  for (const needle::NeedleState& needle : state.needles) travel = std::max(travel, needle.travel);
  for (const step::NeedleReport& needle : report.needles) {
    depth = std::max(depth, needle.depth);
    force = std::max(force, needle.base.force.norm());
  }
  const double end = scenario_->time.end;
  const double done = state.t - begun_;
  const double eta = done > 0.0 ? watch_.seconds() * (end - state.t) / done : std::nan("");
  std::printf("%6d %10.4f %11.3f %10.3f %6d %6d %10.2e %12.5f ", number, state.t, 1e3 * travel,
              1e3 * depth, report.rows, report.iterations, report.residual, force);
  if (!report.cavities.empty()) std::printf("%12.2f ", report.cavities.front().pressure);
  if (std::isfinite(eta))
    std::printf("%8.1f\n", eta);
  else
    std::printf("%8s\n", "-");
  std::fflush(stdout);
}

/// Warns of accepted steps with doubtful results: an inverted element in linear tissue, a tip
/// support wider than asked, or a gain of energy.
void Log::warn(const step::State& state, const step::StepReport& report)
{
  const bool folded = report.folded >= 0;
  if (folded && !folded_) {
    const mesh::Mesh& mesh = scenario_->mesh;
    std::printf("warning: at t = %.6g s linear tissue has an element inside out: tet %lld\n",
                state.t, mesh.elem_tag[static_cast<std::size_t>(report.folded)]);
  }
  folded_ = folded;
  warn_of_supports(state);
  if (!scenario_->energy || scenario_->time.second_order) return;
  constexpr double part = 1e-6, rounded = 1e-12;
  turned_over_ += std::abs(state.energy.supplied - energy_.supplied);
  const double gain = energy_.rest() - state.energy.rest();
  const double stored = state.energy.elastic + state.energy.kinetic;
  const bool gained = state.t > 0.0 && gain > part * turned_over_ + rounded * stored;
  if (gained && !gained_)
    std::printf("warning: at t = %.6g s the step gains energy: %.3g J of %.3g J supplied so far\n",
                state.t, gain, turned_over_);
  gained_ = gained;
}

void Log::warn_of_supports(const step::State& state)
{
  const double asked = scenario_->insertion.tip.radius;
  widened_.resize(state.insertions.size(), false);
  for (std::size_t i = 0; i < state.insertions.size(); ++i) {
    const insertion::TipState& tip = state.insertions[i].tip;
    if (widened_[i] || !(asked > 0.0) || !tip.pressed || tip.radius <= asked) continue;
    widened_[i] = true;
    std::printf(
        "warning: the tip of needle '%s' is carried by the tissue within %.3g m, the local "
        "edge of the mesh, not within -insertion_tip_radius %.3g m\n",
        scenario_->needles[i].name.c_str(), tip.radius, asked);
  }
}

void Log::note(const std::string& line) const
{
  if (!speaks()) return;
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

void Log::goes_on(const step::State& state)
{
  begun_ = state.t;
  energy_ = state.energy;
}

void Log::print_energy() const
{
  std::printf(
      "\nenergy [J]: supplied %.4g = elastic %.4g + kinetic %.4g - at the start %.4g "
      "+ friction %.4g + cutting %.4g + damping %.4g",
      energy_.supplied, energy_.elastic, energy_.kinetic, energy_.stored_at_start, energy_.friction,
      energy_.cutting, energy_.damping);
  if (!scenario_->contact.pairs.empty())
    std::printf(" + contact %.4g + its friction %.4g", energy_.contact, energy_.contact_friction);
  std::printf(" + rest %.2g", energy_.rest());
}

void Log::finish(std::optional<double> stopped) const
{
  if (!speaks()) return;
  std::printf("work:");
  for (const auto& [name, count] : model_->ledger.entries())
    if (count != 0)
      std::printf(" %s %lld", std::string(name).c_str(), static_cast<long long>(count));
  if (!model_->needles.empty())
    std::printf("\ndissipated%s [J]: friction %.4g, cutting %.4g",
                begun_ > 0.0 ? " since the checkpoint" : "", friction_, cutting_);
  if (scenario_->energy) print_energy();
  const char* folder = scenario_->output.folder.c_str();
  if (stopped)
    std::printf("\nstopped at the checkpoint of t = %.6g s after %.1f s: -restart %s goes on\n",
                *stopped, watch_.seconds(), folder);
  else
    std::printf("\nfinished in %.1f s; results in %s\n", watch_.seconds(), folder);
}

}  // namespace trocar::driver
