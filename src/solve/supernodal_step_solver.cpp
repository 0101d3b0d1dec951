#include "solve/supernodal_step_solver.hpp"

#include "core/stopwatch.hpp"

namespace trocar::solve {

void SupernodalStepSolver::forget_columns()
{
  if (columns_)
    columns_->clear();
  else if (factor_)
    columns_.emplace(*factor_);
  interface_block_.forget_columns();
  first_slot_of_node_.clear();
  wides_.clear();
  slots_ = 0;
}

void SupernodalStepSolver::turn(const std::vector<core::Mat3>& R)
{
  R_ = R;
  wides_.clear();  // columns of wide probes cannot be turned and are made anew
}

OwnedField SupernodalStepSolver::turned_back(const OwnedField& field) const
{
  OwnedField back = field;
  if (R_.empty()) return back;
  for (int local = 0; local < space_->owned(); ++local)
    back.node(local) = turned(space_->file_node(local)).transpose() * field.node(local);
  return back;
}

/// The field by position of the domain's factor; zero on the open places.
core::VecX SupernodalStepSolver::mine(const OwnedField& field) const
{
  core::VecX y = core::VecX::Zero(factor_ ? factor_->size() : 0);
  for (std::size_t dof = 0; dof < index_.size(); ++dof)
    if (index_[dof] >= 0)
      y[factor_->position(index_[dof])] = field.value[static_cast<Eigen::Index>(dof)];
  return y;
}

/// The field on the interface dofs that this rank owns; zero on the others.
core::VecX SupernodalStepSolver::interface_part(const OwnedField& field) const
{
  core::VecX interface = core::VecX::Zero(static_cast<Eigen::Index>(interface_.size()));
  const int first = 3 * space_->first();
  for (std::size_t k = 0; k < interface_.size(); ++k)
    if (interface_[k] >= first && interface_[k] < first + space_->owned_dofs())
      interface[static_cast<Eigen::Index>(k)] = field.value[interface_[k] - first];
  return interface;
}

/// Adds the residual of a forward half-sweep at the open places to the interface vector.
void SupernodalStepSolver::add_left_over(const core::VecX& y, core::VecX& interface) const
{
  for (std::size_t k = 0; k < open_.size(); ++k)
    interface[open_[k]] += y[factor_->position(factor_->closed() + static_cast<int>(k))];
}

core::VecX SupernodalStepSolver::sum_on_root(const core::VecX& values) const
{
  core::VecX sum = values;
  if (space_->comm().size() == 1) return sum;
  TROCAR_MPI(MPI_Reduce(values.data(), sum.data(), static_cast<int>(values.size()), MPI_DOUBLE,
                        MPI_SUM, 0, space_->comm().get()));
  return sum;
}

HalfSolution SupernodalStepSolver::begin(const OwnedField& b)
{
  if (!reuse_) forget_columns();
  ++ledger_->half_sweeps;
  return forward(b, !R_.empty());
}

/// L⁻¹ Rᵀ b, in single precision if asked for.
HalfSolution SupernodalStepSolver::forward(const OwnedField& b, bool single)
{
  const OwnedField back = turned_back(b);
  HalfSolution half{mine(back), {}};
  if (factor_) single ? factor_->forward_single(half.value) : factor_->forward(half.value);
  if (!interface_.empty()) {
    half.interface = interface_part(back);
    add_left_over(half.value, half.interface);
    half.interface = sum_on_root(half.interface);
    if (space_->comm().root()) half.interface = interface_block_.forward(half.interface);
  }
  return half;
}

/// Slots of the probed nodes. Makes all missing columns, also those of the wide probes.
std::vector<int> SupernodalStepSolver::slots_of(const Probes& probes, ComplianceReport& report)
{
  std::vector<int> slots, fresh;
  for (int node : probes.nodes) {
    const auto [entry, is_fresh] = first_slot_of_node_.emplace(node, slots_);
    if (is_fresh) {
      fresh.push_back(node);
      slots_ += 3;
    }
    for (int axis = 0; axis < 3; ++axis) {
      slots.push_back(entry->second + axis);
      if (!fixed_->fixed(node, axis)) ++(is_fresh ? report.built : report.reused);
    }
  }
  if (!fresh.empty()) add_nodes(fresh);
  add_wides(probes, report);
  return slots;
}

void SupernodalStepSolver::add_wides(const Probes& probes, ComplianceReport& report)
{
  for (const DistributedFunctional* wide : probes.wide) {
    const auto known = wides_.find(wide->id);
    const bool is_fresh = known == wides_.end() || known->second.version != wide->version;
    ++(is_fresh ? report.built : report.reused);
    if (!is_fresh) continue;
    OwnedField vector = wide->vector;
    fixed_->clear(vector);
    wides_.insert_or_assign(wide->id, Wide{wide->version, forward(vector, false)});
  }
}

void SupernodalStepSolver::add_nodes(const std::vector<int>& nodes)
{
  std::vector<int> positions;
  core::MatX interface = core::MatX::Zero(static_cast<Eigen::Index>(interface_.size()),
                                          3 * static_cast<Eigen::Index>(nodes.size()));
  for (int node : nodes)
    for (int axis = 0; axis < 3; ++axis) {
      const int dof = 3 * space_->number_of_file(node) + axis;
      const int owned = dof - 3 * space_->first();
      const bool here = owned >= 0 && owned < space_->owned_dofs();
      const int index = here ? index_[static_cast<std::size_t>(owned)] : -1;
      const auto in_interface = interface_index_.find(dof);
      if (space_->comm().root() && in_interface != interface_index_.end())
        interface(in_interface->second, static_cast<Eigen::Index>(positions.size())) = 1.0;
      positions.push_back(index >= 0 ? factor_->position(index) : -1);
    }
  if (columns_) {
    const core::MatX rest = columns_->add_units(positions);
    for (std::size_t k = 0; k < open_.size(); ++k)
      interface.row(open_[k]) +=
          rest.row(factor_->position(factor_->closed() + static_cast<int>(k)) - factor_->closed());
  }
  add_to_interface(interface);
}

void SupernodalStepSolver::add_to_interface(core::MatX& columns)
{
  if (interface_.empty()) return;
  const core::VecX sum = sum_on_root(columns.reshaped());
  if (space_->comm().root())
    interface_block_.add(Eigen::Map<const core::MatX>(sum.data(), columns.rows(), columns.cols()));
}

/// Multiplies the three rows of every probed node by the rotation R of the node.
void SupernodalStepSolver::turn_rows(const Probes& probes, core::MatX& rows) const
{
  if (R_.empty()) return;
  for (std::size_t k = 0; k < probes.nodes.size(); ++k) {
    auto three = rows.middleRows<3>(3 * static_cast<Eigen::Index>(k));
    three = (turned(probes.nodes[k]) * three).eval();
  }
}

core::VecX SupernodalStepSolver::turned_back(const Probes& probes, const core::VecX& f) const
{
  core::VecX back = f;
  if (R_.empty()) return back;
  for (std::size_t k = 0; k < probes.nodes.size(); ++k) {
    const auto at = 3 * static_cast<Eigen::Index>(k);
    back.segment<3>(at) = turned(probes.nodes[k]).transpose() * f.segment<3>(at);
  }
  return back;
}

core::MatX SupernodalStepSolver::block(const Probes& probes, ComplianceReport& report)
{
  const core::Stopwatch watch;
  report = {};
  report.probes = probes.size();
  const std::vector<int> slots = slots_of(probes, report);
  const auto nodal = static_cast<Eigen::Index>(slots.size());
  core::MatX C = core::MatX::Zero(probes.size(), probes.size());
  if (columns_) C.topLeftCorner(nodal, nodal) = columns_->block(slots);
  if (space_->comm().root() && !interface_.empty())
    C.topLeftCorner(nodal, nodal) += interface_block_.block(slots);
  for (std::size_t k = 0; k < probes.wide.size(); ++k) {
    const Eigen::Index column = nodal + static_cast<Eigen::Index>(k);
    C.col(column) = read_here(probes, slots, wides_.at(probes.wide[k]->id).half);
    C.row(column) = C.col(column).transpose();
  }
  if (space_->comm().size() > 1)
    TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, C.data(), static_cast<int>(C.size()), MPI_DOUBLE,
                             MPI_SUM, space_->comm().get()));
  turn_rows(probes, C);
  C.transposeInPlace();
  turn_rows(probes, C);
  ledger_->columns_built += report.built;
  ledger_->columns_reused += report.reused;
  report.seconds = watch.seconds();
  return C;
}

