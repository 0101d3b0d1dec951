#include "constraint/saddle.hpp"

#include <algorithm>
#include <optional>

namespace trocar::constraint {

Outcome<Saddle> direct(Laws& laws, solve::Linearisation& at, const core::VecX& start)
{
  const System& system = laws.system();
  const solve::HalfSolution& half = at.forward();
  solve::OwnedField u = at.base;
  if (system.empty()) {
    u.value += at.factor->finish(half, {}, {}).value;
  } else {
    laws.use(*at.factor);
    const solve::OwnedField ahead{at.base.value - at.iterate.value};
    const core::VecX free =
        at.factor->read(system.probes(), half) + solve::read(system.probes(), ahead, at.space());
    if (const auto met = laws.meet(*at.factor, free, start); !met) return met.refusal();
    u.value +=
        at.factor->finish(half, system.probes(), system.probe_forces(laws.multipliers())).value;
  }
  ++laws.report().passes;
  return Saddle{std::move(u), laws.take(), laws.problem()};
}

Outcome<Saddle> paper(Laws& laws, solve::Linearisation& at, const core::VecX& start,
                      const SaddleSettings& settings)
{
  System none;
  Laws lawless(none, laws.settings(), laws.report());
  const auto alone = [&](solve::Linearisation& where) -> Outcome<Saddle> {
    if (!where.lagged()) return direct(lawless, where, {});
    return projected_cg(lawless, where, {}, settings.tolerance);
  };
  const auto free = alone(at);
  if (!free) return free.refusal();
  const System& system = laws.system();
  const auto moved = [&](const solve::OwnedField& u) {
    return solve::read(system.probes(), {u.value - at.iterate.value}, at.space());
  };
  const core::VecX at_probes = moved(free->u);
  if (const auto met = laws.meet(*at.factor, at_probes, start); !met) return met.refusal();

  solve::Linearisation pushed = at;
  pushed.base = free->u;
  pushed.residual = system.forces(laws.multipliers(), at.space());
  at.factor->fixed().clear(pushed.residual);
  pushed.guess.reset();
  pushed.half.reset();
  pushed.least = 0.0;
  auto end = alone(pushed);
  if (!end) return end.refusal();
  const core::VecX thought =
      at_probes + laws.compliance() * system.probe_forces(laws.multipliers());
  const core::VecX off = system.row_displacements(moved(end->u) - thought);
  double& leftover = laws.report().leftover_gap;
  leftover = std::max(leftover, off.cwiseAbs().maxCoeff());
  return Saddle{std::move(end->u), laws.take(), laws.problem()};
}

Outcome<Saddle> solve_saddle(Laws& laws, solve::Linearisation& at, const core::VecX& start,
                             const SaddleSettings& settings)
{
  if (!at.lagged()) return direct(laws, at, start);
  const bool stale = settings.stale && !laws.system().empty();
  if (!stale) return projected_cg(laws, at, start, settings.tolerance);
  std::optional<solve::OwnedField> exact;
  if (settings.stale_error) {
    const auto beside = projected_cg(laws, at, start, settings.tolerance);
    if (!beside) return beside.refusal();
    exact = beside->u;
  }
  auto end = paper(laws, at, start, settings);
  if (end && exact) {
    const solve::OwnedField difference{end->u.value - exact->value};
    const double mine = difference.value.size() > 0 ? difference.value.cwiseAbs().maxCoeff() : 0.0;
    double& error = laws.report().stale_error;
    error = std::max(error, at.space().comm().max(mine));
  }
  return end;
}

}  // namespace trocar::constraint
