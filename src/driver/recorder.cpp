#include "driver/recorder.hpp"

#include <cstdio>

#include "driver/provenance.hpp"
#include "driver/restart.hpp"
#include "post/stress_fields.hpp"
#include "step/archive.hpp"

namespace trocar::driver {
namespace {

using core::Vec3;

io::Field nodal_field(const std::string& name, const std::string& units,
                      const fem::GlobalField& field)
{
  return {name, 3,    units, {field.value.data(), field.value.data() + field.value.size()},
          true, false};
}

/// Coupling points of all needles, one row each. The id of a point is needle index · 10⁶ + number
/// of its site.
std::vector<io::Field> coupling_fields(const step::Model& model, const step::State& state,
                                       const fem::GlobalField& u)
{
  io::Field id{"/coupling/id", 0, "1", {}, false, true};
  io::Field position{"/coupling/position", 3, "m", {}, false, false};
  io::Field lambda{"/coupling/lambda", 3, "N", {}, false, false};
  io::Field stuck{"/coupling/state", 0, "1", {}, false, true};
  io::Field tributary{"/coupling/tributary", 0, "m", {}, false, false};
  for (std::size_t n = 0; n < state.insertions.size(); ++n) {
    const auto& insertion = state.insertions[n];
    const core::VecX lengths =
        insertion::tributary_lengths(model.scene.mesh, insertion).rowwise().sum();
    for (std::size_t k = 0; k < insertion.points.size(); ++k) {
      const auto& point = insertion.points[k];
      const auto& anchor = insertion.path.sites[static_cast<std::size_t>(point.site)].anchor;
      const Vec3 x = anchor.mean([&](int node) -> Vec3 {
        return model.scene.mesh.x[static_cast<std::size_t>(node)] + u.node(node);
      });
      id.values.push_back(1e6 * static_cast<double>(n) + insertion.path.first_id + point.site);
      position.values.insert(position.values.end(), x.data(), x.data() + 3);
      lambda.values.insert(lambda.values.end(), point.lambda.data(), point.lambda.data() + 3);
      stuck.values.push_back(point.stuck ? 0.0 : 1.0);
      tributary.values.push_back(lengths[static_cast<Eigen::Index>(k)]);
    }
  }
  if (id.values.empty()) return {};
  return {id, position, lambda, stuck, tributary};
}

/// Gap, pressure, traction and state of every pair at the nodes of the mesh; not zero at slave
/// corners in reach only.
std::vector<io::Field> contact_fields(const step::Model& model, const step::StepReport& report)
{
  std::vector<io::Field> fields;
  const auto nodes = static_cast<std::size_t>(model.scene.mesh.node_count());
  for (std::size_t p = 0; p < report.contact.size(); ++p) {
    const std::string at = "/contact/" + model.scene.contact.pairs[p].name + "/";
    io::Field gap{at + "gap", 0, "m", std::vector<double>(nodes), true};
    io::Field pressure{at + "pressure", 0, "Pa", std::vector<double>(nodes), true};
    io::Field traction{at + "traction", 3, "Pa", std::vector<double>(3 * nodes), true};
    io::Field state{at + "state", 0, "1", std::vector<double>(nodes, -1.0), true};
    for (const contact::CornerReport& corner : report.contact[p].corners) {
      const auto n = static_cast<std::size_t>(corner.node);
      gap.values[n] = corner.gap;
      pressure.values[n] = corner.pressure;
      for (std::size_t axis = 0; axis < 3; ++axis)
        traction.values[3 * n + axis] =
            -corner.force[static_cast<Eigen::Index>(axis)] / corner.area;
      state.values[n] = corner.state;
    }
    for (io::Field* field : {&gap, &pressure, &traction, &state})
      fields.push_back(std::move(*field));
  }
  return fields;
}

/// Axis and radius of every needle, so that ParaView can draw the needles.
std::vector<io::Curve> needle_curves(const step::Model& model, const step::State& state)
{
  std::vector<io::Curve> curves;
  for (std::size_t n = 0; n < state.needles.size(); ++n) {
    const needle::NeedleSettings& needle = model.scene.needles[n];
    io::Curve curve{"/needle/" + needle.name, {}, needle.section.outer};
    for (const Vec3& x : state.needles[n].shaft.x)
      curve.points.insert(curve.points.end(), x.data(), x.data() + 3);
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace

Recorder::Recorder(const step::Model& model, const Scenario& scenario, const Invocation& invocation,
                   const std::vector<core::ResolvedOption>& options, const io::Checkpoint* from)
    : model_(&model), output_(&scenario.output), histories_(histories(scenario))
{
  const std::string solver = model.tissue.factor().solver().describe();
  base::on_root(model.space.comm(), [&] {
    options_ = options_with_hashes(options, scenario.mesh);
    std::vector<io::Series> series;
    for (const History& history : histories_) series.push_back(history.series);
    const std::string& folder = output_->folder;
    if (from && !scenario.restart.branch) {
      results_.emplace(folder, scenario.mesh, series, *from, restart_note(*from, invocation));
      io::Checkpoint renewed = *from;  // run.h5 was rewritten, so its places and its sum changed
      results_->fill_in(renewed);
      io::write_checkpoint(folder, renewed);
    } else {
      io::Provenance origin = provenance(model, invocation, options, solver);
      if (from) origin.texts.emplace_back("restart_from", restart_note(*from, invocation));
      results_.emplace(folder, scenario.mesh, origin, series,
                       static_cast<std::size_t>(step::step_count(scenario.time)) + 1);
    }
    for (const std::string& remark : results_->remarks()) std::printf("note: %s\n", remark.c_str());
  });
}

void Recorder::checkpoint(const step::State& state, const step::Progress& at)
{
  io::Checkpoint now;
  now.state = step::archived(state, model_->space);
  base::on_root(model_->space.comm(), [&] {
    const step::TimeSettings& time = model_->scene.time;
    now.version = build_description();
    now.options = options_;
    now.time = {state.t, time.step, time.end, at.nominal, at.accepted};
    for (const auto& [name, count] : model_->ledger.entries())
      now.ledger.emplace_back(std::string(name), count);
    results_->fill_in(now);
    io::write_checkpoint(results_->folder(), now);
  });
}

void Recorder::record(const step::State& state, const step::StepReport& report, int step,
                      double seconds, bool with_fields)
{
  const fem::Space& space = model_->space;
  const OutputSettings& output = *output_;
  const double build_seconds = space.comm().max(report.compliance.seconds);
  std::vector<io::Field> fields;
  // Without output fields nothing is gathered and no field file is made.
  if (with_fields && output.fields()) {
    const fem::GlobalField u = space.gather(state.tissue.u);
    if (output.displacement) fields.push_back(nodal_field("/displacement", "m", u));
    if (output.velocity)
      fields.push_back(nodal_field("/velocity", "m/s", space.gather(state.tissue.v)));
    for (auto& field : post::stress_fields(*model_, state, output.stress))
      fields.push_back(std::move(field));
    for (auto& field : coupling_fields(*model_, state, u)) fields.push_back(std::move(field));
    if (output.contact)
      for (auto& field : contact_fields(*model_, report)) fields.push_back(std::move(field));
  }
  base::on_root(space.comm(), [&] {
    const Moment now{*model_, state, report, build_seconds, seconds};
    std::vector<std::vector<double>> row;
    for (const History& history : histories_) row.push_back(history.values(now));
    results_->append_history(row, model_->ledger);
    if (fields.empty()) return;
    std::vector<std::string> notes;
    if (report.nonunique) notes.emplace_back("lambda_nonunique");
    results_->write_fields(step, state.t, fields, needle_curves(*model_, state), notes);
  });
}

void Recorder::table(const std::string& path, const std::vector<double>& values,
                     const std::string& units)
{
  base::on_root(model_->space.comm(), [&] { results_->write_table(path, values, units); });
}

void Recorder::close()
{
  base::on_root(model_->space.comm(), [&] { results_->close(); });
}

}  // namespace trocar::driver
