#include "constraint/set.hpp"

#include <algorithm>
#include <string>

#include "core/failure.hpp"

namespace trocar::constraint {

Anchor anchor_of(const std::map<int, double>& weight)
{
  Anchor anchor;
  anchor.weight.resize(static_cast<Eigen::Index>(weight.size()));
  for (const auto& [node, w] : weight) {
    anchor.weight[static_cast<Eigen::Index>(anchor.node.size())] = w;
    anchor.node.push_back(node);
  }
  return anchor;
}

Row Row::between(TissueTerm tissue, int body, const std::vector<std::pair<int, double>>& jacobian)
{
  Row row;
  row.tissue.push_back(std::move(tissue));
  row.body = body;
  for (const auto& [dof, coefficient] : jacobian) row.on_body.push_back({dof, coefficient});
  return row;
}

int Set::add(std::vector<Row> rows, const law::Law& law, int point)
{
  if (static_cast<int>(rows.size()) != law.rows())
    throw core::Failure(
        core::ExitCode::internal,
        "a law of " + std::to_string(law.rows()) + " rows is given " + std::to_string(rows.size()));
  const int first = size();
  blocks_.push_back({first, law, point});
  for (Row& row : rows) rows_.push_back(std::move(row));
  return first;
}

int Set::add(Row row, const law::Law& law, int point)
{
  std::vector<Row> one;
  one.push_back(std::move(row));
  return add(std::move(one), law, point);
}

int Set::add_functional(std::shared_ptr<const solve::DistributedFunctional> probe)
{
  wide_.push_back(std::move(probe));
  return static_cast<int>(wide_.size()) - 1;
}

solve::Probes Set::probes() const
{
  solve::Probes probes;
  for (const Row& row : rows_)
    for (const TissueTerm& term : row.tissue)
      for (std::size_t a = 0; a < term.anchor.node.size(); ++a)
        if (term.anchor.weight[static_cast<Eigen::Index>(a)] != 0.0)
          probes.nodes.push_back(term.anchor.node[a]);
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
