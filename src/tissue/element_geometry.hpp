#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "tissue/elements_of.hpp"

// Geometry and rotations of the tets: definitions that only linear_tets.cpp and quadratic_tets.cpp
// include.
namespace trocar::tissue {

template <int N>
ElementsOf<N>::ElementsOf(const mesh::Mesh& mesh, const fem::Space& space,
                          const ElementSettings& settings)
    : space_(&space), settings_(settings), exact_(settings.exact_tangent())
{
  shapes_.reserve(points * space.tets());
  for (std::size_t e = 0; e < space.tets(); ++e) {
    double volume = 0.0;
    for (const auto& shape : fem::point_shapes<N>(mesh, space.file_tet(e))) {
      shapes_.push_back(shape);
      volume += shape.volume;
    }
    volume_.push_back(volume);
    region_.push_back(mesh.region[static_cast<std::size_t>(space.file_tet(e))]);
  }
  for (std::size_t volume = 0; volume < settings_.materials.size(); ++volume)
    models_.push_back(settings_.model_of(volume));
  if (settings_.any(Model::linear) && !settings_.all_linear())
    for (std::size_t point = 0; point < shapes_.size(); ++point)
      if (model(point / points) != Model::linear) turning_.push_back(point);
  straight_mass_ = fem::straight_mass<N>();
  if constexpr (N == 10) measure_curved_masses(mesh);
  if (settings_.mass == Mass::lumped) lump_masses();
  if (settings_.dilatation != Dilatation::nodal) return;
  patches_ = corner_patches(space, region_);
  const auto share = fem::corner_weights<N>();
  for (std::size_t v = 0; v < patches_->size(); ++v)
    for (std::size_t k = patches_->start[v]; k < patches_->start[v + 1]; ++k)
      for (std::size_t q = 0; q < points; ++q)
        patches_->measure[v] += shapes_[points * patches_->member[k].tet + q].volume *
                                share(patches_->member[k].corner, static_cast<Eigen::Index>(q));
  cliques_ = patch_nodes(*patches_, space);
}

/// Calls f(barycentric coordinates, weight) for every Gauss point of a tet; the weights sum to 1.
/// Exact to degree 7: five Gauss-Legendre points in each of three collapsed coordinates.
template <class F>
void integrate_tet(const F& f)
{
  constexpr std::array<double, 5> x{-0.9061798459386640, -0.5384693101056831, 0.0,
                                    0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 5> w{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                    0.4786286704993665, 0.2369268850561891};
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j)
      for (std::size_t k = 0; k < 5; ++k) {
        const double a = 0.5 * (1.0 + x[i]), b = 0.5 * (1.0 + x[j]), c = 0.5 * (1.0 + x[k]);
        const double weight = 6.0 * 0.125 * w[i] * w[j] * w[k] * (1.0 - a) * (1.0 - a) * (1.0 - b);
        f(Eigen::Vector4d((1.0 - a) * (1.0 - b) * (1.0 - c), a, (1.0 - a) * b,
                          (1.0 - a) * (1.0 - b) * c),
          weight);
      }
}

template <int N>
void ElementsOf<N>::measure_curved_masses(const mesh::Mesh& mesh)
{
  for (std::size_t e = 0; e < tets(); ++e) {
    const mesh::TetPositions x = mesh::positions(mesh, space_->file_tet(e));
    if (mesh::is_straight(x)) continue;
    Scalar& mass = curved_mass_[e];
    mass.setZero();
    integrate_tet([&](const Eigen::Vector4d& at, double weight) {
      if constexpr (N == 10) {
        const Eigen::Matrix<double, N, 1> shape = mesh::quadratic_shape(at);
        mass += fem::quadratic_point(x, at, weight).volume * shape * shape.transpose();
      }
    });
  }
}

/// Keeps the diagonal of the consistent mass, scaled to the whole mass of the tet (Hinton, Rock and
/// Zienkiewicz 1976). A node of a linear tet gets a quarter of it.
template <int N>
void ElementsOf<N>::lump_masses()
{
  const auto lump = [](Scalar& mass) {
    double total = 0.0;
    for (double entry : mass.reshaped()) total += entry;
    const Eigen::Matrix<double, N, 1> diagonal = total / mass.trace() * mass.diagonal();
    mass = diagonal.asDiagonal();
  };
  lump(straight_mass_);
  for (auto& [e, mass] : curved_mass_) lump(mass);
}

/// Deformation gradients F of the points point_of(first) to point_of(first + count - 1), one per
/// SIMD lane. The remaining lanes repeat the last of these points.
template <int N>
template <class PointOf>
void ElementsOf<N>::gather_gradients(const GhostedField& u, const PointOf& point_of,
                                     std::size_t first, std::size_t count,
                                     core::PolarBatch::Matrix& F) const
{
  constexpr int width = core::PolarBatch::width;
  std::array<core::PolarBatch::Lanes, 3 * N> values, gradients;
  for (int lane = 0; lane < width; ++lane) {
    const std::size_t point = point_of(first + std::min(static_cast<std::size_t>(lane), count - 1));
    const double* g = shapes_[point].gradient.data();
    const auto nodes = space_->nodes(point / points);
    for (std::size_t a = 0; a < N; ++a) {
      const double* w = u.value.data() + 3 * nodes[a];
      for (std::size_t i = 0; i < 3; ++i) {
        values[3 * a + i][lane] = w[i];
        gradients[3 * a + i][lane] = g[3 * a + i];
      }
    }
  }
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      core::PolarBatch::Lanes sum = core::PolarBatch::Lanes::Constant(i == j ? 1.0 : 0.0);
      for (std::size_t a = 0; a < N; ++a) sum += values[3 * a + i] * gradients[3 * a + j];
      F[3 * j + i] = sum;
    }
}

