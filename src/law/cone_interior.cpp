#include "law/cone_interior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/dense.hpp"
#include "law/cone_sets.hpp"
#include "law/immovable.hpp"

namespace trocar::law {
namespace {

/// What the products of forces and gaps should become.
struct Target
{
  VecX ends;
  std::vector<Vec3> cones;
};

class Interior
{
 public:
  explicit Interior(const Problem& problem) : problem_(problem), W_(problem.W)
  {
    if (problem.compliance.size() > 0) W_.diagonal() += problem.compliance;
    const VecX give = mobility(problem);
    for (const Block& block : problem.blocks) {
      if (!(give.segment(block.first, block.law.rows()).mean() > 0.0))
        still_.push_back(block);
      else if (block.law.set == Law::Set::cone)
        in_.cones.push_back({block.first, block.law.friction});
      else if (block.law.set == Law::Set::interval)
        in_.add_ends(block);
    }
    start(give);
  }

  const VecX& lambda() const { return at_.lambda; }
  bool has_inequalities() const { return in_.count() > 0; }

  /// One step; false when it leads nowhere.
  bool step()
  {
    linearise();
    const std::size_t count = in_.count();
    const double mu = in_.products(at_) / static_cast<double>(count);
    const Point affine =
        towards({VecX::Zero(at_.z.size()), std::vector<Vec3>(in_.cones.size(), Vec3::Zero())});
    if (!affine.lambda.allFinite()) return false;
    const double reach = in_.longest(at_, affine);
    const double after = in_.products(moved(affine, reach)) / static_cast<double>(count);
    // Less centring, as in linear programs, leaves cones of redundant rows in corners.
    const double centre = std::clamp(after, 0.0, mu);
    const Point direction = towards(corrected(affine, centre));
    if (!direction.lambda.allFinite()) return false;
    const double length = centred(direction, in_.longest(at_, direction));
    at_ = moved(direction, length);
    return length > 1e-8;
  }

 private:
  /// Forces well inside their sets, of the size that the gaps ask for; gaps to match.
  void start(const VecX& give)
  {
    const VecX& g = problem_.g;
    double force = 0.0, w = 0.0;
    for (Eigen::Index i = 0; i < g.size(); ++i) {
      if (!(give[i] > 0.0)) continue;
      force = std::max(force, std::abs(g[i]) / give[i]);
      w = std::max(w, give[i]);
    }
    force = std::max(force, 1e-300);
    at_.lambda = VecX::Zero(g.size());
    for (const Block& block : still_)
      for (int i = block.first; i < block.end(); ++i)
        at_.lambda[i] = problem_.start.size() > 0 ? problem_.start[i] : 0.0;
    for (const End& end : in_.ends) at_.lambda[end.row] = end.end + end.side * force;
    for (const auto& [row, middle] : in_.middles) at_.lambda[row] = middle;
    for (const Cone& cone : in_.cones) at_.lambda[cone.first] = force / cone.friction;
    at_.z = VecX::Constant(static_cast<Eigen::Index>(in_.ends.size()), force * w);
    at_.v.assign(in_.cones.size(), Vec3(force * w, 0.0, 0.0));
  }

  /// Length of the step, cut until no product is far below the mean product.
  double centred(const Point& d, double step) const
  {
    constexpr double neighbourhood = 1e-3;
    const auto count = static_cast<double>(in_.count());
    for (int cut = 0; cut < 12; ++cut, step *= 0.7) {
      const Point trial = moved(d, step);
      if (in_.least_product(trial) >= neighbourhood * in_.products(trial) / count) return step;
    }
    return step;
  }
  /// Newton's matrix at the iterate, and what the equations lack.
  void linearise()
  {
    const VecX delta = W_ * at_.lambda + problem_.g;
    MatX J = W_;
    lack_ = -delta;
    scaling_.clear();
    for (std::size_t k = 0; k < in_.cones.size(); ++k) {
      const Cone& cone = in_.cones[k];
      const Eigen::Vector2d slip = delta.segment<2>(cone.first + 1);
      const double size = slip.norm();
      lack_[cone.first] -= cone.friction * size;
      if (size > 0.0)
        J.row(cone.first) +=
            cone.friction / size * (slip.transpose() * W_.middleRows(cone.first + 1, 2));
    }
    for (std::size_t k = 0; k < in_.cones.size(); ++k) {
      const Cone& cone = in_.cones[k];
      const cone::Scaling scaling(at_.v[k], in_.force(cone, at_.lambda));
      const Vec3 P = cone.scale();
      J.block<3, 3>(cone.first, cone.first) +=
          P.asDiagonal() * scaling.W * scaling.W * P.asDiagonal();
      lack_.segment<3>(cone.first) += P.cwiseProduct(at_.v[k]);
      scaling_.push_back(scaling);
    }
    for (std::size_t k = 0; k < in_.ends.size(); ++k) {
      const double z = at_.z[static_cast<Eigen::Index>(k)];
      J(in_.ends[k].row, in_.ends[k].row) += z / in_.room(in_.ends[k], at_.lambda);
      lack_[in_.ends[k].row] += in_.ends[k].side * z;
    }
    for (const Block& block : still_)
      for (int i = block.first; i < block.end(); ++i) {
        J.row(i).setZero();
        J(i, i) = 1.0;
        lack_[i] = 0.0;
      }
    factor_ = core::Square(J);
  }

