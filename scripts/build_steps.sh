# Sourced by scripts/build, scripts/run and scripts/sanitize: the steps from a bare Debian 12 to a
# program and its meshes. Each says what it does and is quick when there is nothing to do.

packages_to_run=(g++ cmake ninja-build pkg-config git libpetsc-real-dev libhdf5-openmpi-dev
  libmetis-dev libsuitesparse-dev libeigen3-dev libboost-dev openmpi-bin
  libopenblas0-serial gmsh python3-h5py python3-numpy python3-matplotlib)
packages_to_test=(libgtest-dev libgmsh-dev)
packages_to_develop=(clang-format libsiconos-numerics-dev)

# Installs those of the packages that are missing, or says how to.
install_packages() {
  local package missing=() as_root=()
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
      missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null || ! sudo -n true 2>/dev/null; then
      echo "packages are missing; install them and run this again:" >&2
      echo "  sudo apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  local begun=$SECONDS apt=(env DEBIAN_FRONTEND=noninteractive apt-get -y -qq
    -o Dpkg::Use-Pty=0 --no-install-recommends)
  local log
  log=$(mktemp)
  "${as_root[@]}" apt-get update -qq >"$log" 2>&1 || { cat "$log" >&2; return 1; }
  echo "install: ${missing[*]}"
  # The simulation's closing lines: "Need to get 211 MB of archives", "1,204 MB of … disk space".
  "${as_root[@]}" env LC_ALL=C apt-get install --no-install-recommends --assume-no "${missing[@]}" 2>/dev/null |
    sed -nE 's/^(Need to get|After this operation,) (.*)\.$/install:   \1 \2/p' || true
  "${as_root[@]}" "${apt[@]}" install "${missing[@]}" >"$log" 2>&1 || { cat "$log" >&2; return 1; }
  rm -f "$log"
  echo "install: done in $((SECONDS - begun)) s"
}

# Configures build/ for the build type Release; words are CMake options.
configure() {
  cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" >build.log 2>&1 ||
    { cat build.log >&2; rm -f build.log; return 1; }
  mv build.log build/configure.log
}

# Builds targets (none: all) in the folder $1: every tenth of the way a line, and whatever a
# compiler says.
compile() {
  local folder=$1 begun=$SECONDS line percent shown=0 status=0
  shift
  NINJA_STATUS='[%p] ' cmake --build "$folder" ${*:+--target "$@"} 2>&1 |
    while IFS= read -r line; do
      if [[ $line =~ ^\[\ *([0-9]+)%\] ]]; then
        percent=${BASH_REMATCH[1]}
        if [ $((percent / 10)) -gt "$shown" ] && [ $((SECONDS - begun)) -ge 2 ]; then
          shown=$((percent / 10))
          printf 'build: %3d %%\n' $((10 * shown))
        fi
      elif [[ $line != "ninja: no work"* && $line != "ninja: Entering"* ]]; then
        printf '%s\n' "$line"
      fi
    done || status=$?
  if [ $((SECONDS - begun)) -ge 2 ]; then echo "build: done in $((SECONDS - begun)) s"; fi
  return "$status"
}

# Makes build/meshes/$1.msh when it is missing or older than what it is made from.
make_mesh() {
  local mesh=build/meshes/$1.msh geometry=meshes/$1.geo line arguments begun=$SECONDS
  mkdir -p build/meshes
  if [ -f "$geometry" ]; then
    if [ -s "$mesh" ] && [ ! "$geometry" -nt "$mesh" ]; then return 0; fi
    gmsh -3 "$geometry" -o "$mesh.part" -format msh41 >build/gmsh.log 2>&1 ||
      { cat build/gmsh.log >&2; return 1; }
    mv "$mesh.part" "$mesh"
  else
    # Structured meshes: one line per mesh, NAME and the generator's arguments.
    line=$(grep -E "^$1 " meshes/structured.list) || return 0
    read -r _ arguments <<<"$line"
    if [ -s "$mesh" ] && [ ! meshes/structured.list -nt "$mesh" ] &&
      [ ! meshes/structured_beam -nt "$mesh" ]; then return 0; fi
    # shellcheck disable=SC2086  # the arguments are words
    "$(find_python)" meshes/structured_beam $arguments "$mesh" >build/mesh.log
  fi
  echo "mesh: $mesh ($((SECONDS - begun)) s)"
}

all_meshes() {
  local name
  for name in $(ls meshes/*.geo) $(grep -oE '^[a-z_0-9]+' meshes/structured.list); do
    make_mesh "$(basename "$name" .geo)"
  done
}
