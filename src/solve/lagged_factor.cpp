#include "solve/lagged_factor.hpp"

namespace trocar::solve {

Outcome<Done> LaggedFactor::make(const fem::BlockMatrix& values)
{
  age_ = {};
  try {  // a solver fails on all ranks or on none
    solver_->set_operator(values);
  } catch (const core::Failure& failure) {
    if (failure.code() != core::ExitCode::solver) throw;
    return core::Refusal{failure.what()};
  }
  ++version_;
  age_ = {false, 1, 1.0, 1.0};
  return Done{};
}

void LaggedFactor::keep(const std::vector<core::Mat3>& R)
{
  solver_->turn(R);
  age_.lags = true;
  ++age_.uses;
}

void LaggedFactor::serve_again()
{
  ++age_.uses;
  if (!age_.lags) served(1);
}

void LaggedFactor::served(int sweeps)
{
  age_.last_sweeps = sweeps;
  age_.sweeps += sweeps;
}

bool LaggedFactor::worn() const
{
  return age_.uses > 0 && age_.last_sweeps * age_.uses > solver_->sweeps_per_factor() + age_.sweeps;
}

HalfSolution LaggedFactor::begin(const OwnedField& b)
{
  OwnedField free = b;
  fixed_->clear(free);
  return solver_->begin(free);
}

OwnedField LaggedFactor::finish(const HalfSolution& half, const Probes& probes, const core::VecX& f)
{
  OwnedField u = solver_->finish(half, probes, f);
  fixed_->clear(u);
  return u;
}

}  // namespace trocar::solve
