#pragma once

#include <mpi.h>

namespace trocar::driver {

/// Answers -help, -help_markdown and -version, which need neither MPI nor a scene. Returns true
/// when one of them was given.
bool answer_questions(int argc, char** argv);

/// The whole program on the ranks of `world`: PETSc session, options, set-up, run. Returns the
/// exit code. Every failure prints one line `trocar: error: …` and no rank is left waiting.
/// Collective.
int run_program(int argc, char** argv, MPI_Comm world);

}  // namespace trocar::driver
