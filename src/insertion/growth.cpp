#include "insertion/growth.hpp"

#include <algorithm>

#include "insertion/line_points.hpp"

namespace trocar::insertion {
namespace {

/// Notes the border before `arc` as what stops the tip, unless it is pierced already.
bool stopped(const Ground& ground, TipState& tip, const Piece& from, int to, const Vec3& X)
{
  const double edge = local_edge(ground.mesh, std::max(from.tet, to));
  const double threshold = ground.border(from.tet, to, X);
  // An oblique path may cross the faces of one membrane several times: up to an edge (or the
  // tip's radius) beyond the pierced place, a border with the same force counts as pierced.
  const bool pierced = threshold == tip.pierced_force &&
                       from.end <= tip.pierced_arc + std::max(ground.settings.tip.radius, edge);
  if (threshold <= 0.0 || pierced) return false;
  tip.threshold = threshold;
  tip.wall = from.tet < 0 || to < 0;
  tip.tet = to >= 0 ? to : from.tet;
  return true;
}

/// Grows a path in one body (-1: in any). False when a border stops it before X.
bool grow_within(const Ground& ground, InsertionState& state, const TipWay& way, int body)
{
  const Field field = ground.field(body);
  if (!ground.resists || !way.pierces) {
    grow(state.path, way.X, field);
    return true;
  }
  const Path before = state.path;
  grow(state.path, way.X, field);
  for (std::size_t i = std::max<std::size_t>(before.pieces.size(), 1); i < state.path.pieces.size();
       ++i) {
    const Piece from = state.path.pieces[i - 1];
    const Piece& to = state.path.pieces[i];
    // Pieces of two bodies meet where the path jumps: its surfaces have been judged there.
    if (from.tet == to.tet || from.end <= run_at(state.path, state.path.length()).begin) continue;
    const double arc = to.begin;
    const double part = (arc - before.length()) / (way.X - before.vertex.back()).norm();
    const Vec3 place = before.vertex.back() + part * (way.X - before.vertex.back());
    if (!stopped(ground, state.tip, from, to.tet, place)) continue;
    state.path = before;
    grow(state.path, place, field);
    return false;
  }
  return true;
}

/// The way of a tip through several bodies.
class Passing
{
 public:
  Passing(const Ground& ground, InsertionState& state, const TipWay& way)
      : ground_(&ground),
        state_(&state),
        way_(way),
        tet_(last_tet(state.path, run_at(state.path, state.path.length())))
  {
    if (tet_ < 0) tet_ = way.tet;  // the path has just begun, or jumped
    const Vec3& end = state.path.vertex.back();
    from_ = tet_ < 0 ? end : way.tissue.place(end, tet_);
    length_ = (way.x - from_).norm();
  }

  void run()
  {
    for (const Deformed::Entry& entry : way_.tissue.entries(from_, way_.x, ground_->body_of_node)) {
      if (tet_ < 0) tet_ = entry.first_tet;
      if (ground_->body(entry.first_tet) == ground_->body(tet_)) {
        left_ = std::max(left_, entry.high);
        last_ = entry.last_tet;
        continue;
      }
      const double tolerance = arc_tolerance(ground_->mesh, entry.first_tet);
      if ((std::min(entry.high, 1.0) - std::max(entry.low, left_)) * length_ <= tolerance) continue;
      if (!leave() || !enter(entry)) return;
    }
    const int body = tet_ < 0 ? -1 : ground_->body(tet_);
    grow_within(*ground_, *state_, way_, body);
  }

 private:
  bool outside() const
  {
    const Path& path = state_->path;
    return path.pieces.empty() || path.pieces.back().tet < 0;
  }

  /// Takes the path to the end of its body. False when it is stopped there or before.
  bool leave()
  {
    if (outside() && last_ < 0) return true;
    const int tet = last_ < 0 ? tet_ : last_;
    Path& path = state_->path;
    const TipWay there{way_.tissue.reference_place_continued(from_ + left_ * (way_.x - from_), tet),
                       way_.x,
                       way_.shaft,
                       way_.tissue,
                       way_.tet,
                       way_.pierces};
    if ((there.X - path.vertex.back()).norm() > arc_tolerance(ground_->mesh, tet) &&
        !grow_within(*ground_, *state_, there, ground_->body(tet)))
      return false;
    if (!way_.pierces || path.pieces.empty()) return true;
    return !stopped(*ground_, state_->tip, {0.0, path.length(), tet}, -1, path.vertex.back());
  }

