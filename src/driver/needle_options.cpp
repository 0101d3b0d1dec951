#include "driver/needle_options.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/words.hpp"
#include "driver/option_source.hpp"
#include "insertion/clip.hpp"
#include "insertion/deformed.hpp"
#include "mesh/quadratic.hpp"
#include "mesh/topology.hpp"

namespace trocar::driver {
namespace {

needle::BaseMotion read_motion(core::Options& options, const std::string& name,
                               const base::Comm& comm)
{
  needle::BaseMotion motion;
  motion.entry = options.vector("needle_<needle>_entry", name);
  const core::Vec3 direction = options.vector("needle_<needle>_direction", name);
  if (!(direction.norm() > 0.0))
    throw core::option_error("option -needle_direction of '" + name + "' has length 0");
  motion.direction = direction.normalized();
  motion.length = options.real("needle_<needle>_length", name);
  motion.roll = options.real("needle_<needle>_roll", name);
  motion.inserted = options.real("needle_<needle>_inserted", name);
  motion.velocity = options.real("needle_<needle>_velocity", name);
  motion.depth = options.real("needle_<needle>_depth", name);
  motion.hold = options.real("needle_<needle>_hold", name);
  motion.withdraw_velocity = options.real("needle_<needle>_withdraw_velocity", name);
  const std::string file = options.text("needle_<needle>_trajectory", name);
  if (!file.empty()) {
    motion.trajectory = read_csv(file, comm);
    needle::check_trajectory(motion);
  }
  return motion;
}

needle::NeedleSettings read_needle(core::Options& options, const std::string& name,
                                   const base::Comm& comm)
{
  needle::NeedleSettings settings;
  settings.name = name;
  settings.model = options.text("needle_<needle>_model", name) == "rigid" ? needle::Model::rigid
                                                                          : needle::Model::beam;
  settings.motion = read_motion(options, name, comm);
  settings.section.outer = options.real("needle_<needle>_radius", name);
  settings.section.inner = options.real("needle_<needle>_inner_radius", name);
  settings.section.young = options.real("needle_<needle>_young", name);
  settings.section.poisson = options.real("needle_<needle>_poisson", name);
  settings.density = options.real("needle_<needle>_density", name);
  settings.elements = options.integer("needle_<needle>_elements", name);
  settings.gravity = options.vector("gravity");
  const double bevel = options.real("needle_<needle>_bevel", name);
  settings.bevel = bevel > 0.0 ? 1.0 / std::tan(bevel) : 0.0;
  if (settings.section.inner >= settings.section.outer)
    throw core::option_error("option -needle_inner_radius of '" + name +
                             "' must be less than -needle_radius");
  return settings;
}

/// Refuses names that make options ambiguous: with a needle `inner`, -needle_inner_radius would
/// have two meanings. Failure (64).
void check_needle_names(const std::vector<std::string>& names)
{
  for (const std::string& name : names)
    for (const char* area : {"inner", "withdraw"})
      if (name == area)
        throw core::option_error("option -needles: '" + name +
                                 "' begins another option of the needle's area");
}

/// A base on the surface counts as outside: the tested point lies this part of the needle's length
/// behind the base.
constexpr double on_surface = 1e-6;

/// Throws Failure (65) when the base enters the tissue on the way from one row of the trajectory to
/// the next, or when the shaft meets the tissue at no row.
void check_trajectory_places(const needle::BaseMotion& motion, const insertion::Deformed& tissue,
                             const std::string& who)
{
  const auto& rows = motion.trajectory->rows;
  bool meets = false;
  needle::Pose last = motion.at(rows.front().front());
  for (const auto& row : rows) {
    const needle::Pose pose = motion.at(row.front());
    const auto base = [&](const needle::Pose& at) -> core::Vec3 {
      return at.x - on_surface * motion.length * at.R.col(0);
    };
    if (tissue.meets(base(last), base(pose) + 1e-9 * motion.length * pose.R.col(0)))
      throw core::data_error(who + "its base would enter the tissue before t = " +
                             core::shown(row.front()) + " s of " + motion.trajectory->file);
    meets = meets || tissue.meets(pose.x, pose.x + motion.length * pose.R.col(0));
    last = pose;
  }
  if (!meets)
    throw core::data_error(who + "along " + motion.trajectory->file +
                           " its shaft never meets the tissue (at the times given)");
}

/// Throws Failure (65) for a needle whose prescribed motion is impossible in the undeformed mesh.
/// Called before anything is computed.
void check_needle(const needle::NeedleSettings& settings, const mesh::Mesh& mesh,
                  const mesh::Locator& locator, double end)
{
  const needle::BaseMotion& motion = settings.motion;
  const fem::GlobalField undeformed{core::VecX::Zero(3 * mesh.node_count())};
  const insertion::Deformed tissue(mesh, locator, undeformed);
  const std::string who = "needle '" + settings.name + "': ";
  if (std::max(motion.depth, motion.inserted) > motion.length)
    throw core::data_error(who + "its base would enter the tissue: depth " +
                           core::shown(std::max(motion.depth, motion.inserted)) +
                           " m is more than its length");
  const needle::Pose start = motion.at(0.0);
  if (locator.tet_at(start.x - on_surface * motion.length * start.R.col(0)) >= 0)
    throw core::data_error(who + "its base would enter the tissue at the start");
  const core::Vec3 before_entry = motion.entry - 1e-3 * motion.length * motion.direction;
  if (motion.inserted < motion.length && tissue.meets(motion.start().x, before_entry))
    throw core::data_error(who +
                           "its shaft would start inside the tissue, outside its path "
                           "(check -needle_entry and -needle_direction; -needle_inserted "
                           "gives the depth at the start)");
  if (motion.trajectory) {
    check_trajectory_places(motion, tissue, who);
    return;
  }
  const double reach =
      std::max({motion.depth, motion.inserted, motion.velocity > 0.0 ? 1e-9 : 0.0});
  const core::Vec3 far = motion.entry + (reach > 0.0 ? reach : 1e-9) * motion.direction;
  const bool goes_in = motion.inserted > 0.0 || (motion.velocity > 0.0 && end > 0.0);
  if (goes_in && !tissue.meets(motion.start().x, far))
    throw core::data_error(who +
                           "its path never meets the tissue (check -needle_entry and "
                           "-needle_direction)");
}

/// Tets on the planned path of the tip: straight from the entry to the depth, then straight between
/// the tip positions at the rows of a trajectory.
std::set<int> planned_tets(const needle::BaseMotion& motion, const mesh::Mesh& mesh,
                           const mesh::Locator& locator)
{
  std::vector<core::Vec3> stations{
      motion.entry, motion.entry + std::max(motion.depth, motion.inserted) * motion.direction};
  if (motion.trajectory)
    for (const auto& row : motion.trajectory->rows) {
      const needle::Pose pose = motion.at(row.front());
      stations.push_back(pose.x + motion.length * pose.R.col(0));
    }
  std::set<int> tets;
  for (std::size_t i = 0; i + 1 < stations.size(); ++i)
    for (int tet : locator.in_box(stations[i].cwiseMin(stations[i + 1]),
                                  stations[i].cwiseMax(stations[i + 1])))
      if (insertion::clip_line(mesh::corners(mesh, tet), stations[i], stations[i + 1]))
        tets.insert(tet);
  return tets;
}

}  // namespace

std::vector<needle::NeedleSettings> read_needles(core::Options& options, const mesh::Mesh& mesh,
                                                 const mesh::Locator& locator, double end,
                                                 const base::Comm& comm)
{
  const std::vector<std::string> names = options.new_names("needles");
  std::vector<needle::NeedleSettings> needles;
  check_needle_names(names);
  for (const std::string& name : names) {
    needles.push_back(read_needle(options, name, comm));
    check_needle(needles.back(), mesh, locator, end);
  }
  return needles;
}

std::vector<int> planned_nodes(const std::vector<needle::NeedleSettings>& needles,
                               const mesh::Mesh& mesh, const mesh::Locator& locator, int layers)
{
  constexpr std::size_t most_nodes = 1000;
  std::vector<int> nodes;
  if (layers == 0) return nodes;
  std::set<int> tube;
  for (const needle::NeedleSettings& settings : needles)
    for (int tet : planned_tets(settings.motion, mesh, locator))
      for (int node : mesh::nodes_of(mesh, tet)) tube.insert(node);
  const mesh::NodeToTets around = mesh::node_to_tets(mesh);
  for (int layer = 0; layer <= layers && tube.size() <= most_nodes; ++layer) {
    nodes.assign(tube.begin(), tube.end());
    for (int node : nodes)
      for (int k = around.start[static_cast<std::size_t>(node)];
           k < around.start[static_cast<std::size_t>(node) + 1]; ++k)
        for (int other : mesh::nodes_of(mesh, around.tet[static_cast<std::size_t>(k)]))
          tube.insert(other);
  }
  return nodes;
}

}  // namespace trocar::driver
