#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/partition.hpp"
#include "support/block.hpp"

namespace trocar {
namespace {

TEST(Partition, IsBalancedAndEqualOnAllRanks)
{
  const base::Comm comm(MPI_COMM_WORLD);
  const mesh::Mesh mesh = test::block({8, 6, 6});
  const std::vector<int> owner = mesh::partition_nodes(mesh, comm);
  std::vector<int> root = owner;
  comm.broadcast(root);
  EXPECT_EQ(owner, root);
  for (int rank = 0; rank < comm.size(); ++rank)
    EXPECT_LT(static_cast<double>(std::count(owner.begin(), owner.end(), rank)) * comm.size(),
              1.3 * mesh.node_count());
}

}  // namespace
}  // namespace trocar
