#pragma once

namespace trocar::base {

/// Speed of this process's dense matrix product [flop/s]: the best of a few products of 384 x 384,
/// some milliseconds in all. Factor and compliance columns run at this speed.
double blas_rate();

}  // namespace trocar::base
