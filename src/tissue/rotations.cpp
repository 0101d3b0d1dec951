#include <algorithm>

#include "tissue/element.hpp"
#include "tissue/tissue.hpp"

// How elements and nodes have turned.
namespace trocar::tissue {

/// F of `count` elements, one per lane; the last one fills the rest.
void Tissue::deformation_gradients(const fem::GhostedField& u, std::size_t first, std::size_t count,
                                   core::PolarBatch::Matrix& F) const
{
  constexpr int width = core::PolarBatch::width;
  std::array<core::PolarBatch::Lanes, 12> nodal, gradient;
  for (int lane = 0; lane < width; ++lane) {
    const std::size_t e = first + std::min(static_cast<std::size_t>(lane), count - 1);
    const double* g = elements_[e].shape.gradient.data();
    for (std::size_t a = 0; a < 4; ++a) {
      const double* w = u.value.data() + 3 * space_->tets()[e].nodes[a];
      for (std::size_t i = 0; i < 3; ++i) {
        nodal[3 * a + i][lane] = w[i];
        gradient[3 * a + i][lane] = g[3 * a + i];
      }
    }
  }
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      core::PolarBatch::Lanes sum = core::PolarBatch::Lanes::Constant(i == j ? 1.0 : 0.0);
      for (std::size_t a = 0; a < 4; ++a) sum += nodal[3 * a + i] * gradient[3 * a + j];
      F[3 * j + i] = sum;
    }
}

bool Tissue::rotations(const fem::GhostedField& u, std::vector<Mat3>& R) const
{
  if (settings_.model == Model::linear) {
    if (R.size() != elements_.size()) R.assign(elements_.size(), Mat3::Identity());
    return true;
  }
  R.resize(elements_.size());
  bool upright = true;
  constexpr std::size_t width = core::PolarBatch::width;
  core::PolarBatch batch;
  for (std::size_t first = 0; first < elements_.size(); first += width) {
    const std::size_t count = std::min(width, elements_.size() - first);
    deformation_gradients(u, first, count, batch.matrix());
    upright = upright && (batch.determinant() > 0.0).all();
    if (!upright) {
      std::fill(R.begin() + static_cast<std::ptrdiff_t>(first), R.end(), Mat3::Identity());
      break;
    }
    batch.rotate();
    for (std::size_t lane = 0; lane < count; ++lane)
      R[first + lane] = batch.get(static_cast<int>(lane));
  }
  return space_->comm().all(upright);
}

/// Rotations of the nodes since the factor was made, in file order: of the volume-weighted mean of
/// the tets around each. Nodes with a fixed axis do not turn: the supports do not turn with them.
std::vector<Mat3> Tissue::turned_nodes(const std::vector<Mat3>& R,
                                       const std::vector<Mat3>& R_factor) const
{
  std::vector<Mat3> sum(static_cast<std::size_t>(space_->local()), Mat3::Zero());
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Mat3 turn = elements_[e].shape.volume * R[e] * R_factor[e].transpose();
    for (int node : space_->tets()[e].nodes) sum[static_cast<std::size_t>(node)] += turn;
  }
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
