#pragma once

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/polar.hpp"
#include "fem/shape.hpp"
#include "tissue/elements.hpp"
#include "tissue/energy.hpp"
#include "tissue/patches.hpp"

namespace trocar::tissue {

/// The element sums for tets with N nodes, 4 or 10.
template <int N>
class ElementsOf final : public Elements
{
 public:
  ElementsOf(const mesh::Mesh& mesh, const fem::Space& space, const ElementSettings& settings);

  const fem::Cliques& cliques() const override { return cliques_; }
  Folded folded(const GhostedField& u) const override;
  bool configure(const GhostedField& u, LinearisationPoint& at) const override;
  core::VecX linearised_pressures(const LinearisationPoint& last,
                                  const GhostedField& d) const override;
  void configure_for(const std::vector<std::size_t>& tets, const GhostedField& u,
                     LinearisationPoint& at) const override;
  void assemble(const LinearisationPoint& at, const core::Rates& rate,
                const fem::BlockPattern& pattern, fem::BlockMatrix& values) const override;
  OwnedField operate(const LinearisationPoint& at, const core::Rates& rate,
                     const GhostedField& d) const override;
  void add_forces(const LinearisationPoint& at, const Kinematics& motion,
                  ForceSums& sums) const override;
  void add_forces_of(const std::vector<std::size_t>& tets, const LinearisationPoint& at,
                     const Kinematics& motion, ForceSums& sums) const override;
  void add_inertia(const Kinematics& motion, OwnedField& inertia) const override;
  void take(Tangent tangent) override
  {
    settings_.tangent = tangent;
    exact_ = settings_.exact_tangent();
  }
  TetWork work(const LinearisationPoint& at, const Kinematics& motion) const override;
  StressField stresses(const LinearisationPoint& at, const GhostedField& u) const override;
  void add_weight(const core::Vec3& gravity, OwnedField& force) const override;
  std::vector<Mat3> turns(const std::vector<Mat3>& R,
                          const std::vector<Mat3>& R_old) const override;

 private:
  static constexpr std::size_t points = static_cast<std::size_t>(fem::points_per_tet<N>);
  using Nodal = Eigen::Matrix<double, 3, N>;
  using Scalar = Eigen::Matrix<double, N, N>;

  std::size_t tets() const { return region_.size(); }
  const Material& material(std::size_t e) const
  {
    return settings_.materials[static_cast<std::size_t>(region_[e])];
  }
  Model model(std::size_t e) const { return models_[static_cast<std::size_t>(region_[e])]; }
  bool averaged() const { return settings_.dilatation != Dilatation::pointwise; }
  /// Part of λ that multiplies the dilatation of the integration point itself [Pa]. The rest,
  /// `lambda_of_mean`, multiplies the averaged dilatation.
  double lambda_at_point(const Material& m) const
  {
    if (!averaged()) return m.lambda();
    const bool split = N == 10 && settings_.dilatation == Dilatation::nodal;
    return split ? std::min(m.lambda(), most_at_point * m.mu()) : 0.0;
  }
  double lambda_of_mean(const Material& m) const { return m.lambda() - lambda_at_point(m); }
  bool exact() const { return exact_; }

