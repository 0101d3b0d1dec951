#pragma once

#include <Eigen/Sparse>
#include <functional>
#include <string>

#include "constraint/set.hpp"

namespace trocar::constraint {

/// The rows of one linearisation with their maps, made once: Ĥ from the probed dofs of the tissue
/// to the rows, H_n from the dofs of every small body, and the compliance that rows have of their
/// own, whatever the tissue does: needles, networks, compliance.
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

  /// W = Ĥ C Ĥᵀ + own compliance (rows x rows) [m/N] (paper eq. 3), C being that of the probes.
  core::MatX compliance(const core::MatX& C) const;
  /// The dense problem with g = gap + Ĥ u_free - Σ H_n w_free, `free` the tissue's free motion at
  /// the probes from where the gaps were measured [m].
  law::Problem problem(const core::MatX& W, const core::VecX& free) const;

  core::VecX row_displacements(const core::VecX& probed) const { return H_ * probed; }  ///< Ĥ u
  core::VecX probe_forces(const core::VecX& lambda) const { return H_.transpose() * lambda; }
  /// Ĥᵀλ on the tissue [N]. Not collective.
  solve::OwnedField forces(const core::VecX& lambda, const fem::Space& space) const;
  /// H_nᵀλ of one body on all its dofs [N, N m]; the body feels the negative.
  core::VecX body_forces(const core::VecX& lambda, int body) const;
  /// aᵀ (own compliance) b [J]: what bodies and soft rows take of the rows' work.
  double yielded(const core::VecX& a, const core::VecX& b) const;

  /// Laws that bend: linearised anew where multipliers have led, they change gaps and couplings of
  /// their rows. False when they were right.
  std::function<bool(const core::VecX& lambda, Set& set)> relinearise{};
  bool settle(const core::VecX& lambda);
  /// What a row belongs to and where it is, for messages.
  std::function<std::string(int row)> place{};

 private:
  void gather_compliance();

  Set set_;
  std::vector<SmallBody> bodies_;
  solve::Probes probes_;
  Sparse H_;
  std::vector<Sparse> jacobians_;  ///< H_n, by body (rows x its dofs)
  Sparse of_bodies_, own_;         ///< H_n A_n⁻¹ H_nᵀ; with couplings
};

}  // namespace trocar::constraint
