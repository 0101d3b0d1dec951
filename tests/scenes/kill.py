"""However a run ends, what it said is written: SIGKILL at random moments, disks that fill up, signals, closed
pipes. With --long many more kills."""
import glob
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

from harness import FOLDER, PROGRAM, ROOT, check, error_lines, finish, options, run, small_block

LONG = "--long" in sys.argv
settings = options("small_insertion.opts")
settings.update({"-mesh": small_block(), "-output_every": "1", "-time_step": "0.002",
                 "-tissue_model": "corotational", "-tissue_element": "p1"})
random.seed(1)


def words(folder, more={}):
    all_of_them = []
    for name, value in {**settings, "-output_dir": folder, **more}.items():
        all_of_them += [name] + ([value] if value else [])
    return all_of_them


def started(folder, ranks=1, more={}, **how):
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    return subprocess.Popen([*launcher, PROGRAM, *words(folder, more)], cwd=ROOT, start_new_session=True,
                            text=True, **how)


def steps_said(log):
    """Accepted steps whose line is whole."""
    found = [line.split() for line in log.split("\n")[:-1]]
    return [int(line[0]) for line in found if len(line) > 6 and line[0].isdigit()]


def whole(folder, said, what):
    """All acknowledged steps open with plain h5py."""
    with h5py.File(folder + "/run.h5") as results:
        rows = []
        results["history"].visititems(lambda name, node: rows.append((name, node[...]))
                                      if isinstance(node, h5py.Dataset) else None)
        times = results["history/time"][:]
    least = max(said, default=-1) + 1
    check(len(times) >= least and np.allclose(times, 0.002 * np.arange(len(times))),
          f"{what}: {len(times)} rows for {least} steps said")
    short = [name for name, values in rows if len(values) < least or not np.isfinite(values).all()]
    check(not short, f"{what}: every history has them {short}")
    steps = sorted(glob.glob(folder + "/fields/step_*.h5"))
    check(len(steps) >= least, f"{what}: {len(steps)} field files")
    for step in steps:
        with h5py.File(step) as fields:
            if not np.isfinite(fields["displacement"][:]).all():
                check(False, f"{what}: {step} is broken")


def killed(attempt):
    folder, log = os.path.join(FOLDER, f"killed_{attempt}"), os.path.join(FOLDER, f"log_{attempt}")
    ranks = 2 if attempt % 5 == 0 else 1
    with open(log, "w") as stream:
        process = started(folder, ranks, stdout=stream, stderr=subprocess.DEVNULL)
        while not os.path.exists(folder + "/run.h5") and process.poll() is None:
            time.sleep(0.002)
        time.sleep(random.random() * (1.5 if LONG else 0.7))
        running = process.poll() is None
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        # Ranks are in groups of their own.
        subprocess.run(["pkill", "-9", "-f", folder], check=False)
    check(running, f"kill {attempt}: it was still running")
    time.sleep(0.05)
    with open(log) as stream:
        whole(folder, steps_said(stream.read()), f"kill {attempt} on {ranks} ranks")


for number in range(200 if LONG else 20):
    killed(number)
if LONG:
    finish()

# The next run says whose lock it takes over, and removes what the killed one left.
folder = os.path.join(FOLDER, "killed_1")
again = run({**settings, "-output_dir": folder, "-time_end": "0.01"})
check(again.returncode == 0 and "note: the lock of a run that died was taken over (host" in again.stdout,
      "a stale lock is taken over, and said")
check(sorted(os.listdir(folder)) == ["fields", "run.h5", "run.xdmf"], f"only results stay {os.listdir(folder)}")
check(len(os.listdir(folder + "/fields")) == 6, "and only of the last run")

# Two runs into one folder: the second touches nothing. A reader with the file open harms nobody.
folder = os.path.join(FOLDER, "two")
first = started(folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
while not os.path.exists(folder + "/fields/step_000010.h5") and first.poll() is None:
    time.sleep(0.01)
with h5py.File(folder + "/run.h5") as reader:
    second = run({**settings, "-output_dir": folder})
    check(second.returncode == 74 and f"process {first.pid}" in error_lines(second)[0],
          f"a second run is refused {error_lines(second)}")
    first.wait()
    check(first.returncode == 0, "the first goes on to its end")
with h5py.File(folder + "/run.h5") as results:
    check(len(results["history/time"]) == len(os.listdir(folder + "/fields")), "with all its steps")
with h5py.File(folder + "/run.h5") as reader:
    again = run({**settings, "-output_dir": folder, "-time_end": "0.01"})
    check(again.returncode == 0 and len(reader["history/time"]) > 100, "and may be run again while it is read")

# Signals end it with one line and their number; one pipe less is no reason to.
for number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
    folder = os.path.join(FOLDER, number.name)
    process = started(folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while not os.path.exists(folder + "/fields/step_000003.h5") and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(number)
    out, error = process.communicate()
    check(process.returncode == 128 + number and error.count("\n") == 1 and number.name in error,
          f"{number.name}: {process.returncode} {error!r}")
    whole(folder, steps_said(out), number.name)
folder = os.path.join(FOLDER, "pipe")
process = started(folder, more={"-time_end": "0.1"}, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
process.stdout.readline()
process.stdout.close()
error = process.stderr.read()
check(process.wait() == 0 and not error, f"a closed pipe: {process.returncode} {error!r}")
with h5py.File(folder + "/run.h5") as results:
    check(len(results["history/time"]) == 51, "the run goes on to its end")


def full(process, folder, what):
    """A run that could not write on: 74, one line, and all it said is there."""
    out, error = process.communicate()
    lines = [line for line in error.splitlines() if line.startswith("trocar: error: ")]
    check(process.returncode == 74 and len(lines) == 1 == len(error.splitlines()),
          f"{what}: {process.returncode} {error!r}")
    said = steps_said(out)
    if os.path.exists(folder + "/run.h5"):
        whole(folder, said, what)
    else:
        check(not said, f"{what}: nothing was said")
    check(not glob.glob(folder + "/.trocar-*") and not glob.glob(folder + "/*/.trocar-*"),
          f"{what}: nothing half written stays")


# A limit on files, from some step on: of field files, then of rows in the middle of run.h5.
for size in (4000, 1000):
    folder = os.path.join(FOLDER, f"limit_{size}")
    process = started(folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while not os.path.exists(folder + "/fields/step_000003.h5") and process.poll() is None:
        time.sleep(0.005)
    resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (size, size))
    full(process, folder, f"files of {size} bytes at most")
disk = tempfile.mkdtemp(dir=FOLDER)
if os.geteuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=100k", "tmpfs", disk],
                                       capture_output=True).returncode != 0:
    print("skipped: only root can make small disks")
else:
    try:
        for size in ("100k", "150k", "200k", "300k", "500k", "1m", "2m"):
            subprocess.run(["mount", "-o", f"remount,size={size}", disk], check=True)
            process = started(disk + "/run", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            full(process, disk + "/run", f"disk of {size}")
            subprocess.run(["rm", "-rf", disk + "/run"], check=True)
    finally:
        subprocess.run(["umount", disk], check=True)
finish()
