#include "driver/history.hpp"

#include <algorithm>
#include <string>

namespace trocar::driver {
namespace {

using core::Vec3;

/// Collects the histories: name, unit and the function that gives the values.
class List
{
 public:
  template <class Value>
  void number(const std::string& name, const std::string& unit, const Value& value)
  {
    list_.push_back({{name, 0, unit}, [value](const Moment& now) {
                       return std::vector<double>{static_cast<double>(value(now))};
                     }});
  }
  template <class Value>
  void vector(const std::string& name, const std::string& unit, const Value& value)
  {
    list_.push_back({{name, 3, unit}, [value](const Moment& now) {
                       const Vec3 v = value(now);
                       return std::vector<double>{v.x(), v.y(), v.z()};
                     }});
  }
  /// Gives the last history its former name, for readers of older files.
  void keep_name(const std::string& old) { list_.back().series.old_name = old; }
  std::vector<History> take() { return std::move(list_); }

 private:
  std::vector<History> list_;
};

void add_needle(const std::string& name, std::size_t i, List& list)
{
  const std::string at = "needle/" + name + "/";
  const auto report = [i](const Moment& now) -> const step::NeedleReport& {
    return now.report.needles[i];
  };
  const auto insertion = [i](const Moment& now) -> const insertion::InsertionState& {
    return now.state.insertions[i];
  };
  list.vector(at + "tip", "m", [=](const Moment& now) { return report(now).tip; });
  list.number(at + "depth", "m", [=](const Moment& now) { return report(now).depth; });
  list.number(at + "travel", "m", [i](const Moment& now) { return now.state.needles[i].travel; });
  list.vector(at + "base_force", "N", [=](const Moment& now) { return report(now).base.force; });
  list.vector(at + "base_moment", "N m",
              [=](const Moment& now) { return report(now).base.moment; });
  list.number(at + "shaft_friction", "N",
              [=](const Moment& now) { return report(now).coupling.shaft_friction; });
  list.number(at + "tip_force", "N",
              [=](const Moment& now) { return report(now).coupling.tip_force; });
  list.number(at + "friction_work", "J",
              [=](const Moment& now) { return report(now).coupling.friction_work; });
  list.number(at + "cutting_work", "J",
              [=](const Moment& now) { return report(now).coupling.cutting_work; });
  list.number(at + "punctures", "1",
              [=](const Moment& now) { return insertion(now).tip.punctures; });
  list.number(at + "points", "1", [=](const Moment& now) { return insertion(now).points.size(); });
  list.number(at + "slipping", "1", [=](const Moment& now) {
    const auto& points = insertion(now).points;
    return std::count_if(points.begin(), points.end(), [](const auto& p) { return !p.stuck; });
  });
}

void add_cavity(const std::string& name, std::size_t i, List& list)
{
  const std::string at = "cavity/" + name + "/";
  const auto report = [i](const Moment& now) -> const cavity::CavityReport& {
    return now.report.cavities[i];
  };
  list.number(at + "pressure", "Pa", [=](const Moment& now) { return report(now).pressure; });
  list.number(at + "volume", "m^3", [=](const Moment& now) { return report(now).volume; });
  list.number(at + "volume_error", "1", [=](const Moment& now) { return report(now).error; });
  list.number(at + "iterations", "1", [=](const Moment& now) { return report(now).iterations; });
  list.number(at + "alarm", "1", [=](const Moment& now) { return report(now).alarm ? 1 : 0; });
}

void add_contact(const std::string& name, std::size_t p, List& list)
{
  const std::string at = "contact/" + name + "/";
  const auto report = [p](const Moment& now) -> const contact::PairReport& {
    return now.report.contact[p];
  };
  list.vector(at + "force", "N", [=](const Moment& now) { return report(now).force; });
  list.number(at + "area", "m^2", [=](const Moment& now) { return report(now).area; });
  list.number(at + "weighted_gap", "m",
              [=](const Moment& now) { return report(now).weighted_gap; });
  list.number(at + "largest_penetration", "m",
              [=](const Moment& now) { return report(now).largest_penetration; });
  list.number(at + "sticking", "1", [=](const Moment& now) { return report(now).sticking; });
  list.number(at + "slipping", "1", [=](const Moment& now) { return report(now).slipping; });
}

void add_conduit(const std::string& name, std::size_t e, List& list)
{
  const auto conduit = [e](const Moment& now) -> const cavity::ConduitState& {
    return now.state.cavities.conduit[e];
  };
  const auto add = [&](const char* what, const char* unit, const auto& value) {
    list.number("conduit/" + name + "/" + what, unit, value);
    list.keep_name("edge/" + name + "/" + what);
  };
  add("flow", "m^3/s", [=](const Moment& now) { return conduit(now).flow; });
  add("moved", "m^3", [=](const Moment& now) { return conduit(now).moved; });
  add("state", "1", [=](const Moment& now) {
    return conduit(now).needle_in ? 2 : conduit(now).pierced ? 1 : 0;
  });
}

void add_holders(const tissue::BoundaryConditions& boundary, List& list)
{
  for (std::size_t k = 0; k < boundary.displacements.size(); ++k)
    list.vector("boundary/" + boundary.displacements[k].group + "/force", "N",
                [k](const Moment& now) { return now.report.holders.tools[k]; });
  for (std::size_t k = 0; k < boundary.fixed.size(); ++k)
    list.vector("fix/" + boundary.fixed[k].group + "/force", "N",
                [k](const Moment& now) { return now.report.holders.supports[k]; });
}

void add_energy(bool touches, List& list)
{
  using Account = step::EnergyAccount;
  const auto add = [&](const char* name, double Account::*part) {
    list.number(std::string("energy/") + name, "J",
                [part](const Moment& now) { return now.state.energy.*part; });
  };
  add("elastic", &Account::elastic);
  add("kinetic", &Account::kinetic);
  add("supplied", &Account::supplied);
  add("friction", &Account::friction);
  add("cutting", &Account::cutting);
  add("damping", &Account::damping);
  if (touches) add("contact", &Account::contact);
  if (touches) add("contact_friction", &Account::contact_friction);
  list.number("energy/rest", "J", [](const Moment& now) { return now.state.energy.rest(); });
}

/// Least distance along a path between neighbouring coupling points, over all needles [m]; 0 when
/// no needle has two points.
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

void add_constraints(List& list)
{
  const auto add = [&](const char* name, const char* unit, auto part) {
    list.number(std::string("constraint/") + name, unit,
                [part](const Moment& now) { return now.report.*part; });
  };
  using Report = step::StepReport;
  add("rows", "1", &Report::rows);
  add("rank", "1", &Report::rank);
  add("iterations", "1", &Report::iterations);
  add("residual", "m", &Report::residual);
  add("condition", "1", &Report::condition);
  add("outer", "1", &Report::outer);
  add("contraction", "1", &Report::contraction);
  list.number("constraint/smallest_gap", "m",
              [](const Moment& now) { return smallest_gap(now.state); });
}

void add_compared(const std::string& name, std::size_t i, List& list)
{
  const auto add = [&](const char* what, const char* unit, auto part) {
    list.number("constraint/compare/" + name + "/" + what, unit, [i, part](const Moment& now) {
      const auto& trials = now.report.trials;
      return trials.empty() ? law::BenchmarkResult{}.*part : trials[i].*part;
    });
  };
  add("iterations", "1", &law::BenchmarkResult::iterations);
  add("failures", "1", &law::BenchmarkResult::failures);
  add("residual", "m", &law::BenchmarkResult::residual);
  add("seconds", "s", &law::BenchmarkResult::seconds);
  add("factor_seconds", "s", &law::BenchmarkResult::factor_seconds);
}

/// Histories of the cost of a step, and of what its iterations leave unsolved.
void add_work(List& list)
{
  list.number("compliance/probes", "1",
              [](const Moment& now) { return now.report.compliance.probes; });
  list.number("compliance/new_probes", "1",
              [](const Moment& now) { return now.report.compliance.built; });
  list.number("compliance/reused_probes", "1",
              [](const Moment& now) { return now.report.compliance.reused; });
  list.number("compliance/build_seconds", "s", [](const Moment& now) { return now.build_seconds; });
  list.number("compliance/passes", "1", [](const Moment& now) { return now.report.passes; });
  list.number("compliance/factor_age", "1",
              [](const Moment& now) { return now.model.tissue.factor().age().uses; });
  list.number("compliance/leftover_gap", "m",
              [](const Moment& now) { return now.report.leftover_gap; });
  list.number("compliance/stale_error", "m",
              [](const Moment& now) { return now.report.stale_error; });
  list.number("time_linearisations", "1",
              [](const Moment& now) { return now.report.linearisations; });
  list.number("time_residual", "1", [](const Moment& now) { return now.report.unbalanced; });
  list.number("step_seconds", "s", [](const Moment& now) { return now.seconds; });
}

}  // namespace

std::vector<History> histories(const Scenario& scenario)
{
  List list;
  list.number("time", "s", [](const Moment& now) { return now.state.t; });
  for (std::size_t i = 0; i < scenario.needles.size(); ++i)
    add_needle(scenario.needles[i].name, i, list);
  for (std::size_t i = 0; i < scenario.cavities.cavities.size(); ++i)
    add_cavity(scenario.cavities.cavities[i].name, i, list);
  for (std::size_t e = 0; e < scenario.cavities.conduits.size(); ++e)
    add_conduit(scenario.cavities.conduits[e].name, e, list);
  for (std::size_t p = 0; p < scenario.contact.pairs.size(); ++p)
    add_contact(scenario.contact.pairs[p].name, p, list);
  add_holders(scenario.tissue.boundary, list);
  if (scenario.energy) add_energy(!scenario.contact.pairs.empty(), list);
  add_constraints(list);
  for (std::size_t i = 0; i < scenario.compare.size(); ++i)
    add_compared(scenario.compare[i].name, i, list);
  add_work(list);
  return list.take();
}

}  // namespace trocar::driver