template <int N>
Folded ElementsOf<N>::folded(const GhostedField& u) const
{
  Folded found;
  for (std::size_t e = 0; e < tets(); ++e) {
    int& first = model(e) == Model::linear ? found.linear : found.other;
    if (first >= 0) continue;
    const Nodal w = nodal(u, e);
    for (std::size_t q = 0; q < points && first < 0; ++q)
      if (!((Mat3::Identity() + gradient(w, points * e + q)).determinant() > 0.0))
        first = space_->file_tet(e);
  }
  return found;
}

/// Writes the polar rotations of the points point_of(0) to point_of(count - 1) to R. Returns
/// false where a tet is inverted; the batch with this tet and all later batches then get
/// identities.
template <int N>
template <class PointOf>
bool ElementsOf<N>::rotate(const GhostedField& u, const PointOf& point_of, std::size_t count,
                           std::vector<Mat3>& R) const
{
  constexpr std::size_t width = core::PolarBatch::width;
  core::PolarBatch batch;
  for (std::size_t first = 0; first < count; first += width) {
    const std::size_t lanes = std::min(width, count - first);
    gather_gradients(u, point_of, first, lanes, batch.matrix());
    if (!(batch.determinant() > 0.0).all()) {
      for (std::size_t k = first; k < count; ++k) R[point_of(k)] = Mat3::Identity();
      return false;
    }
    batch.rotate();
    for (std::size_t lane = 0; lane < lanes; ++lane)
      R[point_of(first + lane)] = batch.get(static_cast<int>(lane));
  }
  return true;
}

template <int N>
bool ElementsOf<N>::configure(const GhostedField& u, LinearisationPoint& at) const
{
  const std::size_t count = shapes_.size();
  if (at.R.size() != count) at.R.assign(count, Mat3::Identity());
  if (settings_.all_linear()) return true;
  at.G.resize(exact() ? count : 0);
  if (!exact()) at.p.resize(0);
  const bool all = !settings_.any(Model::linear);
  const auto point_of = [&](std::size_t k) { return all ? k : turning_[k]; };
  if (!rotate(u, point_of, all ? count : turning_.size(), at.R)) return false;
  if (!exact()) return true;
  for (std::size_t point = 0; point < count; ++point)
    at.G[point] = gradient(nodal(u, point / points), point);
  at.p = pressures(at, {u, {}, {}});
  return true;
}

template <int N>
std::vector<std::size_t> ElementsOf<N>::with_patches(const std::vector<std::size_t>& tets) const
{
  if (!patches_) return tets;
  std::vector<bool> wanted(volume_.size(), false);
  for (std::size_t e : tets)
    for (int v : patches_->of_tet[e]) {
      if (v < 0) continue;
      const auto patch = static_cast<std::size_t>(v);
      for (std::size_t k = patches_->start[patch]; k < patches_->start[patch + 1]; ++k)
        wanted[patches_->member[k].tet] = true;
    }
  std::vector<std::size_t> found;
  for (std::size_t e = 0; e < wanted.size(); ++e)
    if (wanted[e]) found.push_back(e);
  return found;
}

template <int N>
void ElementsOf<N>::configure_for(const std::vector<std::size_t>& tets, const GhostedField& u,
                                  LinearisationPoint& at) const
{
  at.R.assign(shapes_.size(), Mat3::Identity());
  if (!settings_.any(Model::corotational)) return;
  std::vector<std::size_t> here = with_patches(tets);
  std::erase_if(here, [this](std::size_t e) { return model(e) != Model::corotational; });
  const auto point_of = [&](std::size_t k) { return points * here[k / points] + k % points; };
  rotate(u, point_of, points * here.size(), at.R);
}

template <int N>
std::vector<Mat3> ElementsOf<N>::turns(const std::vector<Mat3>& R,
                                       const std::vector<Mat3>& R_old) const
{
  std::vector<Mat3> sum(static_cast<std::size_t>(space_->local()), Mat3::Zero());
  for (std::size_t e = 0; e < tets(); ++e) {
    Mat3 turn = Mat3::Zero();
    for (std::size_t point = points * e; point < points * (e + 1); ++point)
      turn += shapes_[point].volume * R[point] * R_old[point].transpose();
    for (int node : space_->nodes(e)) sum[static_cast<std::size_t>(node)] += turn;
  }
  const bool mixed = !turning_.empty();
  for (std::size_t e = 0; mixed && e < tets(); ++e)
    if (model(e) == Model::linear)
      for (int node : space_->nodes(e)) sum[static_cast<std::size_t>(node)].setIdentity();
  return sum;
}

}  // namespace trocar::tissue
