#include "driver/program.hpp"

int main(int argc, char** argv)
{
  if (trocar::driver::answer_questions(argc, argv)) return 0;
  int threads = 0;  // the heartbeat's calls nothing of MPI
  if (MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads) != MPI_SUCCESS) return 1;
  const int code = trocar::driver::run_program(argc, argv, MPI_COMM_WORLD);
  MPI_Finalize();
  return code;
}
