#include "mesh/smoothed_edges.hpp"

#include <cmath>

namespace trocar::mesh {

SmoothedEdges::SmoothedEdges(const Mesh& mesh) : mesh_(&mesh)
{
  std::vector<double> of_tet(mesh.tets.size());
  for (int t = 0; t < mesh.tet_count(); ++t)
    of_tet[static_cast<std::size_t>(t)] = mean_edge(corners(mesh, t));
  average(of_tet);
  for (std::size_t t = 0; t < of_tet.size(); ++t) {
    double sum = 0.0;
    for (int node : mesh.tets[t]) sum += of_node_[static_cast<std::size_t>(node)];
    of_tet[t] = 0.25 * sum;
  }
  average(of_tet);
}

void SmoothedEdges::average(const std::vector<double>& of_tet)
{
  std::vector<double> volume(mesh_->x.size(), 0.0);
  of_node_.assign(mesh_->x.size(), 0.0);
  for (std::size_t t = 0; t < of_tet.size(); ++t) {
    const double v = std::abs(corner_volume(*mesh_, static_cast<int>(t)));
    for (int node : mesh_->tets[t]) {
      volume[static_cast<std::size_t>(node)] += v;
      of_node_[static_cast<std::size_t>(node)] += v * of_tet[t];
    }
  }
  for (std::size_t n = 0; n < volume.size(); ++n)
    if (volume[n] > 0.0) of_node_[n] /= volume[n];
}

double SmoothedEdges::at(int tet, const Vec3& X) const
{
  // A place on a face may be a little outside of its tet.
  Eigen::Vector4d weight = barycentric(corners(*mesh_, tet), X).cwiseMax(0.0);
  weight /= weight.sum();
  double length = 0.0;
  for (Eigen::Index a = 0; a < 4; ++a)
    length +=
        weight[a] * of_node_[static_cast<std::size_t>(
                        mesh_->tets[static_cast<std::size_t>(tet)][static_cast<std::size_t>(a)])];
  return length;
}

}  // namespace trocar::mesh
