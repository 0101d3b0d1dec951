#include "driver/compliance_options.hpp"

#include <map>

#include "driver/petsc_options.hpp"

namespace trocar::driver {

void read_compliance(core::Options& options, Scenario& scenario)
{
  tissue::TissueSettings& tissue = scenario.tissue;
  const std::map<std::string, solve::Provider> providers{
      {"auto", tissue_solver_given() ? solve::Provider::ksp : solve::Provider::automatic},
      {"supernodal", solve::Provider::supernodal},
      {"ksp", solve::Provider::ksp},
      {"ksp_block", solve::Provider::ksp_block}};
  tissue.provider = providers.at(options.text("compliance_provider"));
  tissue.most_memory = options.real("compliance_memory");
  tissue.stale_steps = options.integer("compliance_stale_steps");
  const std::string reuse = options.text("compliance_reuse");
  if (reuse != "exact") tissue.reuse = reuse == "stale" ? solve::Reuse::stale : solve::Reuse::none;
  const bool ours = tissue.provider == solve::Provider::supernodal ||
                    tissue.provider == solve::Provider::automatic;
  if (tissue.reuse == solve::Reuse::stale && !ours)
    throw core::option_error("option -compliance_reuse stale: needs the supernodal provider");
  scenario.stale_error = options.flag("compliance_stale_error");
  if (scenario.stale_error && tissue.reuse != solve::Reuse::stale)
    throw core::option_error(
        "option -compliance_stale_error: nothing is stale without "
        "-compliance_reuse stale");
  tissue.lag_tolerance = options.real("compliance_lag");
  constexpr double least_lag = 1e-12;  // round-off prevents a smaller residual
  if (tissue.lag_tolerance > 0.0 && tissue.lag_tolerance < least_lag)
    throw core::option_error(
        "option -compliance_lag: round-off does not let a step come closer "
        "than 1e-12; 0 factors in every step");
  if (tissue.reuse == solve::Reuse::none) tissue.lag_tolerance = 0.0;
  // The eta law needs the compliance C of the present operator, which a lagged factor does not
  // give.
  if (scenario.insertion.eta > 0.0) tissue.lag_tolerance = 0.0;
  const bool turns = tissue.any(tissue::Model::corotational) &&
                     !tissue.any(tissue::Model::neo_hookean) && tissue.lag_tolerance > 0.0;
  if (tissue.reuse == solve::Reuse::stale && !turns)
    throw core::option_error(
        "option -compliance_reuse stale: only corotational tissue with a lag has stale columns, "
        "without -insertion_eta");
}

}  // namespace trocar::driver
