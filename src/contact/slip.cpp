#include "contact/slip.hpp"

namespace trocar::contact {

Vec3 mean(const constraint::Anchor& anchor, const Deformation& now)
{
  return anchor.mean([&](int node) { return now.at(node); });
}

Vec3 obstacle_moved(const Contacts& contacts, int pair, double t)
{
  const Master& master = contacts.pairs[static_cast<std::size_t>(pair)].master;
  const auto* obstacle = std::get_if<Obstacle>(&master);
  return obstacle ? obstacle->moved(t) : Vec3::Zero();
}

Vec3 moved_apart(const Group& group, const Contacts& contacts, const Deformation& now)
{
  const Meeting& at = group.meeting;
  const Deformation before{now.mesh, contacts.start, contacts.start_t};
  const Vec3 carried =
      obstacle_moved(contacts, group.pair, now.t) - obstacle_moved(contacts, group.pair, before.t);
  return carried + (mean(at.master, now) - mean(at.master, before)) -
         (mean(at.slave, now) - mean(at.slave, before));
}

Vec3 distance(const Contacts& contacts, int pair, const Touch& touch, const Deformation& now)
{
  return mean(touch.master, now) + obstacle_moved(contacts, pair, now.t) -
         (mean(touch.slave, now) - touch.place);
}

Vec3 slip_of(const Group& group, const Contacts& contacts, const Deformation& now)
{
  Vec3 slip = Vec3::Zero();
  if (group.touch) {
    const Vec3 d = distance(contacts, group.pair, *group.touch, now);
    for (int k = 1; k < 3; ++k) slip[k] = group.frame.col(k).dot(d) - group.touch->apart[k];
    return slip;
  }
  const Vec3 moved = moved_apart(group, contacts, now);
  for (int k = 1; k < 3; ++k) slip[k] = group.frame.col(k).dot(moved);
  return slip;
}

}  // namespace trocar::contact
