#include "law/volume.hpp"

#include <algorithm>
#include <utility>

namespace trocar::law {
namespace {

/// Shape functions and their derivatives on the reference triangle, at the points of a quadrature
/// rule.
struct FaceRule
{
  MatX N, N1, N2;  ///< shape functions, their derivatives by ξ and by η (points, nodes)
  VecX weight;     ///< (points), their sum is 1/2
};

/// Quadrature points, one row (ξ, η, 2 · weight) each. The first moment needs degree 2 on flat
/// faces (3 points) and degree 6 on quadratic faces (12 points, Dunavant 1985).
MatX points(int nodes)
{
  if (nodes == 3) {
    MatX p(3, 3);
    p << 1.0 / 6, 1.0 / 6, 1.0 / 3, 2.0 / 3, 1.0 / 6, 1.0 / 3, 1.0 / 6, 2.0 / 3, 1.0 / 3;
    return p;
  }
  constexpr double w1 = 0.11678627572637936603, a1 = 0.24928674517091042129;
  constexpr double w2 = 0.050844906370206816921, a2 = 0.063089014491502408340;
  constexpr double w3 = 0.082851075618373575194, a3 = 0.053145049844816947353,
                   b3 = 0.31035245103378440542;
  constexpr double c1 = 1 - 2 * a1, c2 = 1 - 2 * a2, c3 = 1 - a3 - b3;
  MatX p(12, 3);
  p << a1, a1, w1, c1, a1, w1, a1, c1, w1, a2, a2, w2, c2, a2, w2, a2, c2, w2, a3, b3, w3, b3, a3,
      w3, a3, c3, w3, c3, a3, w3, b3, c3, w3, c3, b3, w3;
  return p;
}

FaceRule make_rule(int nodes)
{
  const MatX p = points(nodes);
  FaceRule rule;
  rule.weight = 0.5 * p.col(2);
  rule.N.resize(p.rows(), nodes);
  rule.N1 = rule.N2 = rule.N;
  for (Eigen::Index q = 0; q < p.rows(); ++q) {
    const double b = p(q, 0), c = p(q, 1), a = 1.0 - b - c;
    if (nodes == 3) {
      rule.N.row(q) << a, b, c;
      rule.N1.row(q) << -1, 1, 0;
      rule.N2.row(q) << -1, 0, 1;
    } else {
      rule.N.row(q) << a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c,
          4 * c * a;
      rule.N1.row(q) << 1 - 4 * a, 4 * b - 1, 0, 4 * (a - b), 4 * c, -4 * c;
      rule.N2.row(q) << 1 - 4 * a, 0, 4 * c - 1, -4 * b, 4 * b, 4 * (a - c);
    }
  }
  return rule;
}

const FaceRule& rule_of(int nodes)
{
  static const FaceRule flat = make_rule(3), quadratic = make_rule(6);
  return nodes == 3 ? flat : quadratic;
}

using Face = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6>;

/// Nodal values of one face, one column per node.
Face at_face(const ClosedSurface& surface, std::size_t face, const VecX& x)
{
  Face values(3, surface.face_nodes);
  for (int a = 0; a < surface.face_nodes; ++a) {
    const auto at = face * static_cast<std::size_t>(surface.face_nodes);
    values.col(a) = x.segment<3>(3 * surface.nodes[at + static_cast<std::size_t>(a)]);
  }
  return values;
}

void add_face(const ClosedSurface& surface, std::size_t face, const Face& values, VecX& sum)
{
  for (int a = 0; a < surface.face_nodes; ++a) {
    const auto at = face * static_cast<std::size_t>(surface.face_nodes);
    sum.segment<3>(3 * surface.nodes[at + static_cast<std::size_t>(a)]) += values.col(a);
  }
}

/// Position and tangent vectors at one quadrature point.
struct Point
{
  Point(const FaceRule& rule, Eigen::Index q, const Face& x)
      : place(x * rule.N.row(q).transpose()),
        along1(x * rule.N1.row(q).transpose()),
        along2(x * rule.N2.row(q).transpose())
  {
  }
  Vec3 place, along1, along2;

