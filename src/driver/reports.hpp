#pragma once

#include "driver/log.hpp"
#include "driver/recorder.hpp"
#include "post/pv_curve.hpp"

// Results that are computed outside the steps, for the log and run.h5.
namespace trocar::driver {

/// -locking_gauge: writes the ratios to the log and to /locking_gauge. Collective.
void report_locking(const step::Model& model, Recorder& recorder, const Log& log);

/// -analysis pv_curve: writes curve and fits to /pv_curve, slope and R² of the straight line to the
/// log. Collective.
void report_pv_curve(const post::PvCurve& curve, Recorder& recorder, const Log& log);

/// -error_estimate: writes the error at the end of the run to the log and to /error_estimate: the
/// error relative to the energy norm, the share of every volume in its square, and (only to the
/// file) the error of every tet. With -error_target the log says how much finer the mesh would have
/// to be. The sizes of the next mesh go to -error_size_field; Failure (64) when nothing is
/// strained. Collective.
void report_error(const step::Model& model, const OutputSettings& output, const step::State& state,
                  Recorder& recorder, const Log& log);

}  // namespace trocar::driver