/// This rank's term of Xᵀ y, by slot of the probes; the terms of all ranks add up.
core::VecX SupernodalStepSolver::read_here(const Probes& probes, const std::vector<int>& slots,
                                           const HalfSolution& half) const
{
  const auto nodal = static_cast<Eigen::Index>(slots.size());
  core::VecX read = core::VecX::Zero(probes.size());
  const bool has_interface = space_->comm().root() && !interface_.empty();
  core::VecX by_slot = core::VecX::Zero(slots_);
  if (columns_) by_slot = columns_->at(half.value);
  if (has_interface) by_slot += interface_block_.at(half.interface);
  for (Eigen::Index k = 0; k < nodal; ++k) read[k] = by_slot[slots[static_cast<std::size_t>(k)]];
  const Eigen::Index closed = factor_ ? factor_->closed() : 0;
  for (std::size_t k = 0; k < probes.wide.size(); ++k) {
    const HalfSolution& wide = wides_.at(probes.wide[k]->id).half;
    double& product = read[nodal + static_cast<Eigen::Index>(k)];
    product = wide.value.head(closed).dot(half.value.head(closed));
    if (has_interface) product += wide.interface.dot(half.interface);
  }
  return read;
}

core::VecX SupernodalStepSolver::at(const Probes& probes, const HalfSolution& half)
{
  ComplianceReport report;
  const std::vector<int> slots = slots_of(probes, report);
  ledger_->columns_built += report.built;
  core::MatX read = read_here(probes, slots, half);
  if (space_->comm().size() > 1)
    TROCAR_MPI(MPI_Allreduce(MPI_IN_PLACE, read.data(), static_cast<int>(read.size()), MPI_DOUBLE,
                             MPI_SUM, space_->comm().get()));
  turn_rows(probes, read);
  return read;
}

