#include "core/polar.hpp"
#include "tissue/tissue.hpp"

// Rotations of the nodes, by which a lagged factor is turned.
namespace trocar::tissue {

/// Rotation of every node since the factor was made, in file order: the polar rotation of the
/// volume-weighted mean over the tets around the node. Nodes with a fixed axis get the identity,
/// because their supports do not turn. Collective.
std::vector<Mat3> Tissue::node_rotations(const std::vector<Mat3>& R,
                                         const std::vector<Mat3>& R_factor) const
{
  const std::vector<Mat3> sum = elements_->turns(R, R_factor);
  std::array<OwnedField, 3> column{space_->zero(), space_->zero(), space_->zero()};
  for (int local = 0; local < space_->owned(); ++local) {
    const bool held = fixed_.axes_of_number(space_->first() + local) != 0;
    const Mat3& mean = sum[static_cast<std::size_t>(local)];
    const bool turns = !held && mean.determinant() > 0.0;
    const Mat3 turn = turns ? core::polar_rotation(mean) : Mat3::Identity();
    for (int a = 0; a < 3; ++a) column[static_cast<std::size_t>(a)].node(local) = turn.col(a);
  }
  std::vector<Mat3> turned(static_cast<std::size_t>(space_->global()));
  for (int a = 0; a < 3; ++a) {
    const fem::GlobalField all = space_->gather(column[static_cast<std::size_t>(a)]);
    for (int node = 0; node < space_->global(); ++node)
      turned[static_cast<std::size_t>(node)].col(a) = all.node(node);
  }
  return turned;
}

}  // namespace trocar::tissue
