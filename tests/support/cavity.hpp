#pragma once

#include <functional>
#include <string>

#include "support/scene.hpp"

namespace trocar::test {

/// Physical surface of the faces on the boundary whose nodes all fulfil a condition.
void add_surface(mesh::Mesh& mesh, const std::string& name,
                 const std::function<bool(const core::Vec3&)>& on);

/// Linear tissue of one material around one cavity "fluid" whose wall is the surface "wall": one
/// equilibrium, supports and law left to the test.
step::Scene fluid_filled(mesh::Mesh mesh, const tissue::Material& material, cavity::Model model);

/// A block of n³ cells of edge 1 cm, held below, with a void in the middle (surface "wall") of
/// `hole` cells each way, and one cavity "bladder" of constant volume. Static, linear tissue, no
/// needle.
step::Scene cavity_scenario(int n, int hole, cavity::Model model,
                            cavity::Solver solver = cavity::Solver::newton);

/// A plate bonded to the top that presses by this part of the block's height.
void press(step::Scene& scenario, double depth);

/// A rigid needle with friction straight through the block beside the cavity, or into it.
void add_needle(step::Scene& scenario, double y);

/// The start of a simulation's run; throws why it was rejected.
step::Outcome<step::Accepted> solved(step::Model& simulation);
/// The report of it, when the simulation itself is not looked at.
step::StepReport solved(const step::Scene& scenario);

}  // namespace trocar::test
