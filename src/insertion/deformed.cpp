#include "insertion/deformed.hpp"

#include <algorithm>
#include <cmath>

#include "insertion/clip.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::insertion {
namespace {

constexpr double inside = -1e-6;  ///< barycentric slack of "in the tet", as for the path

}  // namespace

Deformed::Deformed(const mesh::Mesh& mesh, const mesh::Locator& locator, const fem::GlobalField& u)
    : mesh_(&mesh),
      locator_(&locator),
      u_(&u),
      largest_displacement_(u.value.size() ? u.value.cwiseAbs().maxCoeff() : 0.0)
{
}

Vec3 Deformed::position(const constraint::Anchor& anchor) const
{
  return anchor.mean([this](int node) -> Vec3 {
    return mesh_->x[static_cast<std::size_t>(node)] + u_->node(node);
  });
}

Vec3 Deformed::place(const Vec3& X, int tet) const
{
  const Eigen::Vector4d at = mesh::local_coordinates(mesh::positions(*mesh_, tet), X);
  return positions_now(tet) * mesh::node_weights(*mesh_, at);
}

mesh::TetPositions Deformed::positions_now(int tet) const
{
  mesh::TetPositions x = mesh::positions(*mesh_, tet);
  Eigen::Index a = 0;
  for (int node : mesh::nodes_of(*mesh_, tet)) x.col(a++) += u_->node(node);
  return x;
}

std::array<Vec3, 4> Deformed::corners_now(int tet) const
{
  std::array<Vec3, 4> corner = mesh::corners(*mesh_, tet);
  for (std::size_t a = 0; a < 4; ++a)
    corner[a] += u_->node(mesh_->tets[static_cast<std::size_t>(tet)][a]);
  return corner;
}

std::vector<int> Deformed::candidates(const Vec3& low, const Vec3& high) const
{
  const Vec3 reach = Vec3::Constant(1.001 * largest_displacement_ + 1e-9);
  return locator_->in_box(low - reach, high + reach);
}

Vec3 Deformed::pull_back(int tet, const Vec3& x) const
{
  const Eigen::Vector4d at = mesh::local_coordinates(positions_now(tet), x);
  return mesh::positions(*mesh_, tet) * mesh::node_weights(*mesh_, at);
}

std::optional<Vec3> Deformed::reference_place(const Vec3& x, const Vec3& guess) const
{
  const auto search = [&](const std::vector<int>& tets) -> std::optional<Vec3> {
    for (int tet : tets)
      if (mesh::local_coordinates(positions_now(tet), x).minCoeff() >= inside)
        return pull_back(tet, x);
    return std::nullopt;
  };
  const Vec3 near = Vec3::Constant(1e-9);
  if (auto found = search(locator_->in_box(guess - near, guess + near))) return found;
  return search(candidates(x, x));
}

/// Where the segment P Q goes through the face of a quadratic tet by which it goes into its
/// corners' tet at `t`, `stretch` long: the zero of that coordinate along it, by the secant; t
/// itself when there is none near.
double Deformed::through_curved_face(int tet, const Vec3& P, const Vec3& Q, double t,
                                     double stretch) const
{
  const mesh::TetPositions x = positions_now(tet);
  Eigen::Index face = 0;
  mesh::barycentric(corners_now(tet), P + t * (Q - P)).cwiseAbs().minCoeff(&face);
  const auto beyond = [&](double s) -> double {
    return mesh::local_coordinates(x, P + s * (Q - P))[face];
  };
  constexpr int most = 10;
  double before = t, after = t + 1e-3 * stretch;
  double at_before = beyond(before), at_after = beyond(after);
  for (int k = 0; k < most && std::abs(at_before) > 1e-12 && at_after != at_before; ++k) {
    const double next = before - at_before * (after - before) / (at_after - at_before);
    after = before;
    at_after = at_before;
    before = next;
    at_before = beyond(before);
  }
  const bool found = std::abs(at_before) <= 1e-9 && std::abs(before - t) <= stretch;
  return found ? before : t;
}

Vec3 Deformed::reference_place_continued(const Vec3& x, int tet) const
{
  return pull_back(tet, x);
}

std::optional<Vec3> Deformed::entry(const Vec3& P, const Vec3& Q) const
{
  struct Stretch
  {
    double low, high;
    int tet;
  };
  std::vector<Stretch> stretches;
  for (int tet : candidates(P.cwiseMin(Q), P.cwiseMax(Q))) {
    const auto span = clip_line(corners_now(tet), P, Q);
    if (span && span->high > 0.0 && span->low < 1.0)
      stretches.push_back({span->low, span->high, tet});
  }
  std::sort(stretches.begin(), stretches.end(), [](const auto& a, const auto& b) {
    return a.low != b.low ? a.low > b.low : a.tet < b.tet;
  });
  // Walk back from Q through touching stretches: the last one reached begins at the surface.
  double reached = 1.0;
  const Stretch* first = nullptr;
  constexpr double touch = 1e-6;
  for (const Stretch& stretch : stretches) {
    if (stretch.high < reached - touch) continue;
    if (stretch.low < reached) {
      reached = stretch.low;
      first = &stretch;
    }
  }
  if (!first) return std::nullopt;
  if (mesh_->quadratic() && first->low > 0.0) {
    const double t = through_curved_face(first->tet, P, Q, first->low, first->high - first->low);
    return pull_back(first->tet, P + std::max(t, 0.0) * (Q - P));
  }
  return pull_back(first->tet, P + std::max(first->low, 0.0) * (Q - P));
}

bool Deformed::meets(const Vec3& P, const Vec3& Q) const
{
  for (int tet : candidates(P.cwiseMin(Q), P.cwiseMax(Q))) {
    const auto span = clip_line(corners_now(tet), P, Q);
    if (span && span->high >= -1e-6 && span->low <= 1.0 + 1e-6 && span->high > span->low)
      return true;
  }
  return false;
}

}  // namespace trocar::insertion