OwnedField SupernodalStepSolver::finish(const HalfSolution& half, const Probes& probes,
                                        const core::VecX& f)
{
  core::VecX y = half.value, interface = half.interface;
  if (probes.size() > 0) {
    ComplianceReport report;
    const std::vector<int> slots = slots_of(probes, report);
    ledger_->columns_built += report.built;
    core::VecX by_slot = core::VecX::Zero(slots_);
    const core::VecX back = turned_back(probes, f);
    for (std::size_t k = 0; k < slots.size(); ++k)
      by_slot[slots[k]] = back[static_cast<Eigen::Index>(k)];
    if (columns_) columns_->push(by_slot, y);
    const bool has_interface = space_->comm().root() && !interface_.empty();
    if (has_interface) interface_block_.push(by_slot, interface);
    for (std::size_t k = 0; k < probes.wide.size(); ++k) {
      const HalfSolution& wide = wides_.at(probes.wide[k]->id).half;
      const double force = back[static_cast<Eigen::Index>(slots.size() + k)];
      y += force * wide.value;
      if (has_interface) interface += force * wide.interface;
    }
  }
  if (!interface_.empty()) {
    if (space_->comm().root()) interface = interface_block_.backward(interface);
    TROCAR_MPI(MPI_Bcast(interface.data(), static_cast<int>(interface.size()), MPI_DOUBLE, 0,
                         space_->comm().get()));
    for (std::size_t k = 0; k < open_.size(); ++k)
      y[factor_->position(factor_->closed() + static_cast<int>(k))] = interface[open_[k]];
  }
  if (factor_) R_.empty() ? factor_->backward(y) : factor_->backward_single(y);
  ++ledger_->half_sweeps;
  return assembled(y, interface);
}

/// Field of the owned nodes from the dofs of the domain (y) and of the interface, turned by R.
OwnedField SupernodalStepSolver::assembled(const core::VecX& y, const core::VecX& interface) const
{
  OwnedField field = space_->zero();
  for (std::size_t dof = 0; dof < index_.size(); ++dof)
    if (index_[dof] >= 0)
      field.value[static_cast<Eigen::Index>(dof)] = y[factor_->position(index_[dof])];
  const int first = 3 * space_->first();
  for (std::size_t k = 0; k < interface_.size(); ++k)
    if (interface_[k] >= first && interface_[k] < first + space_->owned_dofs())
      field.value[interface_[k] - first] = interface[static_cast<Eigen::Index>(k)];
  if (R_.empty()) return field;
  for (int local = 0; local < space_->owned(); ++local)
    field.node(local) = (turned(space_->file_node(local)) * field.node(local)).eval();
  return field;
}

}  // namespace trocar::solve
