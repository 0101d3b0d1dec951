#include "tissue/element.hpp"

namespace trocar::tissue {

StressField Tissue::stresses(const OwnedField& u) const
{
  const auto u_g = space_->with_ghosts(u);
  std::vector<Mat3> R;
  rotations(u_g, R);
  StressField field{core::VecX::Zero(6 * mesh_->tet_count()), core::VecX::Zero(mesh_->tet_count())};
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const auto& tet = space_->tets()[e];
    if (tet.nodes[0] >= space_->owned()) continue;  // the owner of its first node has it
    const Material& m = settings_.materials[static_cast<std::size_t>(elements_[e].region)];
    const Mat3 F = Mat3::Identity() + nodal_gradient(elements_[e].shape, nodal_values(u_g, tet));
    const Mat3 P = stress(m, R[e], F, Mat3::Zero());
    const Mat3 s = settings_.model == Model::linear ? P : cauchy_stress(P, F);
    field.stress.segment<6>(6 * tet.file_tet) << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2),
        s(0, 2);
    field.energy[tet.file_tet] = 0.5 * strain_square(m, corotational_strain(R[e], F));
  }
  space_->comm().sum(field.stress);
  space_->comm().sum(field.energy);
  ++ledger_->stress_evaluations;
  return field;
}

}  // namespace trocar::tissue