  Nodal nodal(const GhostedField& field, std::size_t e) const;
  void scatter(const Nodal& values, std::size_t e, OwnedField& field) const;
  Mat3 gradient(const Nodal& values, std::size_t point) const
  {
    return values * shapes_[point].gradient.transpose();
  }
  /// ∂θ/∂F at an integration point, for the state `at`.
  Mat3 dilatation_gradient(const LinearisationPoint& at, std::size_t point) const
  {
    return exact() ? energy::dilatation_gradient(model(point / points), at.R[point], at.G[point])
                   : at.R[point];
  }
  /// The mass matrix of tet e over ρ is mass_factor(e) · mass_form(e) [m³]. All straight tets share
  /// one form.
  const Scalar& mass_form(std::size_t e) const
  {
    if (N == 4 || curved_mass_.empty()) return straight_mass_;
    const auto curved = curved_mass_.find(e);
    return curved == curved_mass_.end() ? straight_mass_ : curved->second;
  }
  double mass_factor(std::size_t e) const
  {
    return &mass_form(e) == &straight_mass_ ? volume_[e] : 1.0;
  }
  template <class PointOf>
  void gather_gradients(const GhostedField& u, const PointOf& point_of, std::size_t first,
                        std::size_t count, core::PolarBatch::Matrix& F) const;
  template <class PointOf>
  bool rotate(const GhostedField& u, const PointOf& point_of, std::size_t count,
              std::vector<Mat3>& R) const;
  void measure_curved_masses(const mesh::Mesh& mesh);
  void lump_masses();
  /// Pressures λθ at the integration points [Pa] from the values of θ there, averaged as
  /// `Dilatation` says.
  core::VecX pressure_of(const core::VecX& theta) const;
  void add_averaged(const core::VecX& theta, core::VecX& p) const;
  core::VecX dilatation_rates(const LinearisationPoint& at, const GhostedField& d) const;
  void put_dilatations(std::size_t e, const LinearisationPoint& at, const Kinematics& motion,
                       core::VecX& theta) const;
  core::VecX pressures(const LinearisationPoint& at, const Kinematics& motion) const;
  /// The given tets and those that share a dilatation with one of them.
  std::vector<std::size_t> with_patches(const std::vector<std::size_t>& tets) const;
  void add_tet_forces(std::size_t e, const LinearisationPoint& at, const Kinematics& motion,
                      const core::VecX& p, ForceSums& sums) const;
  void add_sizes(std::size_t e, const Kinematics& motion, const Nodal& force, const Nodal& inertia,
                 ForceSums& sums) const;
  void add_patches(const LinearisationPoint& at, const core::Rates& rate,
                   const fem::BlockPattern& pattern, fem::BlockMatrix& values) const;
  Mat3 increment(const LinearisationPoint& at, const core::Rates& rate, std::size_t point,
                 const Mat3& D) const;

  const fem::Space* space_;
  ElementSettings settings_;
  bool exact_;                              ///< the tangent is exact
  std::vector<fem::PointShape<N>> shapes_;  ///< by integration point
  std::vector<int> region_;                 ///< volume of the mesh, by local tet
  std::vector<Model> models_;               ///< material law, by volume of the mesh
  /// Integration points of tissue that is not linear, where linear tissue exists too. Empty where
  /// all tissue is linear or none is.
  std::vector<std::size_t> turning_;
  std::vector<double> volume_;  ///< volume by local tet [m³]
  Scalar straight_mass_;        ///< mass form of a straight tet of unit volume
  std::unordered_map<std::size_t, Scalar> curved_mass_;  ///< mass form by curved tet [m³]
  fem::Cliques cliques_;
  std::optional<Patches> patches_;  ///< only with nodal dilatation
};

/// (∂P/∂F + r_v ∂P/∂Ḟ) : D of elastic and viscous stress at an integration point [Pa]. The part of
/// an averaged dilatation is left out; the caller adds it.
template <int N>
Mat3 ElementsOf<N>::increment(const LinearisationPoint& at, const core::Rates& rate,
                              std::size_t point, const Mat3& D) const
{
  const Material& m = material(point / points);
  const Model law = model(point / points);
  const Mat3& R = at.R[point];
  const Mat3 G = exact() ? at.G[point] : Mat3::Zero();
  const double damping = m.rayleigh_stiffness * rate.velocity;
  Mat3 P = m.mu() * energy::shear_increment(law, settings_.tangent, R, G, D);
  if (damping > 0.0) P += damping * m.mu() * energy::viscous_shear(law, R, G, D);
  if (exact())
    P += at.p[static_cast<Eigen::Index>(point)] *
         energy::dilatation_increment(law, settings_.tangent, R, G, D);
  const double lambda = lambda_at_point(m);
  if (lambda == 0.0) return P;
  const Mat3 by = dilatation_gradient(at, point);
  return P + (1.0 + damping) * lambda * by.cwiseProduct(D).sum() * by;
}

}  // namespace trocar::tissue
