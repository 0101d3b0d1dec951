#include "driver/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/csv.hpp"
#include "core/words.hpp"
#include "driver/boundary_options.hpp"
#include "driver/cavity_options.hpp"
#include "driver/compliance_options.hpp"
#include "driver/contact_options.hpp"
#include "driver/insertion_options.hpp"
#include "driver/needle_options.hpp"
#include "driver/option_source.hpp"
#include "driver/restart.hpp"
#include "driver/scenario_checks.hpp"
#include "driver/time_options.hpp"
#include "io/gmsh_reader.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::driver {
namespace {

using core::Options;
using core::Vec3;

tissue::Model model_named(const std::string& name)
{
  const std::map<std::string, tissue::Model> models{{"linear", tissue::Model::linear},
                                                    {"corotational", tissue::Model::corotational},
                                                    {"neo_hookean", tissue::Model::neo_hookean}};
  return models.at(name);
}

std::vector<tissue::Material> read_materials(Options& options, const mesh::Mesh& mesh)
{
  std::vector<tissue::Material> materials;
  for (const std::string& volume : mesh.volumes) {
    tissue::Material m;
    m.model = model_named(options.text("tissue_<volume>_model", volume));
    m.young = options.real("tissue_<volume>_young", volume);
    m.poisson = options.real("tissue_<volume>_poisson", volume);
    m.density = options.real("tissue_<volume>_density", volume);
    m.rayleigh_mass = options.real("tissue_<volume>_rayleigh_mass", volume);
    m.rayleigh_stiffness = options.real("tissue_<volume>_rayleigh_stiffness", volume);
    materials.push_back(m);
  }
  return materials;
}

/// With -tissue_element auto, quadratic tets share their dilatation above this Poisson's ratio.
/// Below it they lock only a little, and sharing would make the matrix wider (docs/studies.md).
constexpr double shared_from = 0.49;

/// Makes the mesh linear or quadratic, as `element` says, and returns how the elements compute
/// their dilatation.
tissue::Dilatation shape_elements(std::string element,
                                  const std::vector<tissue::Material>& materials, mesh::Mesh& mesh)
{
  const auto any_above = [&](double lambda_over_mu) {
    return std::any_of(materials.begin(), materials.end(), [&](const tissue::Material& m) {
      return m.lambda() > lambda_over_mu * m.mu();
    });
  };
  if (element == "auto")
    element = any_above(2.0 * shared_from / (1.0 - 2.0 * shared_from)) ? "p2_anp" : "p2";
  element[1] == '1' ? mesh::make_linear(mesh) : mesh::make_quadratic(mesh);
  if (element == "p1_anp") return tissue::Dilatation::nodal;
  if (element == "p2_anp" && any_above(tissue::most_at_point)) return tissue::Dilatation::nodal;
  return element == "p2_bbar" ? tissue::Dilatation::element : tissue::Dilatation::pointwise;
}

tissue::TissueSettings read_tissue(Options& options, std::vector<tissue::Material> materials,
                                   const mesh::Mesh& mesh, const base::Comm& comm)
{
  tissue::TissueSettings settings;
  settings.model = model_named(options.text("tissue_model"));
  const std::map<std::string, tissue::Tangent> tangents{{"auto", tissue::Tangent::automatic},
                                                        {"rotated", tissue::Tangent::rotated},
                                                        {"exact", tissue::Tangent::exact}};
  settings.tangent = tangents.at(options.text("tissue_tangent"));
  settings.allow_inversion = options.flag("tissue_allow_inversion");
  settings.newton_tolerance = options.real("newton_tolerance");
  settings.mass =
      options.text("tissue_mass") == "lumped" ? tissue::Mass::lumped : tissue::Mass::consistent;
  settings.materials = std::move(materials);
  settings.boundary = read_boundary(options, mesh, comm);
  return settings;
}

const std::map<std::string, law::Method> methods{{"auto", law::Method::automatic},
                                                 {"pgs", law::Method::pgs},
                                                 {"hybrid", law::Method::hybrid},
                                                 {"active_set", law::Method::active_set},
                                                 {"interior_point", law::Method::interior_point}};

law::Settings read_laws(Options& options)
{
  law::Settings laws;
  laws.method = methods.at(options.text("constraint_solver"));
  laws.norm = options.text("constraint_norm") == "step" ? law::Norm::step : law::Norm::residual;
  laws.tolerance = options.real("constraint_tolerance");
  laws.max_iterations = options.integer("constraint_max_iterations");
  return laws;
}

/// Reads METHOD[:NORM[:TOLERANCE]] of -constraint_compare. Omitted parts are taken from the solver
/// of the run. Failure (64).
law::BenchmarkCase read_contender(const std::string& entry, const law::Settings& laws)
{
  const std::vector<std::string> words = core::split(entry, ':');
  law::BenchmarkCase contender{entry, laws};
  const auto bad = [&](const std::string& why) {
    return core::option_error("option -constraint_compare: '" + entry + "': " + why);
  };
  const auto method = words.empty() ? methods.end() : methods.find(words[0]);
  if (method == methods.end()) throw bad("no such solver");
  contender.settings.method = method->second;
  if (words.size() > 1) {
    if (words[1] != "step" && words[1] != "residual") throw bad("the norm is residual or step");
    contender.settings.norm = words[1] == "step" ? law::Norm::step : law::Norm::residual;
  }
  if (words.size() > 2) {
    std::istringstream text(words[2]);
    if (!(text >> contender.settings.tolerance) || !text.eof() ||
        !(contender.settings.tolerance > 0.0) || words.size() > 3)
      throw bad("the tolerance is a positive number [m]");
  }
  return contender;
}

std::vector<law::BenchmarkCase> read_compare(Options& options, const law::Settings& laws)
{
  std::vector<law::BenchmarkCase> contenders;
  for (const std::string& entry : options.names("constraint_compare"))
    contenders.push_back(read_contender(entry, laws));
  return contenders;
}

OutputSettings read_output(Options& options)
{
  OutputSettings output;
  output.folder = options.text("output_dir");
  if (output.folder.empty())
    throw core::option_error("option -output_dir: the name of a folder is missing");
  output.every = options.integer("output_every");
  output.quiet = options.flag("quiet");
  output.error_target = options.real("error_target");
  constexpr double least_target = 1e-6;  // a smaller error would be lost in round-off
  if (output.error_target > 0.0 && output.error_target < least_target)
    throw core::option_error("option -error_target: " + core::shown(output.error_target) +
                             " is below 1e-6, which no estimate can tell");
  output.locking_gauge = options.flag("locking_gauge");
  output.size_field = options.text("error_size_field");
  if (!output.size_field.empty() && !(output.error_target > 0.0))
    throw core::option_error(
        "option -error_size_field: sizes are for a target of the error; give -error_target");
  output.error_estimate = options.flag("error_estimate") || output.error_target > 0.0;
  output.displacement = false;
  const std::map<std::string, bool*> fields{{"displacement", &output.displacement},
                                            {"velocity", &output.velocity},
                                            {"contact", &output.contact},
                                            {"stress", &output.stress.stress},
                                            {"von_mises", &output.stress.von_mises},
                                            {"principal_stress", &output.stress.principal_stress},
                                            {"strain_energy", &output.stress.strain_energy},
                                            {"nodal_stress", &output.stress.nodal_stress}};
  std::vector<std::string> known;
  for (const auto& [name, wanted] : fields) known.push_back(name);
  for (const std::string& field : options.names("output_fields")) {
    if (std::find(known.begin(), known.end(), field) == known.end())
      throw core::option_error("option -output_fields: no field '" + field + "'" +
                               core::did_you_mean(field, known));
    *fields.at(field) = true;
  }
  return output;
}

/// Reads the needles. A supernodal factor also gets the nodes on and around their planned paths,
/// which it eliminates last.
void add_needles(Options& options, Scenario& scenario, const base::Comm& comm)
{
  const int layers = options.integer("compliance_tube");
  if (options.new_names("needles").empty()) return;
  const mesh::Locator locator(scenario.mesh);
  scenario.needles = read_needles(options, scenario.mesh, locator, scenario.time.end, comm);
  const solve::Provider provider = scenario.tissue.provider;
  if (provider == solve::Provider::automatic || provider == solve::Provider::supernodal)
    scenario.tissue.ordered_last = planned_nodes(scenario.needles, scenario.mesh, locator, layers);
}

}  // namespace

