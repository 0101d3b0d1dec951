"""SIGKILL in mid-run: whatever was written opens and is whole."""
import glob
import os
import random
import signal
import subprocess
import time

import h5py
import numpy as np

from harness import FOLDER, PROGRAM, ROOT, check, finish, options, small_block

settings = options("small_insertion.opts")
settings.update({"-mesh": small_block(), "-output_every": "1", "-time_step": "0.002",
                 "-quiet": "", "-tissue_model": "corotational"})
random.seed(1)
for attempt in range(6):
    folder = os.path.join(FOLDER, f"killed_{attempt}")
    words = []
    for name, value in {**settings, "-output_dir": folder}.items():
        words += [name] + ([value] if value else [])
    process = subprocess.Popen(["mpirun", "-n", "2", PROGRAM, *words], cwd=ROOT,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)
    while not glob.glob(folder + "/fields/step_000005.h5") and process.poll() is None:
        time.sleep(0.01)
    time.sleep(random.random())
    running = process.poll() is None
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    # The ranks are in groups of their own; their lock on run.h5 ends with them.
    subprocess.run(["pkill", "-9", "-f", folder], check=False)
    check(running, f"attempt {attempt}: it was still running")
    for _ in range(200):
        try:
            run = h5py.File(folder + "/run.h5")
            break
        except BlockingIOError:
            time.sleep(0.05)
    with run:
        times = run["history/time"][:]
        check(len(times) >= 5 and np.allclose(times, 0.002 * np.arange(len(times))),
              f"attempt {attempt}: {len(times)} history rows are whole")
    steps = sorted(glob.glob(folder + "/fields/step_*.h5"))
    for step in steps:
        with h5py.File(step) as file:
            if not np.isfinite(file["displacement"][:]).all():
                check(False, f"attempt {attempt}: {step} is broken")
    check(len(steps) >= 5, f"attempt {attempt}: {len(steps)} field files are whole")
finish()