  /// Takes the path to the surface of the next body. False when it is stopped there.
  bool enter(const Deformed::Entry& entry)
  {
    const double at = std::max(entry.low, left_);
    const int tet = entry.first_tet;
    const Vec3 X = entry.low >= left_
                       ? entry.X
                       : way_.tissue.reference_place_continued(from_ + at * (way_.x - from_), tet);
    jump(state_->path, X, (at - left_) * length_);
    tet_ = tet;
    left_ = entry.high;
    last_ = entry.last_tet;
    // A force that has pierced the last surface has not pierced this one.
    TipState& tip = state_->tip;
    tip.pierced_arc = -1.0;
    tip.pierced_force = 0.0;
    tip.tet = tet;
    if (way_.pierces && stopped(*ground_, tip, {0.0, state_->path.length(), -1}, tet, X))
      return false;
    // The friction of what the tip passes here begins anew.
    InsertionState here = *state_;
    here.points.clear();
    here.tip_arc = here.path.length();
    way_.X = passed_place(*ground_, here, way_.tissue.reference_place_continued(way_.x, last_), tet,
                          way_.shaft);
    return true;
  }

  const Ground* ground_;
  InsertionState* state_;
  TipWay way_;
  int tet_;              ///< of the body that the path is in; -1: none yet
  int last_ = -1;        ///< last tet of it on the way
  double left_ = 0.0;    ///< part of the way at which the tip has left it
  Vec3 from_;            ///< where the path ends now [m]
  double length_ = 0.0;  ///< of the way [m]
};

}  // namespace

void grow_to(const Ground& ground, InsertionState& state, const TipWay& way)
{
  state.tip.threshold = 0.0;
  state.tip.wall = false;
  if (ground.bodies < 2)
    grow_within(ground, state, way, -1);
  else
    Passing(ground, state, way).run();
}

Vec3 reference_in(const Ground& ground, const Deformed& tissue, const Vec3& x, int tet)
{
  const Vec3 guess = tissue.reference_place_continued(x, tet);
  const auto inside = tissue.reference_place(x, guess);
  return inside && ground.body(inside->tet) == ground.body(tet) ? inside->X : guess;
}

namespace {

/// The run whose tets are of the body that a tet belongs to; nothing: no run is.
std::optional<PathRun> run_in(const Ground& ground, const Path& path, int tet)
{
  for (const PathRun& run : runs(path))
    if (const int in = first_tet(path, run); in >= 0 && ground.body(in) == ground.body(tet))
      return run;
  return std::nullopt;
}

}  // namespace

Aim aim(const Ground& ground, const InsertionState& old, const Vec3& x, const Deformed& tissue)
{
  const Path& path = old.path;
  const auto inside = tissue.reference_place(x, path.vertex.back());
  // Outside the tissue, extrapolate the map of the tet at the nearer end of the run: the tip may
  // have left the tissue at either end.
  if (ground.bodies < 2) {
    const bool behind = old.tip_arc <= 0.5 * path.length();
    const int tet = behind ? first_tet(path) : last_tet(path);
    const Vec3 X = inside ? inside->X : tissue.reference_place_continued(x, tet);
    return {X, arc_nearest(path, X), tet, inside.has_value(), behind};
  }
  const auto within = inside ? run_in(ground, path, inside->tet) : std::nullopt;
  const PathRun run = within ? *within : run_at(path, std::clamp(old.tip_arc, 0.0, path.length()));
  const bool behind = old.tip_arc <= 0.5 * (run.begin + run.end);
  int tet = behind ? first_tet(path, run) : last_tet(path, run);
  if (tet < 0) tet = old.tip.tet;  // the tip stands on the surface of the next body
  const Vec3 X = within ? inside->X : tissue.reference_place_continued(x, tet);
  return {X, arc_nearest(path, run, X), tet, within.has_value(), behind && run.first == 0};
}

}  // namespace trocar::insertion
