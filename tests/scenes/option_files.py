"""Every shipped option file passes -check and has its card; docs/options.md is current."""
import glob
import os
import subprocess

import h5py

from harness import FOLDER, PROGRAM, ROOT, check, finish, run, small_block

for path in sorted(glob.glob(os.path.join(ROOT, "options", "*.opts"))):
    name = os.path.basename(path)
    with open(path) as stream:
        card = [line for line in stream if line.startswith("#")]
    for word in ("What", "Equations", "Run", "Expect", "Seconds"):
        check(any(line.startswith("# " + word) for line in card), f"{name}: the card says '{word}'")
    more = []
    if name in ("tight.opts", "deterministic.opts"):  # fragments, for any scene
        more = ["-mesh", small_block()]
    elif name.startswith("branch_"):  # what they go on from is not there
        more = ["-restart_from", "none"]
    process = run({"-options_file": path, "-check": ""}, 2, more)
    check(process.returncode == 0, f"{name}: -check {process.stderr[-300:]}")
    with open(os.path.join(ROOT, "README.md")) as stream:
        check(name in stream.read(), f"{name}: the README's table names it")

# The command line wins wherever it stands, and MUMPS hears its options.
folder = os.path.join(FOLDER, "first")
before = run({"-time_end": "0.04", "-mesh": small_block(), "-output_dir": folder,
              "-tissue_mat_mumps_icntl_14": "80",
              "-options_file": os.path.join(ROOT, "options", "small_insertion.opts")})
check(before.returncode == 0, f"arguments before -options_file {before.stderr[-300:]}")
with h5py.File(folder + "/run.h5") as results:
    check(len(results["history/time"]) == 3, "the command line's time_end was used")
    names = list(results["provenance/options/name"][:])
    source = results["provenance/options/source"][names.index(b"time_end")]
    check(source == b"command line", "and recorded with its source")

# No floating point exception anywhere, not even one that is survived.
for solver in ("auto", "pgs", "hybrid", "active_set", "interior_point"):
    trapped = run({"-options_file": os.path.join(ROOT, "options", "small_insertion.opts"),
                   "-mesh": small_block(), "-constraint_solver": solver, "-fp_trap": "",
                   "-quiet": "", "-output_dir": folder})
    check(trapped.returncode == 0, f"-fp_trap with {solver}")

help_text = subprocess.run([PROGRAM, "-help"], capture_output=True, text=True)
check(help_text.returncode == 0 and "-needle_velocity" in help_text.stdout, "-help lists options")
table = subprocess.run([PROGRAM, "-help_markdown"], capture_output=True, text=True).stdout
with open(os.path.join(ROOT, "docs", "options.md")) as stream:
    check(stream.read() == table, "docs/options.md is what -help_markdown prints")
version = subprocess.run([PROGRAM, "-version"], capture_output=True, text=True).stdout
check(version.startswith("trocar "), "-version")
finish()
