#include "solve/reach_columns.hpp"

#include <algorithm>
#include <numeric>

namespace trocar::solve {

using core::MatX;
using core::VecX;

/// Unit columns that are eliminated together, sorted by position. Because the elimination tree is
/// in postorder, the columns that are nonzero ("active") in one supernode are then contiguous.
struct ReachColumns::Batch
{
  std::vector<int> position, slot;  ///< by column
  std::vector<int> reach;           ///< supernodes on the paths to the root, ascending
  std::vector<int> place;           ///< by supernode: its place in `reach`, or -1
  std::vector<int> low;             ///< by place in `reach`: first active column
  std::vector<int> high;            ///< by place in `reach`: one past the last active column
  std::vector<MatX> Y;              ///< by place: (columns of the supernode x active columns)
  MatX gram;                        ///< Xᵀ X of the batch, lower triangle
  MatX cross;                       ///< Xᵀ X of the batch with earlier slots (columns x slots)
  MatX rest;                        ///< residual of the columns at open places (open x columns)
};

ReachColumns::ReachColumns(const SupernodalFactor& factor) : factor_(&factor)
{
  clear();
}

void ReachColumns::clear()
{
  pieces_.assign(static_cast<std::size_t>(factor_->supernodes()), {});
  touched_.clear();
  C_.resize(0, 0);
  size_ = 0;
}

base::Block ReachColumns::values(int s) const
{
  const Piece& piece = pieces_[static_cast<std::size_t>(s)];
  const int columns = factor_->supernode(s).columns;
  return {piece.value.data(), columns, static_cast<Eigen::Index>(piece.slot.size()),
          Eigen::OuterStride<>(columns)};
}

void ReachColumns::enlarge(int count)
{
  size_ += count;
  if (C_.rows() >= size_) return;
  const Eigen::Index room = std::max<Eigen::Index>(size_, 3 * C_.rows() / 2);
  C_.conservativeResizeLike(MatX::Zero(room, room));
}

/// Appends Y, the values of new slots in supernode s, to X.
void ReachColumns::append(int s, const MatX& Y, const int* slots)
{
  Piece& piece = pieces_[static_cast<std::size_t>(s)];
  if (piece.slot.empty()) touched_.insert(std::lower_bound(touched_.begin(), touched_.end(), s), s);
  piece.value.insert(piece.value.end(), Y.data(), Y.data() + Y.size());
  piece.slot.insert(piece.slot.end(), slots, slots + Y.cols());
}

/// Solves for rows begin … end of Y <- L⁻¹ Y, with L the diagonal block of a supernode. Recursion
/// on halves of the rows turns most of the work into matrix products, which run several times
/// faster than triangular solves. A column is zero above its unit entry. Columns are sorted by
/// position, so the columns that are still zero come last and are skipped.
void ReachColumns::solve_rows(const SupernodalFactor::Supernode& node, int begin, int end,
                              const int* first_position, const int* last_position, MatX& Y)
{
  constexpr int small = 32;
  const Eigen::OuterStride<> stride_L(node.rows), stride_Y(Y.rows());
  const auto part_of_L = [&](int row, int rows, int column, int columns) {
    const auto at = static_cast<std::ptrdiff_t>(column) * node.rows + row;
    return base::Block(node.L + at, rows, columns, stride_L);
  };
  const auto started = [&](int row) {
    return std::lower_bound(first_position, last_position, node.first + row) - first_position;
  };
  if (end - begin <= small) {
    base::solve_lower(part_of_L(begin, end - begin, begin, end - begin),
                      Y.block(begin, 0, end - begin, started(end)));
    return;
  }
  const int middle = begin + (end - begin) / 2;
  solve_rows(node, begin, middle, first_position, last_position, Y);
  const Eigen::Index columns = started(middle);
  base::subtract_product(part_of_L(middle, end - middle, begin, middle - begin),
                         base::Block(Y.data() + begin, middle - begin, columns, stride_Y),
                         Y.block(middle, 0, end - middle, columns));
  solve_rows(node, middle, end, first_position, last_position, Y);
}

/// Eliminates supernode s for a batch: solves with the diagonal block, updates the ancestors, adds
/// the products of this supernode to Xᵀ X.
void ReachColumns::eliminate(int s, Batch& batch)
{
  const SupernodalFactor::Supernode node = factor_->supernode(s);
  const auto place = static_cast<std::size_t>(batch.place[static_cast<std::size_t>(s)]);
  MatX& Y = batch.Y[place];
  const int low = batch.low[place];
  const Eigen::Index active = Y.cols();
  const int* position = batch.position.data() + low;
  solve_rows(node, 0, node.columns, position, position + active, Y);
  const MatX update = base::product(
      {node.L + node.columns, node.below(), node.columns, Eigen::OuterStride<>(node.rows)}, Y);
  const int* row = node.row + node.columns;
  for (int i = 0; i < node.below();) {
    const int t = factor_->supernode_at(row[i]);
    if (t < 0) {  // open places, as are all rows after this one
      for (; i < node.below(); ++i)
        batch.rest.row(row[i] - factor_->closed()).segment(low, active) -= update.row(i);
      break;
    }
    const SupernodalFactor::Supernode above = factor_->supernode(t);
    int end = i;
    while (end < node.below() && row[end] < above.first + above.columns) ++end;
    const auto to = static_cast<std::size_t>(batch.place[static_cast<std::size_t>(t)]);
    MatX& target = batch.Y[to];
    const int shift = low - batch.low[to];
    for (Eigen::Index j = 0; j < active; ++j)
      for (int k = i; k < end; ++k) target(row[k] - above.first, shift + j) -= update(k, j);
    i = end;
  }
  base::add_gram(Y, batch.gram.block(low, low, active, active));
  const MatX products = base::transposed_product(Y, values(s));
  const Piece& piece = pieces_[static_cast<std::size_t>(s)];
  for (Eigen::Index k = 0; k < products.cols(); ++k)
    batch.cross.col(piece.slot[static_cast<std::size_t>(k)]).segment(low, active) +=
        products.col(k);
  append(s, Y, batch.slot.data() + low);
  Y.resize(0, 0);
}

/// Writes a finished batch into C.
void ReachColumns::settle(const Batch& batch)
{
  const auto n = static_cast<Eigen::Index>(batch.slot.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    const int column = batch.slot[static_cast<std::size_t>(j)];
    for (Eigen::Index i = j; i < n; ++i) {
      const int row = batch.slot[static_cast<std::size_t>(i)];
      C_(row, column) = C_(column, row) = batch.gram(i, j);
    }
    for (Eigen::Index old = 0; old < batch.cross.cols(); ++old)
      C_(column, old) = C_(old, column) = batch.cross(j, old);
  }
}

/// Finds the supernodes that a batch reaches and the active columns of each, and sets the unit
/// right-hand sides.
void ReachColumns::plan(Batch& batch) const
{
  batch.place.assign(static_cast<std::size_t>(factor_->supernodes()), -1);
  for (int p : batch.position)
    for (int s = factor_->supernode_at(p); s >= 0 && batch.place[static_cast<std::size_t>(s)] < 0;
         s = factor_->parent(s)) {
      batch.place[static_cast<std::size_t>(s)] = 0;
      batch.reach.push_back(s);
    }
  std::sort(batch.reach.begin(), batch.reach.end());
  for (std::size_t k = 0; k < batch.reach.size(); ++k)
    batch.place[static_cast<std::size_t>(batch.reach[k])] = static_cast<int>(k);
  const auto first_from = [&](int position) {
    return static_cast<int>(
        std::lower_bound(batch.position.begin(), batch.position.end(), position) -
        batch.position.begin());
  };
  for (int s : batch.reach) {
    const SupernodalFactor::Supernode node = factor_->supernode(s);
    batch.low.push_back(first_from(node.first));
    batch.high.push_back(first_from(node.first + node.columns));
  }
  for (std::size_t k = 0; k < batch.reach.size(); ++k) {  // children before parents
    const int parent = factor_->parent(batch.reach[k]);
    if (parent < 0) continue;
    int& low = batch.low[static_cast<std::size_t>(batch.place[static_cast<std::size_t>(parent)])];
    low = std::min(low, batch.low[k]);
  }
  for (std::size_t k = 0; k < batch.reach.size(); ++k) {
    const SupernodalFactor::Supernode node = factor_->supernode(batch.reach[k]);
    batch.Y.push_back(MatX::Zero(node.columns, batch.high[k] - batch.low[k]));
    for (int j = first_from(node.first); j < batch.high[k]; ++j)
      batch.Y.back()(batch.position[static_cast<std::size_t>(j)] - node.first, j - batch.low[k]) =
          1.0;
  }
}

MatX ReachColumns::add_units(const std::vector<int>& positions)
{
  Batch batch;
  std::vector<int> order;
  for (int k = 0; k < static_cast<int>(positions.size()); ++k)
    if (positions[static_cast<std::size_t>(k)] >= 0) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return positions[static_cast<std::size_t>(a)] < positions[static_cast<std::size_t>(b)];
  });
  for (int k : order) {
    batch.position.push_back(positions[static_cast<std::size_t>(k)]);
    batch.slot.push_back(size_ + k);
  }
  const auto count = static_cast<Eigen::Index>(batch.slot.size());
  batch.gram = MatX::Zero(count, count);
  batch.cross = MatX::Zero(count, size_);
  batch.rest = MatX::Zero(factor_->size() - factor_->closed(), count);
  const int first_slot = size_;
  enlarge(static_cast<int>(positions.size()));
  plan(batch);
  for (int s : batch.reach) eliminate(s, batch);
  settle(batch);
  MatX rest = MatX::Zero(batch.rest.rows(), static_cast<Eigen::Index>(positions.size()));
  for (std::size_t k = 0; k < batch.slot.size(); ++k)
    rest.col(batch.slot[k] - first_slot) = batch.rest.col(static_cast<Eigen::Index>(k));
  return rest;
}

VecX ReachColumns::at(const VecX& y) const
{
  VecX result = VecX::Zero(size_);
  for (int s : touched_) {
    const SupernodalFactor::Supernode node = factor_->supernode(s);
    const VecX part = values(s).transpose() * y.segment(node.first, node.columns);
    const Piece& piece = pieces_[static_cast<std::size_t>(s)];
    for (std::size_t k = 0; k < piece.slot.size(); ++k)
      result[piece.slot[k]] += part[static_cast<Eigen::Index>(k)];
  }
  return result;
}

void ReachColumns::push(const VecX& f, VecX& y) const
{
  for (int s : touched_) {
    const SupernodalFactor::Supernode node = factor_->supernode(s);
    const VecX mine = f(pieces_[static_cast<std::size_t>(s)].slot);
    y.segment(node.first, node.columns).noalias() += values(s) * mine;
  }
}

}  // namespace trocar::solve
