#include <algorithm>

#include "contact/contacts.hpp"
#include "contact/slip.hpp"
#include "core/failure.hpp"
#include "core/place.hpp"
#include "core/words.hpp"

namespace trocar::contact {

State start(const std::vector<Pair>& pairs, const Deformation& now, core::Ledger& ledger)
{
  constexpr double farther = 3.0;  // how deep an overlap is looked for, in search distances
  State state;
  state.pairs.resize(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (!pairs[p].closed) continue;
    Pair wide = pairs[p];
    wide.search *= farther;
    if (!near(wide, now)) continue;
    ledger.contact_queries += 2;
    for (const Meeting& at : meet(wide, now))
      if (at.gap < -pairs[p].search)
        throw core::data_error("option -contact_pairs: the surfaces of pair '" + pairs[p].name +
                               "' overlap by " + core::shown(-at.gap) + " m at " +
                               core::shown(now.at(at.node)) + ", more than -contact_search " +
                               core::shown(pairs[p].search) +
                               " (mend the mesh, or search farther)");
    for (const Meeting& at : meet(pairs[p], now))
      if (at.gap < 0.0) state.pairs[p].overlapped.push_back({at.node, -at.gap});
  }
  return state;
}

bool same_touching(const State& a, const State& b)
{
  const auto same = [](const Touch& one, const Touch& other) { return one.node == other.node; };
  const std::size_t pairs = std::max(a.pairs.size(), b.pairs.size());
  for (std::size_t p = 0; p < pairs; ++p) {
    const std::vector<Touch> none;
    const std::vector<Touch>& mine = p < a.pairs.size() ? a.pairs[p].touches : none;
    const std::vector<Touch>& others = p < b.pairs.size() ? b.pairs[p].touches : none;
    if (!std::equal(mine.begin(), mine.end(), others.begin(), others.end(), same)) return false;
  }
  return true;
}

namespace {

/// Where the friction of a corner is measured from after the step: from the old anchor while it
/// sticks, from here where it slips.
void anchor(const Group& group, bool sticks, const Contacts& contacts, const Deformation& now,
            Touch& touch)
{
  if (sticks && group.touch) {
    touch.slave = group.touch->slave;
    touch.master = group.touch->master;
    touch.apart = group.touch->apart;
    touch.place = group.touch->place;
    return;
  }
  const Meeting& at = group.meeting;
  touch.slave = at.slave;
  touch.master = at.master;
  if (at.master.node.empty())
    touch.place = mean(at.slave, now) - obstacle_moved(contacts, group.pair, now.t);
  const Vec3 d = distance(contacts, group.pair, touch, now);
  for (int k = 1; k < 3; ++k) touch.apart[k] = group.frame.col(k).dot(d);
}

void add_forces(const Group& group, const Contacts& contacts, const Deformation& now,
                const Touch& touch, PairReport& report)
{
  const Vec3 force = group.frame * touch.lambda;
  report.force += force;
  report.area += group.meeting.area;
  report.obstacle_work -= force.dot(obstacle_moved(contacts, group.pair, now.t) -
                                    obstacle_moved(contacts, group.pair, contacts.start_t));
  report.normal_work += touch.lambda[0] * group.frame.col(0).dot(moved_apart(group, contacts, now));
}

/// What is told of a corner in reach, whether it touches or not.
void tell(const Meeting& at, PairReport& report)
{
  report.weighted_gap = report.corners.empty() ? at.gap : std::min(report.weighted_gap, at.gap);
  report.largest_penetration = std::max(report.largest_penetration, -at.least_gap);
  report.corners.push_back({at.node, at.gap, at.area});
}

}  // namespace

State accept(const Contacts& contacts, const Ending& ending, const Deformation& now,
             double tolerance, std::vector<PairReport>& reports)
{
  State state;
  state.pairs.resize(contacts.pairs.size());
  for (std::size_t p = 0; p < contacts.state.pairs.size(); ++p)
    state.pairs[p].overlapped = contacts.state.pairs[p].overlapped;
  reports.assign(contacts.pairs.size(), {});
  for (const Group& group : ending.rows.groups) {
    PairReport& report = reports[static_cast<std::size_t>(group.pair)];
    tell(group.meeting, report);
    Touch touch;
    touch.node = group.meeting.node;
    for (int k = 0; k < group.rows; ++k) touch.lambda[k] = ending.lambda[group.first + k];
    if (!(touch.lambda[0] > 0.0)) continue;
    add_forces(group, contacts, now, touch, report);
    const Vec3 slip = group.rows > 1 ? slip_of(group, contacts, now) : Vec3::Zero();
    const bool sticks = group.rows > 1 && slip.norm() <= tolerance;
    if (!sticks) report.friction_work += touch.lambda.dot(slip);
    ++(sticks ? report.sticking : report.slipping);
    CornerReport& corner = report.corners.back();
    corner.state = sticks ? CornerReport::sticks : CornerReport::slips;
    corner.force = group.frame * touch.lambda;
    corner.pressure = touch.lambda[0] / corner.area;
    if (group.rows > 1) anchor(group, sticks, contacts, now, touch);
    state.pairs[static_cast<std::size_t>(group.pair)].touches.push_back(std::move(touch));
  }
  return state;
}

}  // namespace trocar::contact
