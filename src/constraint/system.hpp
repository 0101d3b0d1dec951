#pragma once

#include <Eigen/Sparse>
#include <functional>
#include <string>

#include "constraint/set.hpp"

namespace trocar::constraint {

/// The rows of one linearisation with matrices that are made once: Ĥ maps the probed dofs of the
/// tissue to the rows, H_n the dofs of every small body. The rows' own compliance is what does not
/// come from the tissue: that of small bodies and of couplings (see Set::Coupling).
///   δ = gap + Ĥ u - Σ H_n w.
class System
{
 public:
  using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  System() = default;  ///< without rows
  System(Set set, std::vector<SmallBody> bodies);

  bool empty() const { return set_.empty(); }
  int size() const { return set_.size(); }
  const Set& set() const { return set_; }
  const solve::Probes& probes() const { return probes_; }
  core::VecX starts() const { return set_.starts(); }  ///< multipliers to start from [N]

  /// W = Ĥ C Ĥᵀ + own compliance (rows x rows) [m/N] (needle paper eq. 3), C: that of the probes.
  core::MatX compliance(const core::MatX& C) const;
  /// The dense problem with g = gap + Ĥ u_free - Σ H_n w_free. `free`: u_free, the free motion of
  /// the probes from the place where the gaps were measured [m].
  law::Problem problem(const core::MatX& W, const core::VecX& free) const;

  core::VecX row_displacements(const core::VecX& probed) const { return H_ * probed; }  ///< Ĥ u
  core::VecX probe_forces(const core::VecX& lambda) const { return H_.transpose() * lambda; }
  /// Ĥᵀλ on the tissue [N]. Not collective.
  solve::OwnedField forces(const core::VecX& lambda, const fem::Space& space) const;
  /// H_nᵀλ of one body on all its dofs [N, N m]; the body feels the negative.
  core::VecX body_forces(const core::VecX& lambda, int body) const;
  /// aᵀ (own compliance and Row::compliance) b [J]: the part of bodies and compliant rows in the
  /// energy.
  double yielded(const core::VecX& a, const core::VecX& b) const;

  /// Linearises nonlinear laws (of fluids) anew at λ and changes gaps and couplings of their rows.
  /// False, and nothing changed, when the last linearisation is accurate at λ.
  std::function<bool(const core::VecX& lambda, Set& set)> relinearise{};
  /// Calls `relinearise`. True when rows have changed, so that W must be made again.
  bool settle(const core::VecX& lambda);
  /// For messages: names the needle or cavity of a row that nothing can move, and its place.
  std::function<std::string(int row)> place{};

 private:
  void gather_compliance();

  Set set_;
  std::vector<SmallBody> bodies_;
  solve::Probes probes_;
  Sparse H_;
  std::vector<Sparse> jacobians_;  ///< H_n, by body (rows x its dofs)
  Sparse of_bodies_, own_;         ///< Σ H_n A_n⁻¹ H_nᵀ; the same plus couplings
};

}  // namespace trocar::constraint
