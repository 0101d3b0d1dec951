#include "tissue/element_blocks.hpp"
#include "tissue/elements_of.hpp"

#include <vector>

// Assembles the operator of the tets. This has a file of its own because it takes as long to
// compile as the rest of ElementsOf.
namespace trocar::tissue {

template <int N>
void ElementsOf<N>::assemble(const LinearisationPoint& at, const core::Rates& rate,
                             const fem::BlockPattern& pattern, fem::BlockMatrix& values) const
{
  for (std::size_t e = 0; e < tets(); ++e) {
    const Material& m = material(e);
    const double scale_k = 1.0 + m.rayleigh_stiffness * rate.velocity;
    const double scale_m =
        ((rate.acceleration + m.rayleigh_mass) * rate.velocity + rate.mass) * m.density;
    const auto slots = pattern.slots(e);
    const fem::PointShape<N>* shape = &shapes_[points * e];
    const Mat3* R = &at.R[points * e];
    const double lambda = exact() ? 0.0 : scale_k * lambda_at_point(m);
    fem::ElementBlocks<N> blocks =
        operator_blocks<N>(lambda, exact() ? 0.0 : scale_k * m.mu(), shape, R, mass_form(e),
                           scale_m * mass_factor(e), slots);
    for (std::size_t q = 0; exact() && q < points; ++q)
      add_tangent<N>(
          shape[q], [&](const Mat3& D) { return increment(at, rate, points * e + q, D); }, slots,
          blocks);
    if (settings_.dilatation == Dilatation::element) {
      Nodal sum = Nodal::Zero();
      for (std::size_t q = 0; q < points; ++q)
        sum += shape[q].volume * dilatation_gradient(at, points * e + q) * shape[q].gradient;
      add_rank_one<N>(sum, scale_k * lambda_of_mean(m) / volume_[e], slots, blocks);
    }
    values.add(slots, blocks);
  }
  if (patches_) add_patches(at, rate, pattern, values);
}

template <int N>
void ElementsOf<N>::add_patches(const LinearisationPoint& at, const core::Rates& rate,
                                const fem::BlockPattern& pattern, fem::BlockMatrix& values) const
{
  const auto share = fem::corner_weights<N>();
  std::vector<int> place(static_cast<std::size_t>(space_->local()));
  Eigen::Matrix3Xd b;
  for (std::size_t v = 0; v < patches_->size(); ++v) {
    const auto nodes = cliques_.nodes(v);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      place[static_cast<std::size_t>(nodes[i])] = static_cast<int>(i);
    b.setZero(3, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t k = patches_->start[v]; k < patches_->start[v + 1]; ++k) {
      const Patches::Member& member = patches_->member[k];
      const auto of_tet = space_->nodes(member.tet);
      for (std::size_t q = 0; q < points; ++q) {
        const std::size_t point = points * member.tet + q;
        const Nodal part = share(member.corner, static_cast<Eigen::Index>(q)) *
                           shapes_[point].volume * dilatation_gradient(at, point) *
                           shapes_[point].gradient;
        for (std::size_t a = 0; a < N; ++a)
          b.col(place[static_cast<std::size_t>(of_tet[a])]) +=
              part.col(static_cast<Eigen::Index>(a));
      }
    }
    const Material& m = settings_.materials[static_cast<std::size_t>(patches_->region[v])];
    const double scale_k = 1.0 + m.rayleigh_stiffness * rate.velocity;
    values.add_rank_one(pattern.clique_slots(v), b,
                        scale_k * lambda_of_mean(m) / patches_->measure[v]);
  }
}

template void ElementsOf<4>::assemble(const LinearisationPoint&, const core::Rates&,
                                      const fem::BlockPattern&, fem::BlockMatrix&) const;
template void ElementsOf<10>::assemble(const LinearisationPoint&, const core::Rates&,
                                       const fem::BlockPattern&, fem::BlockMatrix&) const;

}  // namespace trocar::tissue
