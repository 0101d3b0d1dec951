#include "contact/contacts.hpp"

#include <algorithm>
#include <map>

#include "contact/slip.hpp"
#include "core/failure.hpp"
#include "core/words.hpp"

namespace trocar::contact {
namespace {

Master master_of(const PairSettings& pair, const Settings& settings, const mesh::Mesh& mesh)
{
  std::vector<std::string> names;
  for (const Obstacle& obstacle : settings.obstacles) {
    if (obstacle.name == pair.master) return obstacle;
    names.push_back(obstacle.name);
  }
  for (const mesh::SurfaceGroup& surface : mesh.surfaces) {
    if (surface.name == pair.master) return Surface(mesh, pair.master);
    names.push_back(surface.name);
  }
  throw core::data_error("option -contact_pairs: pair '" + pair.name +
                         "' names no surface and no obstacle '" + pair.master + "'" +
                         core::did_you_mean(pair.master, names));
}

/// Throws Failure (65) where a face is on both sides of a pair.
void refuse_shared(const Pair& pair)
{
  const auto* master = std::get_if<Surface>(&pair.master);
  if (!master) return;
  for (int node : pair.slave.corners())
    if (std::binary_search(master->corners().begin(), master->corners().end(), node))
      throw core::data_error("option -contact_pairs: surfaces '" + pair.slave.name() + "' and '" +
                             master->name() + "' of pair '" + pair.name +
                             "' have nodes in common: contact is between surfaces apart");
}

}  // namespace

std::vector<Pair> pairs_of(const Settings& settings, const mesh::Mesh& mesh,
                           const fem::Dirichlet& fixed)
{
  std::vector<Pair> pairs;
  std::map<int, std::string> slave_in;
  for (const PairSettings& one : settings.pairs) {
    Surface slave(mesh, one.slave);
    Pair pair{one.name, slave, master_of(one, settings, mesh), one.friction, one.shear_limit, 0.0};
    refuse_shared(pair);
    pair.search = one.search > 0.0 ? one.search : slave.mean_edge();
    pair.closed = one.closed;
    for (int node : slave.corners()) {
      // A corner is slave in one pair only, in the order of the pairs.
      const bool taken = !slave_in.emplace(node, one.name).second;
      const bool held = fixed.fixed(node, 0) && fixed.fixed(node, 1) && fixed.fixed(node, 2);
      pair.held.push_back(held || taken);
    }
    if (std::find(pair.held.begin(), pair.held.end(), false) == pair.held.end())
      throw core::data_error("option -contact_pairs: no corner of slave '" + one.slave +
                             "' of pair '" + one.name +
                             "' can carry a force: each is prescribed, or slave of a pair before "
                             "(exchange slave and master)");
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

namespace {

/// The entry of a node in a list by ascending nodes, or nothing.
template <class Entry>
const Entry* entry_of(const std::vector<Entry>& list, int node)
{
  const auto at = std::lower_bound(list.begin(), list.end(), node,
                                   [](const Entry& one, int which) { return one.node < which; });
  return at != list.end() && at->node == node ? &*at : nullptr;
}

/// Normal, and two tangents of which the first points towards a fixed neighbour: so it turns with
/// the body.
core::Mat3 frame_at(const Surface& surface, const Meeting& meeting, const Deformation& now)
{
  const int near = surface.neighbours(surface.corner_of(meeting.node)).front();
  const Vec3 edge =
      now.at(surface.corners()[static_cast<std::size_t>(near)]) - now.at(meeting.node);
  const Vec3& n = meeting.normal;
  core::Mat3 frame;
  frame.col(0) = n;
  frame.col(1) = (edge - n.dot(edge) * n).normalized();
  frame.col(2) = n.cross(frame.col(1));
  return frame;
}

/// A row between two mean places: master minus slave, along a direction.
constraint::Row row_between(const constraint::Anchor& slave, const constraint::Anchor& master,
                            const Vec3& direction, double gap)
{
  constraint::Row row;
  row.gap = gap;
  if (!master.node.empty()) row.tissue.push_back({master, direction});
  row.tissue.push_back({slave, -direction});
  return row;
}

void add_group(const Contacts& contacts, const Deformation& now, Group& group, constraint::Set& set)
{
  const Pair& pair = contacts.pairs[static_cast<std::size_t>(group.pair)];
  const Meeting& at = group.meeting;
  std::vector<constraint::Row> rows{row_between(at.slave, at.master, group.frame.col(0), at.gap)};
  law::Law law = law::Law::half_line();
  if (pair.friction > 0.0) {
    const Vec3 slip = slip_of(group, contacts, now);
    const constraint::Anchor& slave = group.touch ? group.touch->slave : at.slave;
    const constraint::Anchor& master = group.touch ? group.touch->master : at.master;
    for (int k = 1; k < 3; ++k)
      rows.push_back(row_between(slave, master, group.frame.col(k), slip[k]));
    law = law::Law::capped_cone(pair.friction, pair.shear * at.area);
  }
  group.rows = static_cast<int>(rows.size());
  for (int k = 0; k < group.rows && group.touch; ++k)
    rows[static_cast<std::size_t>(k)].start = group.touch->lambda[k];
  group.first = set.add(std::move(rows), law, set.next_point());
}

}  // namespace

Rows add_rows(const Contacts& contacts, const Deformation& now, constraint::Set& set)
{
  Rows rows;
  rows.first = set.size();
  for (std::size_t p = 0; p < contacts.pairs.size(); ++p) {
    const Pair& pair = contacts.pairs[p];
    if (!near(pair, now)) continue;
    ++rows.queries;
    for (Meeting& meeting : meet(pair, now)) {
      Group group{static_cast<int>(p), std::move(meeting), nullptr, core::Mat3::Zero()};
      if (!contacts.state.pairs.empty()) {
        const PairState& known = contacts.state.pairs[p];
        group.touch = entry_of(known.touches, group.meeting.node);
        const Overlapped* over = entry_of(known.overlapped, group.meeting.node);
        if (over) group.meeting.open(over->by);
      }
      group.frame = frame_at(pair.slave, group.meeting, now);
      add_group(contacts, now, group, set);
      rows.groups.push_back(std::move(group));
    }
  }
  rows.count = set.size() - rows.first;
  return rows;
}

core::VecX carried(const Rows& from, const core::VecX& lambda, const Rows& rows)
{
  std::map<std::pair<int, int>, const Group*> known;
  for (const Group& group : from.groups) known[{group.pair, group.meeting.node}] = &group;
  core::VecX here = core::VecX::Zero(rows.count);
  for (const Group& group : rows.groups) {
    const auto at = known.find({group.pair, group.meeting.node});
    if (at != known.end())
      here.segment(group.first - rows.first, group.rows) =
          lambda.segment(at->second->first, group.rows);
  }
  return here;
}

Ending ending(const Contacts& contacts, const Deformation& now, const Rows& solved,
              const core::VecX& lambda, const core::VecX& mobility)
{
  Ending end;
  constraint::Set set;
  end.rows = add_rows(contacts, now, set);
  end.lambda = carried(solved, lambda, end.rows);
  const core::VecX give = carried(solved, mobility, end.rows);
  for (const law::Block& block : set.blocks()) {
    const int count = block.law.rows();
    law::Few force(count), delta(count);
    for (int k = 0; k < count; ++k) {
      force[k] = end.lambda[block.first + k];
      delta[k] = set.rows()[static_cast<std::size_t>(block.first + k)].gap;
    }
    const double w = give.segment(block.first, count).mean();
    const double left = w > 0.0 ? law::residual(block.law, force, delta, w) : -delta[0];
    end.residual = std::max(end.residual, left);
  }
  // A corner that is out of reach now must not have been pushed.
  for (const Group& group : solved.groups) {
    const bool here =
        std::any_of(end.rows.groups.begin(), end.rows.groups.end(), [&](const Group& g) {
          return g.pair == group.pair && g.meeting.node == group.meeting.node;
        });
    if (!here) end.residual = std::max(end.residual, lambda[group.first] * mobility[group.first]);
  }
  end.system = constraint::System(std::move(set), {});
  return end;
}

}  // namespace trocar::contact