  Vec3 normal() const { return along1.cross(along2); }  ///< its length is the area element
  Vec3 normal_change(const Point& d) const
  {
    return d.along1.cross(along2) + along1.cross(d.along2);
  }
};

/// Nodal vector Σ weight · kernel(x, d) · N over all faces and quadrature points. The kernel gets
/// the `Point` of x and the `Point` of d.
template <class Kernel>
VecX nodal_sum(const ClosedSurface& surface, const VecX& x, const VecX& d, const Kernel& kernel)
{
  const FaceRule& rule = rule_of(surface.face_nodes);
  VecX sum = VecX::Zero(x.size());
  for (std::size_t face = 0; face < surface.faces(); ++face) {
    const Face here = at_face(surface, face, x), change = at_face(surface, face, d);
    Face share = Face::Zero(3, surface.face_nodes);
    for (Eigen::Index q = 0; q < rule.weight.size(); ++q)
      share +=
          rule.weight[q] * kernel(Point(rule, q, here), Point(rule, q, change)) * rule.N.row(q);
    add_face(surface, face, share, sum);
  }
  return sum;
}

template <class Kernel>
double integral(const ClosedSurface& surface, const VecX& x, const Kernel& kernel)
{
  const FaceRule& rule = rule_of(surface.face_nodes);
  double sum = 0.0;
  for (std::size_t face = 0; face < surface.faces(); ++face) {
    const Face here = at_face(surface, face, x);
    for (Eigen::Index q = 0; q < rule.weight.size(); ++q)
      sum += rule.weight[q] * kernel(Point(rule, q, here));
  }
  return sum;
}

}  // namespace

VecX face_shares(const MatX& x)
{
  const FaceRule& rule = rule_of(static_cast<int>(x.cols()));
  VecX shares = VecX::Zero(x.cols());
  for (Eigen::Index q = 0; q < rule.weight.size(); ++q) {
    const Vec3 t1 = x * rule.N1.row(q).transpose(), t2 = x * rule.N2.row(q).transpose();
    shares += rule.weight[q] * t1.cross(t2).norm() * rule.N.row(q).transpose();
  }
  return shares;
}

double volume(const ClosedSurface& surface, const VecX& x)
{
  return integral(surface, x, [](const Point& p) { return p.place.dot(p.normal()); }) / 3.0;
}

VecX volume_gradient(const ClosedSurface& surface, const VecX& x)
{
  return nodal_sum(surface, x, x, [](const Point& p, const Point&) { return p.normal(); });
}

VecX volume_hessian_times(const ClosedSurface& surface, const VecX& x, const VecX& d)
{
  return nodal_sum(surface, x, d,
                   [](const Point& p, const Point& dp) { return p.normal_change(dp); });
}

double moment(const ClosedSurface& surface, const VecX& x, const Vec3& phi)
{
  return integral(surface, x,
                  [&](const Point& p) { return phi.dot(p.place) * p.place.dot(p.normal()); }) /
         4.0;
}

VecX moment_gradient(const ClosedSurface& surface, const VecX& x, const Vec3& phi)
{
  return nodal_sum(surface, x, x, [&](const Point& p, const Point&) {
    return Vec3(phi.dot(p.place) * p.normal());
  });
}

VecX moment_hessian_times(const ClosedSurface& surface, const VecX& x, const Vec3& phi,
                          const VecX& d)
{
  return nodal_sum(surface, x, d, [&](const Point& p, const Point& dp) {
    return Vec3(phi.dot(dp.place) * p.normal() + phi.dot(p.place) * p.normal_change(dp));
  });
}

VolumeCubic::VolumeCubic(const ClosedSurface& surface, const MatX& y) : size_(y.cols())
{
  for (Eigen::Index j = 0; j < size_; ++j)
    for (Eigen::Index k = j; k < size_; ++k)
      T_.push_back(y.transpose() * volume_hessian_times(surface, y.col(j), y.col(k)) / 6.0);
}

double VolumeCubic::at(Eigen::Index j, Eigen::Index k, Eigen::Index l) const
{
  if (j > k) std::swap(j, k);
  return T_[static_cast<std::size_t>(j * size_ - j * (j - 1) / 2 + k - j)][l];
}

double VolumeCubic::value(const VecX& p) const
{
  VecX q(size_);
  q << 1.0, p;
  double sum = 0.0;
  for (Eigen::Index j = 0; j < size_; ++j)
    for (Eigen::Index k = 0; k < size_; ++k)
      for (Eigen::Index l = 0; l < size_; ++l) sum += at(j, k, l) * q[j] * q[k] * q[l];
  return sum;
}

VecX VolumeCubic::gradient(const VecX& p) const
{
  VecX q(size_);
  q << 1.0, p;
  VecX g = VecX::Zero(size_);
  for (Eigen::Index j = 0; j < size_; ++j)
    for (Eigen::Index k = 0; k < size_; ++k)
      for (Eigen::Index l = 0; l < size_; ++l) g[l] += 3.0 * at(j, k, l) * q[j] * q[k];
  return g.tail(size_ - 1);
}

}  // namespace trocar::law
