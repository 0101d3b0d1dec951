#include "driver/cavity_options.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/words.hpp"
#include "driver/boundary_options.hpp"
#include "driver/network_options.hpp"
#include "driver/option_source.hpp"
#include "mesh/hollow.hpp"

namespace trocar::driver {
namespace {

using core::Options;

core::Failure bad(const std::string& option, const std::string& name, const std::string& why)
{
  return core::option_error("option -" + option + " of '" + name + "': " + why);
}

law::MonotoneSpline read_table(const std::string& file, const std::string& name,
                               const base::Comm& comm)
{
  if (file.empty()) throw bad("cavity_table", name, "law table needs a CSV file");
  const core::Csv table = read_csv(file, comm);
  if (table.columns != std::vector<std::string>{"pressure", "volume"})
    throw core::data_error(file + ": columns must be pressure,volume");
  if (table.rows.size() < 2) throw core::data_error(file + ": two rows at least");
  std::vector<double> p, v;
  for (const auto& row : table.rows) {
    if (!p.empty() && row[0] <= p.back())
      throw core::data_error(file + ": pressures must rise from row to row");
    if (!v.empty() && row[1] > v.back())
      throw core::data_error(file + ": a fluid's volume cannot rise with its pressure (at " +
                             core::shown(row[0]) + " Pa)");
    p.push_back(row[0]);
    v.push_back(row[1]);
  }
  return {p, v};
}

void read_law(Options& options, cavity::CavitySettings& one, const base::Comm& comm)
{
  using Kind = law::FluidLaw::Kind;
  const std::string law = options.text("cavity_<cavity>_law", one.name);
  const std::map<std::string, Kind> kinds{{"constant_volume", Kind::constant_volume},
                                          {"pressure", Kind::pressure},
                                          {"pulse", Kind::pressure},
                                          {"bulk", Kind::bulk},
                                          {"gas", Kind::gas},
                                          {"table", Kind::table}};
  one.fluid.kind = kinds.at(law);
  // Refuses an option of another law: it would have no effect.
  const auto number = [&](const std::string& option, const std::vector<std::string>& laws) {
    const std::string full = "cavity_<cavity>_" + option;
    if (options.given_for(full, one.name) && std::find(laws.begin(), laws.end(), law) == laws.end())
      throw bad("cavity_" + option, one.name, "law " + law + " does not know it");
    return options.real(full, one.name);
  };
  const double pressure = number("pressure", {"pressure"}), mean = number("mean", {"pulse"});
  one.pressure.mean = law == "pulse" ? mean : pressure;
  const double amplitude = number("amplitude", {"pulse"});
  one.pressure.period = number("period", {"pulse"});
  if (law == "pulse") one.pressure.amplitude = amplitude;
  one.fluid.bulk_modulus = number("bulk_modulus", {"bulk"});
  one.fluid.ambient = number("ambient_pressure", {"gas"});
  one.volume = number("volume", {"constant_volume", "bulk", "gas"});
  const double initial = number("initial_pressure", {"constant_volume", "bulk", "gas", "table"});
  if (options.given("cavity_<cavity>_initial_pressure", one.name) &&
      one.fluid.kind != Kind::pressure)
    one.initial_pressure = initial;
  if (one.initial_pressure && one.fluid.kind == Kind::gas && initial <= -0.9 * one.fluid.ambient)
    throw bad("cavity_initial_pressure", one.name, "next to a vacuum: no gas stands that");
  if (one.initial_pressure && one.volume > 0.0)
    throw bad("cavity_volume", one.name, "the amount follows from the initial pressure already");
  const std::string table = options.text("cavity_<cavity>_table", one.name);
  if (law == "table")
    one.fluid.table = read_table(table, one.name, comm);
  else if (options.given_for("cavity_<cavity>_table", one.name))
    throw bad("cavity_table", one.name, "law " + law + " does not know it");
}

/// Reads the factor over time of a cavity. It scales a given pressure, or else the amount of fluid.
void read_scale(Options& options, cavity::CavitySettings& one, const base::Comm& comm)
{
  const auto curve = read_curve(options.text("cavity_<cavity>_curve", one.name), comm);
  (one.fluid.kind == law::FluidLaw::Kind::pressure ? one.pressure.curve : one.volume_curve) = curve;
  if (one.initial_pressure && one.volume_curve && core::interpolate(*curve, 1, 0.0) != 1.0)
    throw bad("cavity_curve", one.name, "beside an initial pressure it must begin with 1");
}

/// Names of the volumes of nonlinear tissue that have a face on the wall.
std::vector<std::string> bending_volumes(const Scenario& scenario, const std::string& surface)
{
  const mesh::Mesh& mesh = scenario.mesh;
  std::set<int> wall;
  for (int node : mesh::group_nodes(mesh, surface)) wall.insert(node);
  std::set<std::string> names;
  for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const auto volume = static_cast<std::size_t>(mesh.region[tet]);
    if (scenario.tissue.model_of(volume) == tissue::Model::linear) continue;
    const auto& nodes = mesh.tets[tet];
    if (std::count_if(nodes.begin(), nodes.end(), [&](int n) { return wall.contains(n); }) >= 3)
      names.insert(mesh.volumes[volume]);
  }
  return {names.begin(), names.end()};
}

/// Models `linear` and `frozen` load the undeformed wall, so the tissue at the wall must be linear.
/// Model `frozen` also reuses the responses to a unit pressure while the operator is the same, so
/// all tissue must be linear. Failure (64).
void require_linear_tissue(const Scenario& scenario, const cavity::CavitySettings& one,
                           const std::string& model)
{
  const std::vector<std::string> bending = bending_volumes(scenario, one.surface);
  if (!bending.empty())
    throw bad("cavity_model", one.name,
              model + " needs linear tissue round its wall, not as in volume '" + bending.front() +
                  "' (-tissue_model linear, -tissue_" + bending.front() + "_model linear)");
  if (one.model == cavity::Model::frozen && !scenario.tissue.all_linear())
    throw bad("cavity_model", one.name, "frozen needs -tissue_model linear in all volumes");
}

void read_model(Options& options, cavity::CavitySettings& one, const Scenario& scenario)
{
  const std::map<std::string, cavity::Model> models{{"linear", cavity::Model::linear},
                                                    {"frozen", cavity::Model::frozen},
                                                    {"follower", cavity::Model::follower}};
  const std::string model = options.text("cavity_<cavity>_model", one.name);
  const std::string solver = options.text("cavity_<cavity>_solver", one.name);
  one.model = models.at(model);
  if (one.model != cavity::Model::follower) require_linear_tissue(scenario, one, model);
  if (one.model != cavity::Model::frozen && solver != "auto" && solver != "newton")
    throw bad("cavity_solver", one.name, solver + " is for model frozen only, not " + model);
  if (one.model == cavity::Model::frozen)
    one.solver = solver == "proportional" ? cavity::Solver::proportional
                 : solver == "newton"     ? cavity::Solver::newton
                                          : cavity::Solver::exact;
  one.gain = options.real("cavity_<cavity>_gain", one.name);
  if (options.given_for("cavity_<cavity>_gain", one.name) && solver != "proportional")
    throw bad("cavity_gain", one.name, "only -cavity_solver proportional has a gain");
  if (options.given_for("cavity_<cavity>_max_updates", one.name) &&
      one.model != cavity::Model::frozen)
    throw bad("cavity_max_updates", one.name, "only model frozen updates pressures");
  one.tolerance = options.real("cavity_<cavity>_tolerance", one.name);
  one.most_updates = options.integer("cavity_<cavity>_max_updates", one.name);
}

std::string wall_of(Options& options, const std::string& name)
{
  const std::string surface = options.text("cavity_<cavity>_surface", name);
  const std::string region = options.text("cavity_<cavity>_region", name);
  if (surface.empty() == region.empty())
    throw bad("cavity_surface", name,
              "give either a surface or a volume to be taken out (-cavity_<n>_region)");
  return surface.empty() ? region : surface;
}

/// Either all cavities are frozen or none, and frozen cavities share one solver: a single search
/// finds all their pressures outside the constraint system. Failure (64).
void require_one_way(const std::vector<cavity::CavitySettings>& cavities)
{
  const cavity::CavitySettings* frozen = nullptr;
  for (const auto& one : cavities)
    if (one.model == cavity::Model::frozen) frozen = &one;
  if (!frozen) return;
  for (const auto& one : cavities) {
    if (one.model != frozen->model)
      throw bad("cavity_model", one.name,
                "the cavities of a scene are all frozen or none ('" + frozen->name + "' is)");
    if (one.solver != frozen->solver)
      throw bad("cavity_solver", one.name,
                "frozen cavities share one solver ('" + frozen->name + "' has another)");
  }
}

void read_pv_curve(Options& options, Scenario& scenario)
{
  post::PvSettings pv;
  const std::string name = options.text("pv_cavity");
  pv.low = options.real("pv_low");
  pv.high = options.real("pv_high");
  pv.points = options.integer("pv_points");
  pv.pieces = options.integer("pv_pieces");
  const auto& cavities = scenario.cavities.cavities;
  const bool swept = options.text("analysis") == "pv_curve";
  for (const char* option : {"pv_cavity", "pv_low", "pv_high", "pv_points", "pv_pieces"})
    if (options.given(option) && !swept)
      throw core::option_error("option -" + std::string(option) + ": is for -analysis pv_curve");
  if (!swept) return;
  if (cavities.empty())
    throw core::option_error("option -analysis pv_curve: the scene has no cavity (-cavities)");
  if (!name.empty()) pv.cavity = cavity_index(cavities, name, "pv_cavity");
  if (pv.cavity < 0) throw core::option_error("option -pv_cavity: outside has no volume");
  if (!(pv.low < 1.0) || !(pv.high > 1.0))
    throw core::option_error("option -pv_low, -pv_high: the curve goes from below 1 to above it");
  scenario.pv = pv;
}

}  // namespace

