#include "driver/insertion_options.hpp"

#include <algorithm>
#include <map>

namespace trocar::driver {
namespace {

using core::Options;

insertion::TissueFriction read_friction(Options& options, const std::string& volume)
{
  const std::string at = "insertion_<volume>_friction_";
  const auto withdraw = [&](const std::string& kind, double advance) {
    const double own = options.real(at + kind + "_withdraw", volume);
    if (own < 0.0 && own != -1.0)
      throw core::option_error("option -insertion_friction_" + kind +
                               "_withdraw: must be -1 (as on the advance) or not negative");
    return own < 0.0 ? advance : own;
  };
  insertion::TissueFriction friction;
  friction.advance = {options.real(at + "static", volume), options.real(at + "dynamic", volume),
                      options.real(at + "viscous", volume)};
  friction.withdraw = {withdraw("static", friction.advance.static_limit),
                       withdraw("dynamic", friction.advance.dynamic_limit),
                       withdraw("viscous", friction.advance.viscous)};
  return friction;
}

insertion::PlacementSettings read_placement(Options& options)
{
  const std::map<std::string, insertion::Placement> placements{
      {"crossings", insertion::Placement::crossings},
      {"spacing", insertion::Placement::spacing},
      {"line", insertion::Placement::line}};
  return {placements.at(options.text("insertion_placement")), options.real("insertion_spacing"),
          options.real("insertion_merge")};
}

/// Settings of placement `line`. Throws Failure (64) for options of other placements given with it,
/// and for its own given without it.
insertion::LineSettings read_line(Options& options, const insertion::PlacementSettings& placement,
                                  bool quadratic)
{
  const bool line = placement.placement == insertion::Placement::line;
  const auto refuse = [&](const std::string& name, const std::string& why) {
    if (options.given(name)) throw core::option_error("option -" + name + ": " + why);
  };
  if (line) {
    refuse("insertion_merge", "along a line nothing is merged (-insertion_placement line)");
    refuse("insertion_radius_correction",
           "along a line the thin shaft is corrected for already (-insertion_placement line)");
  } else {
    for (const char* name : {"insertion_line_kappa", "insertion_line_ring"})
      refuse(name, "needs -insertion_placement line");
  }
  const double kappa = options.real("insertion_line_kappa");
  const double ring = options.real("insertion_line_ring");
  insertion::LineSettings settings;
  settings.kappa = kappa > 0.0 ? kappa : quadratic ? 0.8 : 1.4;
  settings.ring = ring > 0.0 ? ring : quadratic ? 0.25 : 0.35;
  if (line && options.given("insertion_spacing")) settings.spacing = placement.spacing;
  return settings;
}

}  // namespace

insertion::InsertionSettings read_insertion(Options& options, const mesh::Mesh& mesh)
{
  insertion::InsertionSettings settings;
  settings.placement = read_placement(options);
  settings.line = read_line(options, settings.placement, mesh.quadratic());
  for (const std::string& volume : mesh.volumes)
    settings.friction.push_back(read_friction(options, volume));
  settings.eta = options.real("insertion_eta");
  const std::string puncture = "insertion_<volume>_puncture_force";
  for (const std::string& volume : mesh.volumes) {
    settings.puncture.volume.push_back(options.real(puncture, volume));
    settings.tip.cutting.push_back(options.real("insertion_<volume>_cutting_force", volume));
  }
  for (const mesh::SurfaceGroup& surface : mesh.surfaces)
    settings.puncture.surface.push_back(
        options.given_for(puncture, surface.name) ? options.real(puncture, surface.name) : -1.0);
  settings.tip.radius = options.real("insertion_tip_radius");
  settings.tip.friction = options.real("insertion_tip_friction");
  // A smaller slip is only round-off of the tissue's equilibrium, however exactly the laws are met.
  constexpr double least_slip = 1e-9;  // [m]
  settings.stick_tolerance = std::max(options.real("constraint_tolerance"), least_slip);
  return settings;
}

void add_radius_correction(Scenario& scenario)
{
  insertion::RadiusCorrection& correction = scenario.insertion.radius_correction.emplace();
  correction.fit = insertion::radius_fit(
      scenario.mesh.quadratic(), scenario.tissue.dilatation != tissue::Dilatation::pointwise);
  for (const needle::NeedleSettings& needle : scenario.needles)
    correction.radius.push_back(needle.section.outer);
}

}  // namespace trocar::driver
