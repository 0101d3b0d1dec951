#include "insertion/deformed.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "insertion/clip.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::insertion {
namespace {

constexpr double inside = -1e-6;  ///< least coordinate that counts as in the tet, as in clip.cpp

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

std::optional<Deformed::Place> Deformed::reference_place(const Vec3& x, const Vec3& guess) const
{
  const auto search = [&](const std::vector<int>& tets) -> std::optional<Place> {
    for (int tet : tets)
      if (mesh::local_coordinates(positions_now(tet), x).minCoeff() >= inside)
        return Place{pull_back(tet, x), tet};
    return std::nullopt;
  };
  const Vec3 near = Vec3::Constant(1e-9);
  if (auto found = search(locator_->in_box(guess - near, guess + near))) return found;
  return search(candidates(x, x));
}

/// Where the segment P Q enters a quadratic tet. It enters the flat tet of the corners at `t` and
/// stays in it over `stretch` (both in units of the segment). The entry is the zero of the face's
/// local coordinate along the segment, found by the secant method. At an edge two faces compete,
/// and the one met first counts. A face that the segment lies in does not count. Nothing when no
/// zero is near.
std::optional<double> Deformed::through_curved_face(int tet, const Vec3& P, const Vec3& Q, double t,
                                                    double stretch) const
{
  constexpr double on_face = 1e-6;
  constexpr int most = 10;
  const mesh::TetPositions x = positions_now(tet);
  const Eigen::Vector4d begin = mesh::barycentric(corners_now(tet), P + t * (Q - P));
  const Eigen::Vector4d end = mesh::barycentric(corners_now(tet), P + (t + stretch) * (Q - P));
  std::optional<double> first;
  for (Eigen::Index face = 0; face < 4; ++face) {
    if (std::abs(begin[face]) > on_face || std::abs(end[face]) <= on_face) continue;
    const auto beyond = [&](double s) -> double {
      return mesh::local_coordinates(x, P + s * (Q - P))[face];
    };
    double before = t, after = t + 1e-3 * stretch;
    double at_before = beyond(before), at_after = beyond(after);
    for (int k = 0; k < most && std::abs(at_before) > 1e-12 && at_after != at_before; ++k) {
      const double next = before - at_before * (after - before) / (at_after - at_before);
      after = before;
      at_after = at_before;
      before = next;
      at_before = beyond(before);
    }
    if (std::abs(at_before) > 1e-9 || std::abs(before - t) > stretch) continue;
    if (!first || before < *first) first = before;
  }
  return first;
}

Vec3 Deformed::reference_place_continued(const Vec3& x, int tet) const
{
  return pull_back(tet, x);
}

/// Entry of one way through the tissue. `starts`: the tets in which it begins, several at an edge
/// or a corner. Rounding must not choose among them: on curved faces the first place counts, and a
/// tie goes to the tet that comes first in the mesh.
Deformed::Entry Deformed::entry_of(std::vector<Stretch> starts, const Vec3& P, const Vec3& Q) const
{
  constexpr double same = 1e-9;
  std::sort(starts.begin(), starts.end(),
            [](const auto& a, const auto& b) { return a.tet < b.tet; });
  double t = starts.front().low;
  int tet = starts.front().tet;
  bool curved = false;
  for (const Stretch& start : starts) {
    if (!mesh_->quadratic() || !(start.low > 0.0)) break;
    const auto at = through_curved_face(start.tet, P, Q, start.low, start.high - start.low);
    if (!at || (curved && *at >= t - same)) continue;
    t = *at;
    tet = start.tet;
    curved = true;
  }
  return {pull_back(tet, P + std::max(t, 0.0) * (Q - P)), tet, tet, t, t};
}

/// Stretches that touch form one way through the tissue, which begins at the surface.
std::vector<Deformed::Entry> Deformed::ways(std::vector<Stretch> stretches, const Vec3& P,
                                            const Vec3& Q) const
{
  std::sort(stretches.begin(), stretches.end(), [](const auto& a, const auto& b) {
    return a.low != b.low ? a.low < b.low : a.tet < b.tet;
  });
  constexpr double touch = 1e-6;
  std::vector<Entry> found;
  for (std::size_t i = 0; i < stretches.size();) {
    const double low = stretches[i].low;
    std::vector<Stretch> starts;
    Stretch last = stretches[i];
    for (; i < stretches.size() && stretches[i].low <= last.high + touch; ++i) {
      if (stretches[i].low <= low + touch) starts.push_back(stretches[i]);
      if (stretches[i].high > last.high + touch ||
          (stretches[i].high > last.high - touch && stretches[i].tet < last.tet))
        last = stretches[i];
    }
    found.push_back(entry_of(std::move(starts), P, Q));
    found.back().last_tet = last.tet;
    found.back().high = last.high;
  }
  return found;
}

std::vector<Deformed::Entry> Deformed::entries(const Vec3& P, const Vec3& Q,
                                               std::span<const int> body_of_node) const
{
  std::map<int, std::vector<Stretch>> of_body;
  for (int tet : candidates(P.cwiseMin(Q), P.cwiseMax(Q))) {
    const auto span = clip_line(corners_now(tet), P, Q);
    if (!span || !(span->high > 0.0 && span->low < 1.0)) continue;
    const auto corner = static_cast<std::size_t>(mesh_->tets[static_cast<std::size_t>(tet)][0]);
    const int body = body_of_node.empty() ? 0 : body_of_node[corner];
    of_body[body].push_back({span->low, span->high, tet});
  }
  std::vector<Entry> found;
  for (const auto& [body, stretches] : of_body) {
    const std::vector<Entry> more = ways(stretches, P, Q);
    found.insert(found.end(), more.begin(), more.end());
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Entry& a, const Entry& b) { return a.low < b.low; });
  return found;
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
