#pragma once

#include "support/scene.hpp"

namespace trocar::test {

/// Physical surface of the faces on the boundary whose nodes all fulfil a condition.
void add_surface(mesh::Mesh& mesh, const std::string& name,
                 const std::function<bool(const core::Vec3&)>& on);

/// Linear tissue of one material around one cavity "fluid" whose wall is the surface "wall": one
/// equilibrium, supports and law left to the test.
driver::Scenario fluid_filled(mesh::Mesh mesh, const tissue::Material& material,
                              cavity::Model model);

/// A block of n³ cells of edge 1 cm, held below, with a void in the middle (surface "wall") of
/// `hole` cells each way, and one cavity "bladder" of constant volume. Static, linear tissue, no
/// needle.
driver::Scenario cavity_scenario(int n, int hole, cavity::Model model,
                                 cavity::Solver solver = cavity::Solver::newton);

}  // namespace trocar::test