Scenario read_scenario(Options& options, const base::Comm& comm)
{
  Scenario scenario;
  scenario.time = read_time(options);
  scenario.laws = read_laws(options);
  scenario.compare = read_compare(options, scenario.laws);
  scenario.output = read_output(options);
  scenario.checkpoint = {options.integer("checkpoint_every"), options.real("checkpoint_seconds"),
                         options.real("time_wall")};
  scenario.restart = read_restart_settings(options, scenario.output.folder);
  scenario.energy = options.flag("output_energy");
  scenario.check_only = options.flag("check");
  const std::vector<std::string> files = core::split(options.text("mesh"), ',');
  if (files.empty() || files.front().empty())
    throw core::option_error("option -mesh is missing: a Gmsh file is needed");
  scenario.mesh =
      with_cavities_hollow(options, io::read_gmsh(files, options.real("mesh_scale"), comm));
  std::vector<tissue::Material> materials = read_materials(options, scenario.mesh);
  const tissue::Dilatation dilatation =
      shape_elements(options.text("tissue_element"), materials, scenario.mesh);
  scenario.tissue = read_tissue(options, std::move(materials), scenario.mesh, comm);
  scenario.tissue.dilatation = dilatation;
  scenario.insertion = read_insertion(options, scenario.mesh);
  read_compliance(options, scenario);
  add_needles(options, scenario, comm);
  if (options.flag("insertion_radius_correction")) add_radius_correction(scenario);
  scenario.insertion.line.dilatation = dilatation;
  read_cavities(options, scenario, comm);
  scenario.contact = read_contact(options, scenario.mesh, comm);
  options.refuse_unread();
  check_scenario(scenario);
  return scenario;
}

}  // namespace trocar::driver
