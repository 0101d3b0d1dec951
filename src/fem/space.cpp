#include "fem/space.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/petsc.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::fem {
namespace {

std::vector<int> exclusive_sum(const std::vector<int>& counts)
{
  std::vector<int> starts(counts.size(), 0);
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  return starts;
}

}  // namespace

Space::Space(const mesh::Mesh& mesh, const std::vector<int>& node_owner, const base::Comm& comm,
             int overlap_layers)
    : comm_(comm), tets_of_mesh_(mesh.tet_count()), nodes_per_tet_(mesh.nodes_per_tet())
{
  number_nodes(node_owner);
  collect_local_tets(mesh, node_owner, overlap_layers);
  plan_exchange(node_owner);
}

void Space::number_nodes(const std::vector<int>& owner)
{
  counts_.assign(index(comm_.size()), 0);
  for (int rank : owner) ++counts_[index(rank)];
  starts_ = exclusive_sum(counts_);
  owned_ = counts_[index(comm_.rank())];
  first_ = starts_[index(comm_.rank())];
  std::vector<int> next = starts_;
  number_.resize(owner.size());
  file_order_.resize(owner.size());
  for (int node = 0; node < static_cast<int>(owner.size()); ++node) {
    number_[index(node)] = next[index(owner[index(node)])]++;
    file_order_[index(number_[index(node)])] = node;
  }
  for (int& count : counts_) count *= 3;
  for (int& start : starts_) start *= 3;
}

void Space::collect_local_tets(const mesh::Mesh& mesh, const std::vector<int>& owner,
                               int overlap_layers)
{
  const int me = comm_.rank();
  // Nodes of the local tets found so far; before the first layer, the owned nodes.
  std::vector<char> near(owner.size(), 0);
  for (std::size_t node = 0; node < owner.size(); ++node) near[node] = owner[node] == me;
  for (int layer = 0; layer < overlap_layers; ++layer) {
    const std::vector<char> inner = near;
    file_tet_.clear();
    for (int t = 0; t < mesh.tet_count(); ++t) {
      const mesh::TetNodes nodes = mesh::nodes_of(mesh, t);
      if (std::none_of(nodes.begin(), nodes.end(), [&](int n) { return inner[index(n)]; }))
        continue;
      file_tet_.push_back(t);
      for (int node : nodes) near[index(node)] = 1;
    }
  }
  file_node_.assign(file_order_.begin() + first_, file_order_.begin() + first_ + owned_);
  // Ghosts are sorted by global number, hence by owner: values from one rank arrive contiguously.
  for (int node : file_order_)
    if (near[index(node)] && owner[index(node)] != me) file_node_.push_back(node);
  std::vector<int> local_of(owner.size(), -1);
  for (int local = 0; local < static_cast<int>(file_node_.size()); ++local)
    local_of[index(file_node_[index(local)])] = local;
  for (int t : file_tet_)
    for (int node : mesh::nodes_of(mesh, t)) tet_node_.push_back(local_of[index(node)]);
}

void Space::plan_exchange(const std::vector<int>& owner)
{
  std::vector<int> wanted;  // global numbers of the ghosts, by owner
  receive_count_.assign(index(comm_.size()), 0);
  for (int local = owned_; local < this->local(); ++local) {
    ++receive_count_[index(owner[index(file_node_[index(local)])])];
    wanted.push_back(number(local));
  }
  receive_start_ = exclusive_sum(receive_count_);
  send_count_.assign(index(comm_.size()), 0);
  TROCAR_MPI(
      MPI_Alltoall(receive_count_.data(), 1, MPI_INT, send_count_.data(), 1, MPI_INT, comm_.get()));
  send_start_ = exclusive_sum(send_count_);
  send_nodes_.resize(index(send_start_.back() + send_count_.back()));
  TROCAR_MPI(MPI_Alltoallv(wanted.data(), receive_count_.data(), receive_start_.data(), MPI_INT,
                           send_nodes_.data(), send_count_.data(), send_start_.data(), MPI_INT,
                           comm_.get()));
  for (int& node : send_nodes_) node -= first_;
  for (auto* counts : {&receive_count_, &receive_start_, &send_count_, &send_start_})
    for (int& count : *counts) count *= 3;  // from nodes to dofs
}

