#pragma once

#include "contact/contacts.hpp"

// How far the sides of a corner have moved along each other.
namespace trocar::contact {

/// Place of an anchor; zero when it has no nodes [m].
Vec3 mean(const constraint::Anchor& anchor, const Deformation& now);

/// Displacement of a pair's obstacle [m]; zero for a surface.
Vec3 obstacle_moved(const Contacts& contacts, int pair, double t);

/// How far the master moved from the slave in the step [m].
Vec3 moved_apart(const Group& group, const Contacts& contacts, const Deformation& now);

/// From the slave's to the master's mean place; on an obstacle, from the slave to where the
/// obstacle has carried the place of the anchor [m].
Vec3 distance(const Contacts& contacts, int pair, const Touch& touch, const Deformation& now);

/// Slip of a group since it touched last, in the frame's tangents (0, t1, t2) [m].
Vec3 slip_of(const Group& group, const Contacts& contacts, const Deformation& now);

}  // namespace trocar::contact
