#include "core/math.hpp"
#include "step/simulation.hpp"

namespace trocar::step {

// Where the energy of a step went. Rows do work λ·δ only in slip: the rest of it passes from needle
// to tissue and is in neither account.
void Simulation::account(const State& old, const State& past, const core::TimeStep& now,
                         const Pass& pass, const cavity::Shape& walls, const StepReport& report,
                         State& next) const
{
  const tissue::Work tissue =
      tissue_.work(old.tissue, past.tissue, next.tissue, now, all_forces(pass, next, walls, now));
  EnergyAccount& energy = next.energy;
  energy = old.energy;
  energy.elastic = tissue.elastic;
  energy.kinetic = tissue.kinetic;
  energy.supplied += tissue.supplied;
  if (cavities_)  // by the pressures of the fluids
    energy.supplied += space_.dot(cavities_->forces(next.cavities, walls, now),
                                  {next.tissue.u.value - old.tissue.u.value});
  energy.damping += tissue.damped;
  for (std::size_t i = 0; i < needles_.size(); ++i) {
    const needle::Energy needle = needles_[i].energy(old.needles[i], next.needles[i]);
    energy.elastic += needle.elastic;
    energy.kinetic += needle.kinetic;
    const NeedleReport& done = report.needles[i];
    const needle::Shaft& from = old.needles[i].shaft;
    const needle::Shaft& to = next.needles[i].shaft;
    const Vec3 turn = core::rotation_log(to.R.front() * from.R.front().transpose());
    energy.supplied += needle.weight + done.base.force.dot(to.x.front() - from.x.front()) +
                       done.base.moment.dot(turn);
    energy.friction -= done.coupling.friction_work;
    energy.cutting -= done.coupling.cutting_work;
  }
  // The start has no history: what it stores is where the account begins.
  if (now.start) {
    const double stored = energy.elastic + energy.kinetic;
    energy = {energy.elastic, energy.kinetic, stored, 0.0, 0.0, 0.0, 0.0};
  }
}

}  // namespace trocar::step
