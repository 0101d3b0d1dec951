#include "driver/reports.hpp"

#include <cmath>

#include "core/words.hpp"
#include "io/size_field.hpp"
#include "post/error_estimate.hpp"
#include "post/locking_gauge.hpp"

namespace trocar::driver {

void report_locking(const step::Model& model, Recorder& recorder, const Log& log)
{
  const step::Scene& scene = model.scene;
  const std::vector<double> ratios = post::locking_ratios(scene, model.space.comm());
  for (std::size_t i = 0; i < ratios.size(); ++i)
    log.note("locking gauge: dP/dV of cavity '" + scene.cavities.cavities[i].name + "' is " +
             core::shown(ratios[i]) + " times that of p2_bbar on this mesh");
  recorder.table("/locking_gauge/ratio", ratios, "1");
}

void report_pv_curve(const post::PvCurve& curve, Recorder& recorder, const Log& log)
{
  recorder.table("/pv_curve/volume_ratio", curve.ratio, "1");
  recorder.table("/pv_curve/pressure", curve.pressure, "Pa");
  recorder.table("/pv_curve/line", curve.line, "Pa");
  recorder.table("/pv_curve/pieces", curve.pieces, "Pa");
  recorder.table("/pv_curve/slope", {curve.slope}, "Pa");
  recorder.table("/pv_curve/r_squared", {curve.r_squared}, "1");
  log.note("P-V curve: slope K_p = " + core::shown(curve.slope) +
           " Pa, R^2 = " + core::shown(curve.r_squared));
}

void report_error(const step::Model& model, const OutputSettings& output, const step::State& state,
                  Recorder& recorder, const Log& log)
{
  const step::Scene& scene = model.scene;
  const post::ErrorEstimate estimate = post::estimate_error(scene.mesh, scene.tissue.materials,
                                                            model.tissue.stresses(state.tissue.u));
  recorder.table("/error_estimate/relative", {estimate.relative}, "1");
  recorder.table("/error_estimate/part", estimate.part, "1");
  const core::VecX of_tet = estimate.errors.cwiseSqrt();
  recorder.table("/error_estimate/tet", {of_tet.begin(), of_tet.end()}, "J^(1/2)");
  log.note("estimated error: " + core::shown(100.0 * estimate.relative) + " % of the energy norm");
  for (std::size_t v = 0; v < estimate.part.size(); ++v)
    log.note("  volume " + scene.mesh.volumes[v] + ": " + core::shown(100.0 * estimate.part[v]) +
             " % of its square");
  const double target = output.error_target;
  if (target > 0.0 && estimate.relative > target)
    log.note("  for a target of " + core::shown(100.0 * target) + " % edges must be about " +
             core::shown(std::pow(estimate.relative / target, scene.mesh.quadratic() ? 0.5 : 1.0)) +
             " times shorter (smooth stress)");
  if (output.size_field.empty()) return;
  if (!(estimate.sum() > 0.0))
    throw core::option_error(
        "option -error_size_field: nothing is strained, so there is no error to take sizes from");
  const core::VecX sizes =
      post::wanted_sizes(scene.mesh, estimate.errors, estimate.energy + estimate.sum(), target);
  base::on_root(model.space.comm(),
                [&] { io::write_size_field(output.size_field, scene.mesh, sizes); });
  log.note("  sizes for the next mesh: " + output.size_field +
           " (a background field for Gmsh; scripts/study adapt)");
}

}  // namespace trocar::driver
