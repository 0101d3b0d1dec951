#pragma once

#include <span>
#include <vector>

#include "base/comm.hpp"
#include "core/math.hpp"
#include "mesh/mesh.hpp"

namespace trocar::fem {

using core::Vec3;
using core::VecX;

/// Values at the nodes this rank owns, three per node, in local order. A value type: states copy
/// it freely. Without ghosts: what linear algebra works on.
struct OwnedField
{
  VecX value;

  auto node(int local) { return value.segment<3>(3 * local); }
  auto node(int local) const { return value.segment<3>(3 * local); }
};

/// Values at owned nodes followed by ghost nodes: what element loops read.
struct GhostedField
{
  VecX value;

  auto node(int local) const { return value.segment<3>(3 * local); }
};

/// Values at every node of the mesh in mesh-file order, equal on every rank.
struct GlobalField
{
  VecX value;

  auto node(int file_node) { return value.segment<3>(3 * file_node); }
  auto node(int file_node) const { return value.segment<3>(3 * file_node); }
};

/// How a state shows values by integration point of the local tets, as many in each of them: other
/// ranks have other parts of such a list.
template <class List>
struct ByPoint
{
  List& list;
};
template <class List>
ByPoint(List&) -> ByPoint<List>;

/// The dof map of linear or quadratic tets: three dofs per node; each rank owns the nodes the
/// partition gives it, numbered contiguously by rank and in file order within a rank. A rank's
/// local tets are all tets that touch a node it owns, so that it can assemble its own rows without
/// communication; with two `overlap_layers` also those that touch a node of these, which elements
/// that share their dilatation need.
class Space
{
 public:
  Space(const mesh::Mesh& mesh, const std::vector<int>& node_owner, const base::Comm& comm,
        int overlap_layers = 1);

  const base::Comm& comm() const { return comm_; }
  int owned() const { return owned_; }                               ///< nodes owned here
  int local() const { return static_cast<int>(file_node_.size()); }  ///< owned + ghost nodes
  int global() const { return static_cast<int>(number_.size()); }    ///< nodes in all
  int first() const { return first_; }  ///< global number of the first owned node
  int owned_dofs() const { return 3 * owned_; }

  /// Global number of a local node.
  int number(int local) const { return number_[index(file_node_[index(local)])]; }
  /// Global number of a file node.
  int number_of_file(int file_node) const { return number_[index(file_node)]; }
  /// File node of a local node.
  int file_node(int local) const { return file_node_[index(local)]; }
  /// Local number of a file node owned here, or -1.
  int owned_local(int file_node) const;

  int nodes_per_tet() const { return nodes_per_tet_; }
  int tets_of_mesh() const { return tets_of_mesh_; }
  std::size_t tets() const { return file_tet_.size(); }  ///< local tets, in file order
  int file_tet(std::size_t local_tet) const { return file_tet_[local_tet]; }
  /// Local nodes of a local tet, `nodes_per_tet`, as `mesh::TetNodes` has them.
  std::span<const int> nodes(std::size_t local_tet) const
  {
    const auto count = index(nodes_per_tet_);
    return {&tet_node_[count * local_tet], count};
  }

  OwnedField zero() const { return {VecX::Zero(owned_dofs())}; }
  GhostedField with_ghosts(const OwnedField& field) const;  ///< collective
  /// Sums every rank's contributions to a node at its owner. Collective.
  OwnedField sum_at_owners(const GhostedField& field) const;
  GlobalField gather(const OwnedField& field) const;  ///< collective, on every rank
  /// Numbers by local tet, as many of each, of all tets in file order on rank 0; nothing elsewhere.
  /// Collective.
  std::vector<double> gather_tets(std::span<const double> values) const;
  /// The local tets' part of such a list. Not collective.
  std::vector<double> of_local_tets(std::span<const double> values) const;
  /// The owned part of a global field. Not collective.
  OwnedField restrict_to_owned(const GlobalField& field) const;

  double dot(const OwnedField& a, const OwnedField& b) const;  ///< collective
  double norm(const OwnedField& a) const;                      ///< collective

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void number_nodes(const std::vector<int>& owner);
  void collect_local_tets(const mesh::Mesh& mesh, const std::vector<int>& owner,
                          int overlap_layers);
  void plan_exchange(const std::vector<int>& owner);

  base::Comm comm_;
  int owned_ = 0;
  int first_ = 0;
  int tets_of_mesh_ = 0;
  std::vector<int> number_;      ///< global number by file node
  std::vector<int> file_order_;  ///< file node by global number
  std::vector<int> file_node_;   ///< file node by local node
  int nodes_per_tet_;
  std::vector<int> file_tet_, tet_node_;
  std::vector<int> counts_, starts_;          ///< owned dofs and first dof of every rank
  std::vector<int> send_nodes_;               ///< local owned nodes, by receiving rank
  std::vector<int> send_count_, send_start_;  ///< in dofs, by rank
  std::vector<int> receive_count_, receive_start_;
};

}  // namespace trocar::fem
