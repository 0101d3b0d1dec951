#include "step/state_indices.hpp"

#include "core/failure.hpp"

namespace trocar::step {
namespace {

/// Throws Failure (65) when an index of a line is out of range, or its lists do not fit.
/// `sound`: checks an anchor.
template <class Sound>
void refuse_indices_of_nothing(const insertion::Line& line, std::size_t tets, const Sound& sound)
{
  const auto within = [](int index, std::size_t count) {
    if (index < 0 || index >= static_cast<int>(count))
      throw core::data_error("an index of it is that of nothing");
  };
  std::size_t nodes = line.nodes.size();
  for (auto s = line.stretches.rbegin(); s != line.stretches.rend(); ++s) {
    within(s->tet, tets);
    within(s->first + 1, nodes);  // every stretch has two nodes at least
    nodes = static_cast<std::size_t>(s->first);
  }
  for (const insertion::LineNode& node : line.nodes) within(node.stretch, line.stretches.size());
  for (const insertion::Segment& segment : line.segments) {
    within(segment.stretch, line.stretches.size());
    within(segment.tet, tets);
  }
  for (const auto* stations : {&line.stations, &line.open})
    for (const insertion::Station& station : *stations) {
      within(station.stretch, line.stretches.size());
      within(station.tet, tets);
      sound(station.ring);
    }
  if (line.stations.size() != 2 * line.segments.size() || line.behind < 0 ||
      line.behind > static_cast<int>(line.stations.size()))
    throw core::data_error("a line of it has not two stations for every segment");
}

}  // namespace

void refuse_indices_of_nothing(const State& state, const fem::Space& space)
{
  const auto among = [](int index, int lowest, std::size_t count) {
    if (index < lowest || index >= static_cast<int>(count))
      throw core::data_error("an index of it is that of nothing");
  };
  const auto tets = static_cast<std::size_t>(space.tets_of_mesh());
  const auto nodes = static_cast<std::size_t>(space.global());
  const auto sound = [&](const constraint::Anchor& anchor) {
    for (int node : anchor.node) among(node, 0, nodes);
    if (anchor.weight.size() != static_cast<Eigen::Index>(anchor.node.size()))
      throw core::data_error("a place of it has not as many weights as nodes");
  };
  for (const needle::NeedleState& one : state.needles) {
    const std::size_t size = one.shaft.x.size();
    if (size < 2 || one.shaft.R.size() != size || one.v.size() != size || one.w.size() != size)
      throw core::data_error("a needle of it has no such nodes");
  }
  for (const insertion::InsertionState& one : state.insertions) {
    among(static_cast<int>(one.phase), 0,
          static_cast<std::size_t>(insertion::Phase::withdrawn) + 1);
    for (const insertion::Piece& piece : one.path.pieces) among(piece.tet, -1, tets);
    for (const insertion::Site& site : one.path.sites) {
      among(site.tet, 0, tets);
      sound(site.anchor);
    }
    refuse_indices_of_nothing(one.path.line, tets, sound);
    for (const insertion::CouplingPoint& point : one.points)
      among(point.site, 0, one.path.sites.size());
    among(one.tip.tet, -1, tets);
    sound(one.tip.hold);
    if (one.path.vertex.size() != one.path.arc.size())
      throw core::data_error("a path of it has not as many lengths as corners");
    int before = 0;
    for (int jump : one.path.jumps) {
      among(jump, before + 1, one.path.vertex.size());
      before = jump;
    }
  }
  for (const contact::PairState& pair : state.contact.pairs) {
    int before = -1;
    for (const contact::Touch& touch : pair.touches) {
      among(touch.node, before + 1, nodes);
      before = touch.node;
      sound(touch.slave);
      sound(touch.master);
    }
    before = -1;
    for (const contact::Overlapped& one : pair.overlapped) {
      among(one.node, before + 1, nodes);
      before = one.node;
    }
  }
}

}  // namespace trocar::step
