#pragma once

#include "driver/log.hpp"
#include "driver/recorder.hpp"
#include "post/pv_curve.hpp"

// What is worked out beside the steps, for the log and run.h5.
namespace trocar::driver {

/// -locking_gauge: into the log and /locking_gauge. Collective.
void report_locking(const step::Model& model, Recorder& recorder, const Log& log);

/// -analysis pv_curve: curve and fits into /pv_curve, slope and R² of the line into the log.
/// Collective.
void report_pv_curve(const post::PvCurve& curve, Recorder& recorder, const Log& log);

/// -error_estimate: the error at the end of a run as a part of the energy norm, and every volume's
/// part in it, into the log and /error_estimate, with the error of every tet; against
/// -error_target how much finer the mesh would have to be, and the sizes of the next mesh into
/// -error_size_field. Collective.
void report_error(const step::Model& model, const OutputSettings& output, const step::State& state,
                  Recorder& recorder, const Log& log);

}  // namespace trocar::driver
