#pragma once

#include <span>
#include <vector>

#include "base/comm.hpp"
#include "core/math.hpp"
#include "mesh/mesh.hpp"

namespace trocar::fem {

using core::Vec3;
using core::VecX;

/// Values at the nodes that this rank owns, three per node, in local order. Linear algebra works on
/// this type. It has value semantics: states copy it freely.
struct OwnedField
{
  VecX value;

  auto node(int local) { return value.segment<3>(3 * local); }
  auto node(int local) const { return value.segment<3>(3 * local); }
};

/// Values at the owned nodes and then the ghost nodes. Element loops read this type.
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

/// Marks a list of values at integration points where a state names its members (core/visit.hpp).
/// The list holds this rank's local tets only, with equally many values for each tet.
template <class List>
struct ByPoint
{
  List& list;
};
template <class List>
ByPoint(List&) -> ByPoint<List>;

/// The dof map of linear or quadratic tets, with three dofs per node. Each rank owns the nodes that
/// the partition gives it. A node has an index in the mesh ("file node"), a global number,
/// which is contiguous by rank and in file order within a rank, and a local number (owned, then
/// ghosts). The local tets of a rank are all tets with a node that the rank owns, so that it
/// assembles its own rows without communication. With two `overlap_layers` the tets with a node of
/// those tets are local too; elements that share their dilatation need them.
class Space
{
 public:
  Space(const mesh::Mesh& mesh, const std::vector<int>& node_owner, const base::Comm& comm,
        int overlap_layers = 1);

  const base::Comm& comm() const { return comm_; }
  int owned() const { return owned_; }                               ///< nodes owned here
  int local() const { return static_cast<int>(file_node_.size()); }  ///< owned + ghost nodes
  int global() const { return static_cast<int>(number_.size()); }    ///< nodes of the mesh
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
  /// Local node numbers of a local tet, in the order of `mesh::TetNodes`.
  std::span<const int> nodes(std::size_t local_tet) const
  {
    const auto count = index(nodes_per_tet_);
    return {&tet_node_[count * local_tet], count};
  }

  OwnedField zero() const { return {VecX::Zero(owned_dofs())}; }
  GhostedField with_ghosts(const OwnedField& field) const;  ///< fetches ghosts; collective
  /// Sums the contributions of all ranks to a node at the owner of the node. Collective.
  OwnedField sum_at_owners(const GhostedField& field) const;
  GlobalField gather(const OwnedField& field) const;  ///< on every rank; collective
  /// Gathers values of the local tets, equally many for each tet. Rank 0 gets those of all tets in
  /// file order, other ranks an empty list. Collective.
  std::vector<double> gather_tets(std::span<const double> values) const;
  /// The values of the local tets, from a list of all tets in file order. Not collective.
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
  std::vector<int> counts_, starts_;  ///< number of owned dofs, and first dof, of every rank
  std::vector<int> send_nodes_;  ///< owned nodes that other ranks have as ghosts, by receiving rank
  std::vector<int> send_count_, send_start_;  ///< in dofs, by rank
  std::vector<int> receive_count_, receive_start_;
};

}  // namespace trocar::fem
