#include "constraint/set.hpp"

#include <algorithm>

namespace trocar::constraint {

int Set::add_wide(std::shared_ptr<const solve::WideProbe> probe)
{
  wide_.push_back(std::move(probe));
  return static_cast<int>(wide_.size()) - 1;
}

solve::Probes Set::probes() const
{
  solve::Probes probes;
  for (const Row& row : rows_)
    for (std::size_t a = 0; a < row.anchor.node.size(); ++a)
      if (row.anchor.weight[static_cast<Eigen::Index>(a)] != 0.0)
        probes.nodes.push_back(row.anchor.node[a]);
  std::sort(probes.nodes.begin(), probes.nodes.end());
  probes.nodes.erase(std::unique(probes.nodes.begin(), probes.nodes.end()), probes.nodes.end());
  for (const auto& wide : wide_) probes.wide.push_back(wide.get());
  return probes;
}

core::VecX Set::starts() const
{
  core::VecX start(size());
  for (int i = 0; i < size(); ++i) start[i] = rows_[static_cast<std::size_t>(i)].start;
  return start;
}

}  // namespace trocar::constraint
