#include "driver/recorder.hpp"

#include <algorithm>
#include <cstdio>

#include "driver/provenance.hpp"
#include "post/stress_fields.hpp"

namespace trocar::driver {
namespace {

using core::Vec3;

void add_energy_series(const Scenario& scenario, std::vector<io::Series>& series)
{
  if (scenario.energy)
    for (const char* name :
         {"elastic", "kinetic", "supplied", "friction", "cutting", "damping", "rest"})
      series.push_back({std::string("energy/") + name, 0, "J"});
}

void add_holder_series(const Scenario& scenario, std::vector<io::Series>& series)
{
  for (const auto& tool : scenario.tissue.boundary.displacements)
    series.push_back({"boundary/" + tool.group + "/force", 3, "N"});
  for (const auto& support : scenario.tissue.boundary.fixed)
    series.push_back({"fix/" + support.group + "/force", 3, "N"});
}

void add_cavity_series(const Scenario& scenario, std::vector<io::Series>& series)
{
  for (const auto& cavity : scenario.cavities.cavities) {
    const std::string at = "cavity/" + cavity.name + "/";
    series.insert(series.end(), {{at + "pressure", 0, "Pa"},
                                 {at + "volume", 0, "m^3"},
                                 {at + "volume_error", 0, "1"},
                                 {at + "iterations", 0, "1"},
                                 {at + "alarm", 0, "1"}});
  }
  for (const auto& edge : scenario.cavities.edges) {
    const std::string at = "edge/" + edge.name + "/";
    series.insert(series.end(),
                  {{at + "flow", 0, "m^3/s"}, {at + "moved", 0, "m^3"}, {at + "state", 0, "1"}});
  }
}

void add_compare_series(const Scenario& scenario, std::vector<io::Series>& series)
{
  for (const law::Contender& contender : scenario.compare) {
    const std::string at = "constraint/compare/" + contender.name + "/";
    series.insert(series.end(), {{at + "iterations", 0, "1"},
                                 {at + "failures", 0, "1"},
                                 {at + "residual", 0, "m"},
                                 {at + "seconds", 0, "s"},
                                 {at + "factor_seconds", 0, "s"}});
  }
}

std::vector<io::Series> series_of(const Scenario& scenario)
{
  std::vector<io::Series> series{{"time", 0, "s"}};
  for (const auto& needle : scenario.needles) {
    const std::string at = "needle/" + needle.name + "/";
    series.insert(series.end(), {{at + "tip", 3, "m"},
                                 {at + "depth", 0, "m"},
                                 {at + "travel", 0, "m"},
                                 {at + "base_force", 3, "N"},
                                 {at + "base_moment", 3, "N m"},
                                 {at + "shaft_friction", 0, "N"},
                                 {at + "tip_force", 0, "N"},
                                 {at + "friction_work", 0, "J"},
                                 {at + "cutting_work", 0, "J"},
                                 {at + "punctures", 0, "1"},
                                 {at + "points", 0, "1"},
                                 {at + "slipping", 0, "1"}});
  }
  add_cavity_series(scenario, series);
  add_holder_series(scenario, series);
  add_energy_series(scenario, series);
  series.insert(series.end(), {{"constraint/rows", 0, "1"},
                               {"constraint/rank", 0, "1"},
                               {"constraint/iterations", 0, "1"},
                               {"constraint/residual", 0, "m"},
                               {"constraint/condition", 0, "1"},
                               {"constraint/outer", 0, "1"},
                               {"constraint/contraction", 0, "1"},
                               {"constraint/smallest_gap", 0, "m"}});
  add_compare_series(scenario, series);
  series.insert(series.end(), {{"compliance/probes", 0, "1"},
                               {"compliance/new_probes", 0, "1"},
                               {"compliance/reused_probes", 0, "1"},
                               {"compliance/build_seconds", 0, "s"},
                               {"compliance/passes", 0, "1"},
                               {"compliance/factor_age", 0, "1"},
                               {"compliance/leftover_gap", 0, "m"},
                               {"compliance/stale_error", 0, "m"},
                               {"time_linearisations", 0, "1"},
                               {"time_residual", 0, "1"},
                               {"step_seconds", 0, "s"}});
  return series;
}

std::vector<double> components(const Vec3& v)
{
  return {v.x(), v.y(), v.z()};
}

/// Least distance along the path between neighbouring coupling points; 0 with fewer than two.
double smallest_gap(const step::State& state)
{
  double smallest = 0.0;
  for (const auto& insertion : state.insertions)
    for (std::size_t k = 1; k < insertion.points.size(); ++k) {
      const double gap = insertion.path.sites[k].arc - insertion.path.sites[k - 1].arc;
      smallest = smallest > 0.0 ? std::min(smallest, gap) : gap;
    }
  return smallest;
}

void append_cavities(const step::State& state, const step::StepReport& report,
                     std::vector<std::vector<double>>& row)
{
  for (const cavity::CavityReport& cavity : report.cavities)
    for (double value : {cavity.pressure, cavity.volume, cavity.error,
                         static_cast<double>(cavity.iterations), cavity.alarm ? 1.0 : 0.0})
      row.push_back({value});
  for (const cavity::EdgeState& edge : state.cavities.edge)
    for (double value : {edge.flow, edge.moved, edge.needle_in ? 2.0 : edge.pierced ? 1.0 : 0.0})
      row.push_back({value});
}

/// What the step took.
void append_work(const step::Simulation& simulation, const step::StepReport& report,
                 double build_seconds, double seconds, std::vector<std::vector<double>>& row)
{
  for (double value :
       {static_cast<double>(report.compliance.probes), static_cast<double>(report.compliance.built),
        static_cast<double>(report.compliance.reused), build_seconds,
        static_cast<double>(report.passes), static_cast<double>(simulation.tissue().factor_age()),
        report.leftover_gap, report.stale_error, static_cast<double>(report.linearisations),
        report.unbalanced, seconds})
    row.push_back({value});
}

void append_needles(const step::State& state, const step::StepReport& report,
                    std::vector<std::vector<double>>& row)
{
  for (std::size_t i = 0; i < state.needles.size(); ++i) {
    const step::NeedleReport& needle = report.needles[i];
    const auto& points = state.insertions[i].points;
    const auto slipping =
        std::count_if(points.begin(), points.end(), [](const auto& p) { return !p.stuck; });
    row.insert(row.end(), {components(needle.tip),
                           {needle.depth},
                           {state.needles[i].travel},
                           components(needle.base.force),
                           components(needle.base.moment),
                           {needle.coupling.shaft_friction},
                           {needle.coupling.tip_force},
                           {needle.coupling.friction_work},
                           {needle.coupling.cutting_work},
                           {static_cast<double>(state.insertions[i].tip.punctures)},
                           {static_cast<double>(points.size())},
                           {static_cast<double>(slipping)}});
  }
}

std::vector<std::vector<double>> history_row(const step::Simulation& simulation,
                                             const step::State& state,
                                             const step::StepReport& report, double build_seconds,
                                             double seconds)
{
  std::vector<std::vector<double>> row{{state.t}};
  append_needles(state, report, row);
  append_cavities(state, report, row);
  for (const auto* forces : {&report.holders.tools, &report.holders.supports})
    for (const Vec3& force : *forces) row.push_back(components(force));
  if (simulation.scene().energy) {
    const step::EnergyAccount& e = state.energy;
    for (double value :
         {e.elastic, e.kinetic, e.supplied, e.friction, e.cutting, e.damping, e.rest()})
      row.push_back({value});
  }
  for (double value : {static_cast<double>(report.rows), static_cast<double>(report.rank),
                       static_cast<double>(report.iterations), report.residual, report.condition,
                       static_cast<double>(report.outer), report.contraction, smallest_gap(state)})
    row.push_back({value});
  for (std::size_t i = 0; i < simulation.scene().compare.size(); ++i) {
    const law::Trial trial = report.trials.empty() ? law::Trial{} : report.trials[i];
    for (double value : {static_cast<double>(trial.iterations), static_cast<double>(trial.failures),
                         trial.residual, trial.seconds, trial.factor_seconds})
      row.push_back({value});
  }
  append_work(simulation, report, build_seconds, seconds, row);
  return row;
}

io::Field nodal_field(const std::string& name, const std::string& units,
                      const fem::GlobalField& field)
{
  return {name, 3,    units, {field.value.data(), field.value.data() + field.value.size()},
          true, false};
}

/// Coupling points of all needles, one row each; ids are needle · 10⁶ + site.
std::vector<io::Field> coupling_fields(const step::Simulation& simulation, const step::State& state,
                                       const fem::GlobalField& u)
{
  io::Field id{"/coupling/id", 0, "1", {}, false, true};
  io::Field position{"/coupling/position", 3, "m", {}, false, false};
  io::Field lambda{"/coupling/lambda", 3, "N", {}, false, false};
  io::Field stuck{"/coupling/state", 0, "1", {}, false, true};
  io::Field tributary{"/coupling/tributary", 0, "m", {}, false, false};
  for (std::size_t n = 0; n < state.insertions.size(); ++n) {
    const auto& insertion = state.insertions[n];
    const core::VecX lengths = simulation.tributary(insertion).rowwise().sum();
    for (std::size_t k = 0; k < insertion.points.size(); ++k) {
      const auto& point = insertion.points[k];
      const auto& anchor = insertion.path.sites[static_cast<std::size_t>(point.site)].anchor;
      const Vec3 x = anchor.mean([&](int node) -> Vec3 {
        return simulation.scene().mesh.x[static_cast<std::size_t>(node)] + u.node(node);
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

/// Every needle's axis, so that a picture needs no model of the needle.
std::vector<io::Curve> needle_curves(const step::Simulation& simulation, const step::State& state)
{
  std::vector<io::Curve> curves;
  for (std::size_t n = 0; n < state.needles.size(); ++n) {
    const needle::NeedleSettings& needle = simulation.scene().needles[n];
    io::Curve curve{"/needle/" + needle.name, {}, needle.section.outer};
    for (const Vec3& x : state.needles[n].shaft.x)
      curve.points.insert(curve.points.end(), x.data(), x.data() + 3);
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace

Recorder::Recorder(const step::Simulation& simulation, const Scenario& scenario,
                   const Invocation& invocation, const std::vector<core::ResolvedOption>& options)
    : simulation_(&simulation), output_(&scenario.output)
{
  const std::string solver = simulation.tissue().describe_solver();
  base::on_root(simulation.space().comm(), [&] {
    results_.emplace(scenario.output.folder, scenario.mesh,
                     provenance(simulation, invocation, options, solver), series_of(scenario),
                     static_cast<std::size_t>(step::step_count(scenario.time)) + 1);
    if (!results_->remark().empty()) std::printf("note: %s\n", results_->remark().c_str());
  });
}

void Recorder::record(const step::State& state, const step::StepReport& report, int step,
                      double seconds, bool with_fields)
{
  const fem::Space& space = simulation_->space();
  const OutputSettings& output = *output_;
  const double build_seconds = space.comm().max(report.compliance.seconds);
  std::vector<io::Field> fields;
  // Without output fields nothing is gathered and no field file is made.
  if (with_fields && (output.displacement || output.velocity || output.stress.any())) {
    const fem::GlobalField u = space.gather(state.tissue.u);
    if (output.displacement) fields.push_back(nodal_field("/displacement", "m", u));
    if (output.velocity)
      fields.push_back(nodal_field("/velocity", "m/s", space.gather(state.tissue.v)));
    for (auto& field : post::stress_fields(*simulation_, state, output.stress))
      fields.push_back(std::move(field));
    for (auto& field : coupling_fields(*simulation_, state, u)) fields.push_back(std::move(field));
  }
  base::on_root(space.comm(), [&] {
    results_->append_history(history_row(*simulation_, state, report, build_seconds, seconds),
                             simulation_->ledger());
    if (fields.empty()) return;
    std::vector<std::string> notes;
    if (report.nonunique) notes.emplace_back("lambda_nonunique");
    results_->write_fields(step, state.t, fields, needle_curves(*simulation_, state), notes);
  });
}

void Recorder::table(const std::string& path, const std::vector<double>& values,
                     const std::string& units)
{
  base::on_root(simulation_->space().comm(), [&] { results_->write_table(path, values, units); });
}

void Recorder::close()
{
  base::on_root(simulation_->space().comm(), [&] { results_->close(); });
}

}  // namespace trocar::driver
