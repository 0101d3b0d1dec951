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

core::Failure bad(const std::string& option, const std::string& edge, const std::string& why)
{
  return core::option_error("option -edge_" + option + " of '" + edge + "': " + why);
}

void find_needle(const std::string& needle, const Scenario& scenario, cavity::EdgeSettings& edge)
{
  if (needle.empty()) return;
  std::vector<std::string> names;
  for (std::size_t n = 0; n < scenario.needles.size(); ++n) {
    names.push_back(scenario.needles[n].name);
    if (needle != names.back()) continue;
    edge.needle = static_cast<int>(n);
    edge.needle_radius = scenario.needles[n].section.outer;
  }
  if (edge.needle < 0)
    throw bad("needle", edge.name,
              "no needle '" + needle + "'" + core::did_you_mean(needle, names));
}

/// Refuses what would have no effect.
void check_edge(const cavity::EdgeSettings& edge)
{
  const bool hole = edge.hole_resistance > 0.0 || edge.hole_radius > 0.0;
  if (edge.flow_curve && edge.flow == 0.0)
    throw bad("curve", edge.name, "there is no prescribed flow to be scaled");
  if (edge.needle < 0 && (edge.gap > 0.0 || hole))
    throw bad("needle", edge.name, "gap and hole are a needle's: name it");
  if (edge.resistance == 0.0 && edge.flow == 0.0 && edge.gap == 0.0 && !hole)
    throw bad("resistance", edge.name, "without resistance and flow the edge does nothing");
  if (edge.hole_resistance > 0.0 && edge.hole_radius > 0.0)
    throw bad("hole_resistance", edge.name, "give a resistance or a radius, not both");
  if (edge.valve && edge.flow != 0.0)
    throw bad("flow", edge.name, "a valve has no prescribed flow: give that an edge of its own");
  if (edge.resistance > 0.0 && edge.gap > 0.0)
    throw bad("gap", edge.name, "give a resistance or a gap, not both");
}

/// What flows into a cavity must be a fluid like its own.
void require_one_fluid(const cavity::EdgeSettings& edge,
                       const std::vector<cavity::CavitySettings>& cavities)
{
  if (edge.from < 0 || edge.to < 0) return;
  const cavity::CavitySettings& one = cavities[static_cast<std::size_t>(edge.from)];
  const cavity::CavitySettings& other = cavities[static_cast<std::size_t>(edge.to)];
  if (!one.fluid.mixes_with(other.fluid))
    throw core::option_error("option -edges: '" + edge.name + "' joins unlike fluids: '" +
                             one.name + "' and '" + other.name +
                             "' need one law with one modulus or ambient pressure");
}

cavity::EdgeSettings read_edge(Options& options, const std::string& entry, const Scenario& scenario,
                               const base::Comm& comm)
{
  const std::vector<std::string> words = core::split(entry, ':');
  if (words.size() != 3)
    throw core::option_error("option -edges: '" + entry + "' must be NAME:FROM:TO");
  const auto& cavities = scenario.cavities.cavities;
  cavity::EdgeSettings edge;
  edge.name = words[0];
  edge.from = cavity_index(cavities, words[1], "edges");
  edge.to = cavity_index(cavities, words[2], "edges");
  if (edge.from == edge.to)
    throw core::option_error("option -edges: '" + entry + "' joins a place with itself");
  require_one_fluid(edge, scenario.cavities.cavities);
  const auto real = [&](const std::string& option) {
    return options.real("edge_<edge>_" + option, edge.name);
  };
  edge.resistance = real("resistance");
  edge.valve = options.flag("edge_<edge>_valve", edge.name);
  edge.flow = real("flow");
  edge.flow_curve = read_curve(options.text("edge_<edge>_curve", edge.name), comm);
  edge.gap = real("gap");
  edge.hole_resistance = real("hole_resistance");
  edge.hole_radius = real("hole_radius");
  edge.viscosity = real("viscosity");
  edge.length = real("length");
  find_needle(options.text("edge_<edge>_needle", edge.name), scenario, edge);
  check_edge(edge);
  return edge;
}

}  // namespace

void read_network(Options& options, Scenario& scenario, const base::Comm& comm)
{
  for (const std::string& entry : options.new_names("edges"))
    scenario.cavities.edges.push_back(read_edge(options, entry, scenario, comm));
}

}  // namespace trocar::driver
