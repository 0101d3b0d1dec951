#include "driver/network_options.hpp"

#include "core/words.hpp"
#include "driver/boundary_options.hpp"
#include "driver/option_source.hpp"

namespace trocar::driver {

int cavity_index(const std::vector<cavity::CavitySettings>& cavities, const std::string& name,
                 const std::string& option)
{
  if (name == "outside") return -1;
  std::vector<std::string> names{"outside"};
  for (std::size_t i = 0; i < cavities.size(); ++i) {
    if (cavities[i].name == name) return static_cast<int>(i);
    names.push_back(cavities[i].name);
  }
  throw core::option_error("option -" + option + ": no cavity '" + name + "'" +
                           core::did_you_mean(name, names));
}

namespace {

using core::Options;

core::Failure bad(const std::string& option, const std::string& conduit, const std::string& why)
{
  return core::option_error("option -conduit_" + option + " of '" + conduit + "': " + why);
}

void find_needle(const std::string& needle, const Scenario& scenario,
                 cavity::ConduitSettings& conduit)
{
  if (needle.empty()) return;
  std::vector<std::string> names;
  for (std::size_t n = 0; n < scenario.needles.size(); ++n) {
    names.push_back(scenario.needles[n].name);
    if (needle != names.back()) continue;
    conduit.needle = static_cast<int>(n);
    conduit.needle_radius = scenario.needles[n].section.outer;
  }
  if (conduit.needle < 0)
    throw bad("needle", conduit.name,
              "no needle '" + needle + "'" + core::did_you_mean(needle, names));
}

/// Throws Failure (64) for options of a conduit that have no effect or exclude each other.
void check_conduit(const cavity::ConduitSettings& conduit)
{
  const bool hole = conduit.hole_resistance > 0.0 || conduit.hole_radius > 0.0;
  if (conduit.flow_curve && conduit.flow == 0.0)
    throw bad("curve", conduit.name, "there is no prescribed flow to be scaled");
  if (conduit.needle < 0 && (conduit.gap > 0.0 || hole))
    throw bad("needle", conduit.name, "gap and hole are a needle's: name it");
  if (conduit.resistance == 0.0 && conduit.flow == 0.0 && conduit.gap == 0.0 && !hole)
    throw bad("resistance", conduit.name, "without resistance and flow the conduit does nothing");
  if (conduit.hole_resistance > 0.0 && conduit.hole_radius > 0.0)
    throw bad("hole_resistance", conduit.name, "give a resistance or a radius, not both");
  if (conduit.valve && conduit.flow != 0.0)
    throw bad("flow", conduit.name,
              "a valve has no prescribed flow: give that a conduit of its own");
  if (conduit.resistance > 0.0 && conduit.gap > 0.0)
    throw bad("gap", conduit.name, "give a resistance or a gap, not both");
}

/// Throws Failure (64) when a conduit joins cavities with different fluids. A cavity has one fluid,
/// so what flows in must be the same.
void require_one_fluid(const cavity::ConduitSettings& conduit,
                       const std::vector<cavity::CavitySettings>& cavities)
{
  if (conduit.from < 0 || conduit.to < 0) return;
  const cavity::CavitySettings& one = cavities[static_cast<std::size_t>(conduit.from)];
  const cavity::CavitySettings& other = cavities[static_cast<std::size_t>(conduit.to)];
  if (!one.fluid.mixes_with(other.fluid))
    throw core::option_error("option -conduits: '" + conduit.name + "' joins unlike fluids: '" +
                             one.name + "' and '" + other.name +
                             "' need one law with one modulus or ambient pressure");
}

cavity::ConduitSettings read_conduit(Options& options, const std::string& entry,
                                     const Scenario& scenario, const base::Comm& comm)
{
  const std::vector<std::string> words = core::split(entry, ':');
  if (words.size() != 3)
    throw core::option_error("option -conduits: '" + entry + "' must be NAME:FROM:TO");
  const auto& cavities = scenario.cavities.cavities;
  cavity::ConduitSettings conduit;
  conduit.name = words[0];
  conduit.from = cavity_index(cavities, words[1], "conduits");
  conduit.to = cavity_index(cavities, words[2], "conduits");
  if (conduit.from == conduit.to)
    throw core::option_error("option -conduits: '" + entry + "' joins a place with itself");
  require_one_fluid(conduit, scenario.cavities.cavities);
  const auto real = [&](const std::string& option) {
    return options.real("conduit_<conduit>_" + option, conduit.name);
  };
  conduit.resistance = real("resistance");
  conduit.valve = options.flag("conduit_<conduit>_valve", conduit.name);
  conduit.flow = real("flow");
  conduit.flow_curve = read_curve(options.text("conduit_<conduit>_curve", conduit.name), comm);
  conduit.gap = real("gap");
  conduit.hole_resistance = real("hole_resistance");
  conduit.hole_radius = real("hole_radius");
  conduit.viscosity = real("viscosity");
  conduit.length = real("length");
  find_needle(options.text("conduit_<conduit>_needle", conduit.name), scenario, conduit);
  check_conduit(conduit);
  return conduit;
}

}  // namespace

void read_network(Options& options, Scenario& scenario, const base::Comm& comm)
{
  for (const std::string& entry : options.new_names("conduits"))
    scenario.cavities.conduits.push_back(read_conduit(options, entry, scenario, comm));
}

}  // namespace trocar::driver
