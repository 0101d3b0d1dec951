#pragma once

#include <vector>

#include "law/box_qp.hpp"
#include "law/second_order_cone.hpp"

namespace trocar::law {

using core::Vec3;

/// `Bounds` as inequalities. A single row has two: x + F >= 0 and F - x >= 0. Their values c are x
/// + F of all single rows, then F - x of all single rows. A pair has one: (F, x_i, x_i+1) lies in
/// the second-order cone.
class Inequalities
{
 public:
  explicit Inequalities(const Bounds& bounds) : bounds_(bounds)
  {
    for (int i = 0; i < static_cast<int>(bounds.F.size()); ++i)
      if (!bounds.of_pair(i)) single_.push_back(i);
  }

  Eigen::Index singles() const { return static_cast<Eigen::Index>(single_.size()); }
  std::size_t pairs() const { return bounds_.pairs.size(); }
  Vec3 cone(std::size_t k, const VecX& x) const
  {
    const int i = bounds_.pairs[k];
    return {bounds_.F[i], x[i], x[i + 1]};
  }
  Vec3 cone_change(std::size_t k, const VecX& dx) const
  {
    const int i = bounds_.pairs[k];
    return {0.0, dx[i], dx[i + 1]};
  }

  VecX values(const VecX& x) const
  {
    VecX c(2 * singles());
    c << (x + bounds_.F)(single_), (bounds_.F - x)(single_);
    return c;
  }
  VecX change(const VecX& dx) const
  {
    VecX dc(2 * singles());
    dc << dx(single_), -dx(single_);
    return dc;
  }
  /// Adds Jᵀz to f, where J is the Jacobian of all inequalities. Their multipliers are `z` for the
  /// single rows and `cones` for the pairs.
  void add_pull(const VecX& z, const std::vector<Vec3>& cones, VecX& f) const
  {
    f(single_) += z.head(singles()) - z.tail(singles());
    for (std::size_t k = 0; k < pairs(); ++k) f.segment<2>(bounds_.pairs[k]) += cones[k].tail<2>();
  }
  /// A + Jᵀ D J, the matrix of a Newton step of the interior point. D is `ratio` = z / c for a
  /// single row and the squared inverse of the scaling for a pair.
  MatX barrier(MatX A, const VecX& ratio, const std::vector<cone::Scaling>& scaling) const
  {
    for (Eigen::Index k = 0; k < singles(); ++k) {
      const int i = single_[static_cast<std::size_t>(k)];
      A(i, i) += ratio[k] + ratio[singles() + k];
    }
    for (std::size_t k = 0; k < pairs(); ++k) {
      const int i = bounds_.pairs[k];
      A.block<2, 2>(i, i) += (scaling[k].inverse * scaling[k].inverse).bottomRightCorner<2, 2>();
    }
    return A;
  }
  /// x clipped to the bounds. A row whose distance c from a bound is smaller than the bound's
  /// multiplier z is put exactly on the bound: the interior point only approaches bounds, but a row
  /// either slips or holds.
  VecX on_bounds(const VecX& x_in, const VecX& c, const VecX& z,
                 const std::vector<Vec3>& cones) const
  {
    VecX x = bounds_.clip(x_in);
    for (Eigen::Index k = 0; k < singles(); ++k) {
      const int i = single_[static_cast<std::size_t>(k)];
      if (c[k] < z[k]) x[i] = -bounds_.F[i];
      if (c[singles() + k] < z[singles() + k]) x[i] = bounds_.F[i];
    }
    for (std::size_t k = 0; k < pairs(); ++k) {
      const int i = bounds_.pairs[k];
      const double length = x.segment<2>(i).norm();
      if (length > 0.0 && bounds_.F[i] - length < cones[k][0])
        x.segment<2>(i) *= bounds_.F[i] / length;
    }
    return x;
  }

 private:
  Bounds bounds_;
  std::vector<int> single_;
};

}  // namespace trocar::law
