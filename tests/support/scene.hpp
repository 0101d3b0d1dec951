#pragma once

#include <string>
#include <vector>

#include "step/time_stepper.hpp"
#include "support/block.hpp"

namespace trocar::test {

/// One tissue with the same friction in both directions.
inline std::vector<insertion::TissueFriction> same(const insertion::Friction& friction)
{
  return {{friction, friction}};
}

/// The block of `needle_scenario` in cells of 1 cm, and in smaller ones with their nodes moved
/// about.
inline const BlockShape plain{6, 4, 4, core::Vec3(0.06, 0.04, 0.04), 0.0};
inline const BlockShape distorted{8, 5, 5, core::Vec3(0.06, 0.04, 0.04), 0.25};

/// A needle through a block 6 x 4 x 4 cm, held below; a scenario that tests change as they like.
step::Scene needle_scenario(const BlockShape& shape);

/// All steps of a scenario's run, state and report of each (the start included). Throws when a
/// step is rejected.
struct Run
{
  std::vector<step::State> states;
  std::vector<step::StepReport> reports;
  core::Ledger ledger;
};
Run run(const step::Scene& scenario);
/// The same with steps of given lengths [s], whatever the scenario says of them.
Run run(const step::Scene& scenario, const std::vector<double>& lengths);

}  // namespace trocar::test
