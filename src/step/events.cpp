#include "step/events.hpp"

#include <algorithm>

#include "cavity/network.hpp"
#include "insertion/channel.hpp"

namespace trocar::step {
namespace {

std::optional<core::Refusal> move_needles(const Model& model, const State& old,
                                          const core::TimeStep& now, State& next)
{
  if (model.needles.empty()) return std::nullopt;
  const fem::GlobalField u = model.space.gather(old.tissue.u);
  const insertion::Deformed tissue(model.scene.mesh, *model.locator, u);
  for (std::size_t i = 0; i < model.needles.size(); ++i) {
    const needle::Shaft& shaft =
        (next.needles[i] = model.needles[i].predict(old.needles[i], next.t)).shaft;
    if (now.start) continue;
    next.insertions[i] = insertion::advance(*model.ground, old.insertions[i], shaft, tissue);
    if (insertion::off_channel(*model.ground, next.insertions[i], shaft, tissue))
      return core::Refusal{
          "needle '" + model.needles[i].settings().name +
          "': its shaft enters the tissue beside its channel (contact of shafts and surfaces is "
          "not modelled)"};
  }
  return std::nullopt;
}

/// For each needle, the stretches of its path behind the tip that lie in no tissue.
std::vector<std::vector<cavity::VoidPiece>> voids_of(const State& state)
{
  std::vector<std::vector<cavity::VoidPiece>> voids(state.needles.size());
  for (std::size_t i = 0; i < state.needles.size(); ++i) {
    const insertion::InsertionState& insertion = state.insertions[i];
    const needle::Shaft& shaft = state.needles[i].shaft;
    for (const insertion::Piece& piece : insertion.path.pieces) {
      if (piece.tet >= 0 || piece.begin >= insertion.tip_arc) continue;
      const double middle = 0.5 * (piece.begin + std::min(piece.end, insertion.tip_arc));
      voids[i].push_back({needle::shaft_at(shaft, shaft.length - (insertion.tip_arc - middle)).x,
                          insertion::tissue_length(insertion.path, piece.begin)});
    }
  }
  return voids;
}

}  // namespace

core::Outcome<State> predict(const Model& model, const State& old, const Scheme& scheme)
{
  const core::TimeStep& now = scheme.now();
  State next = old;
  next.t = now.t;
  next.h = now.is_static ? 0.0 : now.h;
  next.velocity = scheme.velocity();
  if (auto refusal = move_needles(model, old, now, next)) return std::move(*refusal);
  if (model.cavities && !now.start)
    next.cavities = cavity::advance(*model.cavities, old.cavities, {old.t, next.t, voids_of(next)},
                                    old.tissue.u);
  return next;
}

}  // namespace trocar::step