mesh::Mesh with_cavities_hollow(Options& options, mesh::Mesh mesh)
{
  for (const std::string& name : options.new_names("cavities")) {
    wall_of(options, name);
    const std::string region = options.text("cavity_<cavity>_region", name);
    if (!region.empty()) mesh = mesh::hollow(mesh, region);
  }
  return mesh;
}

void read_cavities(Options& options, Scenario& scenario, const base::Comm& comm)
{
  std::vector<cavity::CavitySettings>& cavities = scenario.cavities.cavities;
  for (const std::string& name : options.new_names("cavities")) {
    if (name == "outside")
      throw core::option_error("option -cavities: 'outside' is the world's name");
    cavity::CavitySettings one;
    one.name = name;
    one.surface = wall_of(options, name);
    mesh::surface_group(scenario.mesh, one.surface);
    one.caps = options.flag("cavity_<cavity>_cap", name);
    read_law(options, one, comm);
    read_scale(options, one, comm);
    read_model(options, one, scenario);
    const double density = options.real("cavity_<cavity>_density", name);
    one.weight = density * scenario.tissue.boundary.gravity;
    if (density > 0.0 && one.weight.isZero(0.0))
      throw bad("cavity_density", name, "without -gravity the fluid weighs nothing");
    one.alarm = options.real("cavity_<cavity>_alarm", name);
    cavities.push_back(std::move(one));
  }
  require_one_way(cavities);
  if (!cavities.empty() && scenario.tissue.reuse == solve::Reuse::stale)
    throw core::option_error(
        "option -compliance_reuse stale: not with cavities, whose volumes would be missed");
  read_network(options, scenario, comm);
  read_pv_curve(options, scenario);
  for (const auto& one : cavities) {
    const bool curved = one.volume_curve && core::interpolate(*one.volume_curve, 1, 0.0) != 1.0;
    if (one.initial_pressure || one.volume > 0.0 || curved)
      scenario.time.start_in_equilibrium = true;
    const bool iterative =
        scenario.laws.method == law::Method::pgs || scenario.laws.method == law::Method::hybrid;
    if (one.model == cavity::Model::follower && iterative)
      throw core::option_error(
          "option -constraint_solver: follower cavities need rows that are met exactly: auto, "
          "active_set or interior_point");
  }
}

}  // namespace trocar::driver