int Space::owned_local(int file_node) const
{
  const int local = number_[index(file_node)] - first_;
  return local >= 0 && local < owned_ ? local : -1;
}

GhostedField Space::with_ghosts(const OwnedField& field) const
{
  GhostedField ghosted{VecX(3 * local())};
  ghosted.value.head(owned_dofs()) = field.value;
  if (comm_.size() == 1) return ghosted;
  VecX send(3 * static_cast<int>(send_nodes_.size()));
  for (int i = 0; i < static_cast<int>(send_nodes_.size()); ++i)
    send.segment<3>(3 * i) = field.node(send_nodes_[index(i)]);
  TROCAR_MPI(MPI_Alltoallv(send.data(), send_count_.data(), send_start_.data(), MPI_DOUBLE,
                           ghosted.value.data() + owned_dofs(), receive_count_.data(),
                           receive_start_.data(), MPI_DOUBLE, comm_.get()));
  return ghosted;
}

OwnedField Space::sum_at_owners(const GhostedField& field) const
{
  OwnedField owned{field.value.head(owned_dofs())};
  if (comm_.size() == 1) return owned;
  VecX received(3 * static_cast<int>(send_nodes_.size()));
  TROCAR_MPI(MPI_Alltoallv(field.value.data() + owned_dofs(), receive_count_.data(),
                           receive_start_.data(), MPI_DOUBLE, received.data(), send_count_.data(),
                           send_start_.data(), MPI_DOUBLE, comm_.get()));
  for (int i = 0; i < static_cast<int>(send_nodes_.size()); ++i)
    owned.node(send_nodes_[index(i)]) += received.segment<3>(3 * i);
  return owned;
}

GlobalField Space::gather(const OwnedField& field) const
{
  VecX ordered(3 * global());
  TROCAR_MPI(MPI_Allgatherv(field.value.data(), owned_dofs(), MPI_DOUBLE, ordered.data(),
                            counts_.data(), starts_.data(), MPI_DOUBLE, comm_.get()));
  GlobalField result{VecX(3 * global())};
  for (int node = 0; node < global(); ++node)
    result.node(node) = ordered.segment<3>(3 * number_[index(node)]);
  return result;
}

std::vector<double> Space::gather_tets(std::span<const double> values) const
{
  const std::size_t width = tets() > 0 ? values.size() / tets() : 0;
  std::vector<int> mine;  // each tet is sent once, by the owner of its first node
  std::vector<double> numbers;
  for (std::size_t t = 0; t < tets(); ++t) {
    if (nodes(t).front() >= owned_) continue;
    mine.push_back(file_tet(t));
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(width * t);
    numbers.insert(numbers.end(), first, first + static_cast<std::ptrdiff_t>(width));
  }
  const std::vector<int> tet = comm_.gather(mine);
  const std::vector<double> number = comm_.gather(numbers);
  if (tet.empty()) return {};
  const std::size_t each = number.size() / tet.size();
  std::vector<double> ordered(number.size());
  for (std::size_t i = 0; i < tet.size(); ++i)
    std::copy_n(number.begin() + static_cast<std::ptrdiff_t>(each * i), each,
                ordered.begin() + static_cast<std::ptrdiff_t>(each * index(tet[i])));
  return ordered;
}

std::vector<double> Space::of_local_tets(std::span<const double> values) const
{
  const std::size_t each = values.size() / index(tets_of_mesh_);
  std::vector<double> local;
  local.reserve(each * tets());
  for (int tet : file_tet_) {
    const auto part = values.subspan(each * index(tet), each);
    local.insert(local.end(), part.begin(), part.end());
  }
  return local;
}

OwnedField Space::restrict_to_owned(const GlobalField& field) const
{
  OwnedField owned = zero();
  for (int local = 0; local < owned_; ++local) owned.node(local) = field.node(file_node(local));
  return owned;
}

double Space::dot(const OwnedField& a, const OwnedField& b) const
{
  return comm_.sum(a.value.dot(b.value));
}

double Space::norm(const OwnedField& a) const
{
  return std::sqrt(dot(a, a));
}

}  // namespace trocar::fem
