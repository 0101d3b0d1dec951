#include "driver/scenario_checks.hpp"

#include <string>

#include "core/words.hpp"

namespace trocar::driver {
namespace {

void refuse_dashpots_without_time(const Scenario& scenario)
{
  if (!scenario.time.is_static || scenario.time.end > 0.0) return;
  for (const auto& friction : scenario.insertion.friction)
    if (friction.advance.viscous > 0.0 || friction.withdraw.viscous > 0.0)
      throw core::option_error(
          "option -insertion_friction_viscous: one static equilibrium takes no time; give "
          "-time_end for a quasi-static path");
}

/// Throws Failure (64) for options that have no effect in this scene.
void refuse_idle(const Scenario& scenario)
{
  const auto refuse = [](bool idle, const std::string& why) {
    if (idle) throw core::option_error("option -" + why);
  };
  refuse(scenario.time.second_order && scenario.time.is_static,
         "time_scheme bdf2: statics have no time derivatives");
  refuse(scenario.tissue.tangent == tissue::Tangent::exact && scenario.tissue.all_linear(),
         "tissue_tangent exact: linear tissue has one tangent");
  refuse(scenario.tissue.allow_inversion && !scenario.tissue.any(tissue::Model::linear),
         "tissue_allow_inversion: only linear tissue has forces where an element is turned inside "
         "out");
  refuse(scenario.output.locking_gauge && scenario.cavities.cavities.empty(),
         "locking_gauge: there is no cavity (-cavities)");
  refuse(scenario.output.contact && scenario.contact.pairs.empty(),
         "output_fields: there is no contact (-contact_pairs)");
  const CheckpointSettings& checkpoint = scenario.checkpoint;
  const bool no_steps = scenario.pv || scenario.time.end == 0.0;
  refuse(no_steps && checkpoint.every > 0, "checkpoint_every: there are no steps in time");
  refuse(no_steps && checkpoint.seconds > 0.0, "checkpoint_seconds: there are no steps in time");
  refuse(no_steps && checkpoint.wall > 0.0, "time_wall: there are no steps in time");
  refuse(no_steps && !scenario.restart.folder.empty(),
         scenario.restart.branch ? "restart_from: there are no steps in time"
                                 : "restart: there are no steps in time");
  refuse(scenario.insertion.radius_correction && scenario.needles.empty(),
         "insertion_radius_correction: there is no needle (-needles)");
  refuse(scenario.insertion.radius_correction && scenario.insertion.eta > 0.0,
         "insertion_radius_correction: the eta law has a compliance of its own (-insertion_eta)");
}

/// Throws Failure (64) for what contact between bodies does not go with.
void refuse_beside_contact(const Scenario& scenario)
{
  if (scenario.contact.pairs.empty()) return;
  const auto refuse = [](bool idle, const std::string& why) {
    if (idle) throw core::option_error("option -" + why + " (-contact_pairs)");
  };
  refuse(scenario.time.newton_max > 0 && !scenario.time.is_static,
         "time_newton_max: steps with contact are iterated until its laws hold at their end");
  refuse(scenario.pv.has_value(), "pv_curve: a sweep of one cavity knows no contact");
  refuse(scenario.tissue.reuse == solve::Reuse::stale,
         "compliance_reuse stale: contact is solved to its true residual");
  refuse(scenario.insertion.eta > 0.0, "insertion_eta: this law is of needles alone");
  for (const cavity::CavitySettings& cavity : scenario.cavities.cavities)
    refuse(cavity.model == cavity::Model::frozen,
           "cavity_model frozen: the search for pressures knows no contact");
}

/// Throws Failure (64) for a spacing that puts more than 1e5 coupling points on a needle. Their
/// rows would only fill the memory.
void refuse_crowded(const Scenario& scenario)
{
  constexpr double most_points = 1e5;
  const insertion::PlacementSettings& placement = scenario.insertion.placement;
  const bool along_line = scenario.insertion.line.spacing > 0.0;
  if (placement.placement != insertion::Placement::spacing && !along_line) return;
  for (const needle::NeedleSettings& needle : scenario.needles)
    if (needle.motion.length > most_points * placement.spacing)
      throw core::option_error("option -insertion_spacing: " + core::shown(placement.spacing) +
                               " m would put " +
                               core::shown(needle.motion.length / placement.spacing) +
                               " points on needle '" + needle.name + "', more than 1e5");
}

/// Warns of a grid along the line that is so fine that forces alternate from node to node.
void add_line_warnings(Scenario& scenario)
{
  constexpr double least_kappa = 0.3, least_of_radius = 0.1;
  const insertion::LineSettings& line = scenario.insertion.line;
  if (scenario.insertion.placement.placement != insertion::Placement::line) return;
  if (line.kappa < least_kappa)
    scenario.warnings.push_back("-insertion_line_kappa " + core::shown(line.kappa) +
                                ": below 0.3 the forces along the line alternate");
  for (const needle::NeedleSettings& needle : scenario.needles)
    if (line.spacing > 0.0 && line.spacing < least_of_radius * needle.section.outer)
      scenario.warnings.push_back("-insertion_spacing " + core::shown(line.spacing) +
                                  " m is less than a tenth of the radius of needle '" +
                                  needle.name + "': the forces along the line alternate");
}

void add_warnings(Scenario& scenario)
{
  add_line_warnings(scenario);
  const step::TimeSettings& time = scenario.time;
  if (time.step != time.asked)
    scenario.warnings.push_back("-time_end " + core::shown(time.end) +
                                " is not a whole number of -time_step " + core::shown(time.asked) +
                                ": " + std::to_string(step::step_count(time)) + " equal steps of " +
                                core::shown(time.step) + " s are taken");
  for (std::size_t i = 0; i < scenario.tissue.materials.size(); ++i)
    if (scenario.tissue.materials[i].poisson > 0.45 && !scenario.mesh.quadratic() &&
        scenario.tissue.dilatation == tissue::Dilatation::pointwise)
      scenario.warnings.push_back("volume '" + scenario.mesh.volumes[i] +
                                  "': linear tets lock above a Poisson's ratio of about 0.4; "
                                  "displacements are too small and pressures wrong");
}

}  // namespace

void check_scenario(Scenario& scenario)
{
  refuse_dashpots_without_time(scenario);
  refuse_idle(scenario);
  refuse_crowded(scenario);
  refuse_beside_contact(scenario);
  add_warnings(scenario);
}

}  // namespace trocar::driver
