#include "fem/block_matrix.hpp"

#include <algorithm>
#include <unordered_map>

namespace trocar::fem {

BlockPattern::BlockPattern(const Space& space, const Cliques& cliques)
    : pairs_per_tet_(pair_count(static_cast<std::size_t>(space.nodes_per_tet())))
{
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(space.owned()));
  const auto couple = [&](std::span<const int> nodes) {
    for (int a : nodes) {
      if (a >= space.owned()) continue;
      for (int b : nodes)
        if (space.number(b) >= space.number(a))
          columns[static_cast<std::size_t>(a)].push_back(space.number(b));
    }
  };
  const auto tidy = [](std::vector<int>& row) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  };
  for (std::size_t e = 0; e < space.tets(); ++e) couple(space.nodes(e));
  for (auto& row : columns) tidy(row);
  for (std::size_t k = 0; k < cliques.size(); ++k) couple(cliques.nodes(k));
  row_start_.push_back(0);
  for (auto& row : columns) {
    if (cliques.size() > 0) tidy(row);
    column_.insert(column_.end(), row.begin(), row.end());
    row_start_.push_back(static_cast<int>(column_.size()));
  }
  std::unordered_map<int, int> local_of;
  for (int local = 0; local < space.local(); ++local) local_of[space.number(local)] = local;
  for (int number : column_) local_column_.push_back(local_of.at(number));
  for (std::size_t e = 0; e < space.tets(); ++e) find_slots(space, space.nodes(e), tet_slots_);
  for (std::size_t k = 0; k < cliques.size(); ++k) {
    find_slots(space, cliques.nodes(k), clique_slots_);
    clique_start_.push_back(clique_slots_.size());
  }
}

void BlockPattern::find_slots(const Space& space, std::span<const int> nodes,
                              std::vector<int>& slots) const
{
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = a; b < nodes.size(); ++b) {
      const int na = space.number(nodes[a]), nb = space.number(nodes[b]);
      const int row = std::min(na, nb) - space.first();
      if (row < 0 || row >= space.owned()) {
        slots.push_back(-1);
        continue;
      }
      const auto begin = column_.begin() + row_start_[static_cast<std::size_t>(row)];
      const auto end = column_.begin() + row_start_[static_cast<std::size_t>(row) + 1];
      const auto at = std::lower_bound(begin, end, std::max(na, nb));
      slots.push_back(2 * static_cast<int>(at - column_.begin()) + (na > nb ? 1 : 0));
    }
}

void BlockMatrix::add_rank_one(std::span<const int> slots, const Eigen::Matrix3Xd& b, double scale)
{
  std::size_t p = 0;
  for (Eigen::Index i = 0; i < b.cols(); ++i) {
    const Vec3 scaled = scale * b.col(i);
    for (Eigen::Index j = i; j < b.cols(); ++j, ++p) {
      if (slots[p] < 0) continue;
      Eigen::Map<core::Mat3> block(&values_[9 * static_cast<std::size_t>(slots[p] >> 1)]);
      if (slots[p] & 1)
        block += b.col(j) * scaled.transpose();
      else
        block += scaled * b.col(j).transpose();
    }
  }
}

OwnedField BlockMatrix::times(const Space& space, const OwnedField& x) const
{
  const GhostedField from = space.with_ghosts(x);
  GhostedField to{VecX::Zero(from.value.size())};
  for (int row = 0; row < space.owned(); ++row) {
    const Vec3 own = from.node(row);
    Vec3 sum = Vec3::Zero();
    for (int k = pattern_->row_start()[static_cast<std::size_t>(row)];
         k < pattern_->row_start()[static_cast<std::size_t>(row) + 1]; ++k) {
      const Eigen::Map<const core::Mat3> block(&values_[9 * static_cast<std::size_t>(k)]);
      const int column = pattern_->local_column()[static_cast<std::size_t>(k)];
      sum += block * from.node(column);
      if (column != row) to.value.segment<3>(3 * column) += block.transpose() * own;
    }
    to.value.segment<3>(3 * row) += sum;
  }
  return space.sum_at_owners(to);
}

void BlockMatrix::fix(const Space& space, const Dirichlet& fixed)
{
  for (int row = 0; row < space.owned(); ++row) {
    const int number = space.first() + row;
    const unsigned row_axes = fixed.axes_of_number(number);
    for (int k = pattern_->row_start()[static_cast<std::size_t>(row)];
         k < pattern_->row_start()[static_cast<std::size_t>(row) + 1]; ++k) {
      const int column = pattern_->column()[static_cast<std::size_t>(k)];
      const unsigned column_axes = fixed.axes_of_number(column);
      if (row_axes == 0 && column_axes == 0) continue;
      Eigen::Map<core::Mat3> block(&values_[9 * static_cast<std::size_t>(k)]);
      const Vec3 diagonal = block.diagonal();
      for (int a = 0; a < 3; ++a) {
        if (row_axes >> a & 1U) block.row(a).setZero();
        if (column_axes >> a & 1U) block.col(a).setZero();
        if (row == column - space.first() && (row_axes >> a & 1U)) block(a, a) = diagonal[a];
      }
    }
  }
}

}  // namespace trocar::fem
