#include "tissue/balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue/tissue.hpp"

namespace trocar::tissue {
namespace {

constexpr double unit_round_off = std::numeric_limits<double>::epsilon();

core::VecX lengths(const OwnedField& field)
{
  return Eigen::Map<const Eigen::Matrix3Xd>(field.value.data(), 3, field.value.size() / 3)
      .colwise()
      .norm()
      .transpose();
}

/// Largest rest[a] / (scale[a] + least) of the owned nodes a; infinity when a ratio is not finite.
double largest_part(const core::VecX& rest, const core::VecX& scale, double least)
{
  double worst = 0.0;
  for (Eigen::Index a = 0; a < rest.size(); ++a)
    if (!(rest[a] <= 0.0)) {
      const double part = rest[a] / (scale[a] + least);
      worst = std::isfinite(part) ? std::max(worst, part) : std::numeric_limits<double>::infinity();
    }
  return worst;
}

}  // namespace

Sizes Tissue::no_sizes() const
{
  return {core::VecX::Zero(space_->owned()), core::VecX::Zero(space_->owned()), 0.0, {}};
}

double Tissue::least_rest(const Sizes& sizes, double part) const
{
  const core::VecX least = part * sizes.size + unit_round_off * sizes.rounding;
  return std::sqrt(space_->comm().sum(least.squaredNorm()));
}

Balance Tissue::balance(const TissueState& past, const OwnedField& u, const TimeStep& step,
                        const OwnedField& more)
{
  const bool known = configured_.u && configured_.exact == tangent_.exact();
  if (!known || !space_->comm().all(configured_.u->value == u.value)) {
    configure(space_->with_ghosts(u), configured_.at);
    configured_.u = u;
    configured_.exact = tangent_.exact();
  }
  Sizes sizes = no_sizes();
  const OwnedField pushed = forces(past, u, configured_.at, step, &sizes);
  const core::VecX given = lengths(more);
  OwnedField r{pushed.value + more.value};
  OwnedField held = r;
  fixed_.clear(r);
  held.value -= r.value;
  const double rounded = unit_round_off / settings_.newton_tolerance;
  const core::VecX scale = sizes.size + given + rounded * sizes.rounding;
  const core::VecX rest = lengths(r);

  core::VecX sums(8);
  sums << r.value.squaredNorm(), given.squaredNorm(),
      Eigen::Map<const Eigen::Matrix3Xd>(r.value.data(), 3, space_->owned()).rowwise().sum(),
      lengths(external(step)).sum() + given.sum(), lengths(held).sum(),
      sizes.rounding.squaredNorm();
  space_->comm().sum(sums);
  const double mine = scale.size() > 0 ? scale.maxCoeff() : 0.0;
  const double least = Balance::of_largest * space_->comm().max(mine);
  Balance balance;
  balance.worst = space_->comm().max(largest_part(rest, scale, least));
  balance.lost = sums.segment<3>(2).norm();
  balance.carried = std::max(sums[5], sums[6]);
  balance.rounded = unit_round_off * std::sqrt(sums[7]);
  const double all =
      sizes.norms + std::sqrt(sums[1]) + balance.rounded / settings_.newton_tolerance;
  balance.norm = all > 0.0 ? std::sqrt(sums[0]) / all : 0.0;
  configured_.sizes = std::move(sizes);
  return balance;
}

}  // namespace trocar::tissue
