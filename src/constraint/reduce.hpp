#pragma once

#include <vector>

#include "constraint/set.hpp"
#include "fem/space.hpp"
#include "solve/isolated_compliance.hpp"

namespace trocar::constraint {

/// The dense problem of a set, and how its compliance was come by.
struct Reduced
{
  law::Problem problem;
  solve::ComplianceReport compliance;
};

/// W = Ĥ C Ĥᵀ + H_n A_n⁻¹ H_nᵀ  and  g = gap + H u_free - H_n w_free  (paper eq. 3), with C the
/// isolated compliance and w the increments of the small bodies. `free_increment` is the tissue's
/// free motion. Equal on every rank. Collective.
Reduced reduce(const Set& set, const fem::Space& space, const fem::OwnedField& free_increment,
               solve::IsolatedCompliance& compliance, const std::vector<SmallBody>& bodies);

/// Hᵀλ on the tissue: nodal forces of the owned nodes [N]. Not collective.
fem::OwnedField tissue_forces(const Set& set, const core::VecX& lambda, const fem::Space& space);

/// H_nᵀλ of one small body on all its dofs [N, N m]; the body feels the negative.
core::VecX body_forces(const Set& set, const core::VecX& lambda, int body, Eigen::Index dofs);

}  // namespace trocar::constraint
