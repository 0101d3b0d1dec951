# Sourced by the other scripts: the environment the program runs well in. Nothing here is needed
# for correct results.

# Open MPI refuses root and more ranks than cores unless told otherwise.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
export OMPI_MCA_mpi_yield_when_idle=1
# Containers without CAP_SYS_PTRACE cannot copy between processes.
export OMPI_MCA_btl_vader_single_copy_mechanism=none

# Looking for a fast network takes Open MPI 0.2 s of every start (Intel's PSM2 times a clock).
if [ -z "$(ls /sys/class/infiniband 2>/dev/null)" ]; then
  export OMPI_MCA_pml=${OMPI_MCA_pml:-ob1}
fi

# Ranks are the only parallelism: threads below them would oversubscribe the cores. CHOLMOD asks
# for four threads whatever OMP_NUM_THREADS says; OMP_THREAD_LIMIT stops it.
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} OMP_THREAD_LIMIT=${OMP_THREAD_LIMIT:-1}

# Debian's OpenBLAS 0.3.21 takes newer AVX-512 CPUs for a Haswell and runs at half speed.
if [ -z "${OPENBLAS_CORETYPE:-}" ] && grep -qm1 avx512f /proc/cpuinfo 2>/dev/null; then
  export OPENBLAS_CORETYPE=SkylakeX
fi

# A python3 that has h5py, numpy and matplotlib; another one may stand earlier in PATH.
find_python() {
  local candidate
  for candidate in "${PYTHON:-}" python3 /usr/bin/python3; do
    if [ -n "$candidate" ] && "$candidate" -c 'import h5py, numpy, matplotlib' 2>/dev/null; then
      echo "$candidate"
      return 0
    fi
  done
  echo "no python3 with h5py, numpy and matplotlib was found" >&2
  return 1
}