  /// The direction in which the products become those of the target.
  Point towards(const Target& target) const
  {
    Point d;
    VecX rhs = lack_;
    VecX to_z(at_.z.size());
    std::vector<Vec3> to_v;
    for (std::size_t k = 0; k < in_.ends.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      to_z[i] = target.ends[i] / in_.room(in_.ends[k], at_.lambda) - at_.z[i];
      rhs[in_.ends[k].row] += in_.ends[k].side * to_z[i];
    }
    for (std::size_t k = 0; k < in_.cones.size(); ++k) {
      const cone::Scaling& scaling = scaling_[k];
      to_v.push_back(scaling.W * (cone::divided(target.cones[k], scaling.lambda) - scaling.lambda));
      rhs.segment<3>(in_.cones[k].first) += in_.cones[k].scale().cwiseProduct(to_v[k]);
    }
    d.lambda = factor_.solve(rhs);
    d.z = to_z;
    for (std::size_t k = 0; k < in_.ends.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      d.z[i] -= at_.z[i] / in_.room(in_.ends[k], at_.lambda) * in_.ends[k].side *
                d.lambda[in_.ends[k].row];
    }
    for (std::size_t k = 0; k < in_.cones.size(); ++k)
      d.v.push_back(to_v[k] - scaling_[k].W * (scaling_[k].W * in_.force(in_.cones[k], d.lambda)));
    return d;
  }

  /// Mehrotra's correction of the affine direction's second-order error, around `centre`.
  Target corrected(const Point& affine, double centre) const
  {
    Target target{VecX::Constant(at_.z.size(), centre), {}};
    for (std::size_t k = 0; k < in_.ends.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      target.ends[i] -= in_.ends[k].side * affine.lambda[in_.ends[k].row] * affine.z[i];
    }
    for (std::size_t k = 0; k < in_.cones.size(); ++k) {
      const Vec3 dr = scaling_[k].W * in_.force(in_.cones[k], affine.lambda);
      const Vec3 dv = scaling_[k].inverse * affine.v[k];
      target.cones.push_back(Vec3(centre, 0.0, 0.0) - cone::product(dr, dv));
    }
    return target;
  }

  Point moved(const Point& d, double step) const
  {
    Point p = at_;
    p.lambda += step * d.lambda;
    p.z += step * d.z;
    for (std::size_t k = 0; k < in_.cones.size(); ++k) p.v[k] += step * d.v[k];
    return p;
  }

  const Problem& problem_;
  MatX W_;
  std::vector<Block> still_;  ///< blocks that nothing can move; they keep their multipliers
  Inside in_;
  Point at_;
  VecX lack_;
  std::vector<cone::Scaling> scaling_;
  core::Square factor_;
};

}  // namespace

bool all_for_cone_interior(const Problem& problem)
{
  return std::all_of(problem.blocks.begin(), problem.blocks.end(), [](const Block& block) {
    const Law& law = block.law;
    const bool plain = law.upper == std::numeric_limits<double>::infinity() &&
                       law.shear == law.upper && law.friction > 0.0;
    return law.set == Law::Set::zero || law.set == Law::Set::interval ||
           (law.set == Law::Set::cone && plain);
  });
}

Multipliers cone_interior(const Problem& problem, const Settings& settings)
{
  constexpr int most = 60;
  Multipliers result;
  Interior interior(problem);
  double best = std::numeric_limits<double>::infinity();
  int idle = 0;
  for (int k = 0; k <= most; ++k) {
    const double residual = kkt_residual(problem, interior.lambda());
    if (!std::isfinite(residual)) break;
    idle = residual < best ? 0 : idle + 1;
    if (residual < best) {
      best = residual;
      result.lambda = interior.lambda();
    }
    if (residual <= settings.tolerance || k == most || idle > 8) break;
    if (!interior.has_inequalities() || !interior.step()) break;
    ++result.iterations;
  }
  result.residual = best;
  result.converged = best <= settings.tolerance;
  return result;
}

}  // namespace trocar::law
