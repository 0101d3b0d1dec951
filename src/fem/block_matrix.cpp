#include "fem/block_matrix.hpp"

#include <algorithm>
#include <unordered_map>

namespace trocar::fem {

BlockPattern::BlockPattern(const Space& space)
{
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(space.owned()));
  const auto row_of = [&](int number) {
    const int row = number - space.first();
    return row >= 0 && row < space.owned() ? row : -1;
  };
  for (const Space::LocalTet& tet : space.tets())
    for (const auto& [a, b] : block_pairs) {
      const int na = space.number(tet.nodes[static_cast<std::size_t>(a)]);
      const int nb = space.number(tet.nodes[static_cast<std::size_t>(b)]);
      const int row = row_of(std::min(na, nb));
      if (row >= 0) columns[static_cast<std::size_t>(row)].push_back(std::max(na, nb));
    }
  row_start_.push_back(0);
  for (auto& row : columns) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    column_.insert(column_.end(), row.begin(), row.end());
    row_start_.push_back(static_cast<int>(column_.size()));
  }
  std::unordered_map<int, int> local_of;
  for (int local = 0; local < space.local(); ++local) local_of[space.number(local)] = local;
  for (int number : column_) local_column_.push_back(local_of.at(number));
  for (const Space::LocalTet& tet : space.tets()) {
    Slots slots{{}, 0};
    for (std::size_t p = 0; p < 10; ++p) {
      const int na = space.number(tet.nodes[static_cast<std::size_t>(block_pairs[p][0])]);
      const int nb = space.number(tet.nodes[static_cast<std::size_t>(block_pairs[p][1])]);
      const int row = row_of(std::min(na, nb));
      slots.at[p] = -1;
      if (na > nb) slots.transposed = static_cast<std::uint16_t>(slots.transposed | (1U << p));
      if (row < 0) continue;
      const auto begin = column_.begin() + row_start_[static_cast<std::size_t>(row)];
      const auto end = column_.begin() + row_start_[static_cast<std::size_t>(row) + 1];
      slots.at[p] =
          static_cast<int>(std::lower_bound(begin, end, std::max(na, nb)) - column_.begin());
    }
    slots_.push_back(slots);
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
