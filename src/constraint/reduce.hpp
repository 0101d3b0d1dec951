#pragma once

#include <vector>

#include "constraint/set.hpp"

namespace trocar::constraint {

/// W = Ĥ C Ĥᵀ + H_n A_n⁻¹ H_nᵀ  and  g = gap + H u_free - H_n w_free  (paper eq. 3), with C the
/// isolated compliance of the set's probed nodes [m/N] and `free` the tissue's free motion at them,
/// from where the gaps were measured [m]; w are the increments of the small bodies. Not collective.
law::Problem reduce(const Set& set, const core::MatX& C, const core::VecX& free,
                    const std::vector<SmallBody>& bodies);

/// Ĥ u: displacements along the rows [m] of those at the set's probed nodes, three each.
core::VecX row_displacements(const Set& set, const core::VecX& probed);

/// Ĥᵀλ: forces on the set's probed nodes [N], three each.
core::VecX probe_forces(const Set& set, const core::VecX& lambda);

/// aᵀ (H_n A_n⁻¹ H_nᵀ + c) b [J]: what small bodies and soft rows take of the rows' work.
double yielding(const Set& set, const std::vector<SmallBody>& bodies, const core::VecX& a,
                const core::VecX& b);

/// H_nᵀλ of one small body on all its dofs [N, N m]; the body feels the negative.
core::VecX body_forces(const Set& set, const core::VecX& lambda, int body, Eigen::Index dofs);

}  // namespace trocar::constraint
