"""Runs that are stopped by signals and clocks, or killed at any moment, and go on: equal to the last bit to the one
that went through. With --long 200 kills."""
import os
import random
import signal
import subprocess
import sys
import time

import h5py

from harness import FOLDER, PROGRAM, check, completed, finish, run
from restart_kit import deterministic, differences, gone_on, scene, started

LONG = "--long" in sys.argv
random.seed(2)


def ranks_of(folder):
    """Processes of the run that writes there, without its launcher."""
    found = subprocess.run(["pgrep", "-f", "-x", f"{PROGRAM} .*{folder}( .*)?"], capture_output=True, text=True)
    return [int(word) for word in found.stdout.split()]


def wait_for(path, process):
    while not os.path.exists(path) and process.poll() is None:
        time.sleep(0.002)


# Stopped by a signal, by one to a single rank, by the clock: 75, and what comes after is the same.
slow = deterministic({**scene("gel_insertion.opts", time_end="2.4", output_every="1"), "-checkpoint_every": "1"})
reference = completed(slow)
for ranks in (1, 2):
    folder = os.path.join(FOLDER, f"stopped_{ranks}")
    process = started({**slow, "-output_dir": folder}, ranks)
    wait_for(folder + "/fields/step_000007.h5", process)
    if ranks == 1:
        process.send_signal(signal.SIGUSR1)
    else:
        os.kill(ranks_of(folder)[-1], signal.SIGUSR1)
    out, error = process.communicate()
    check(process.returncode == 75 and "stopped at the checkpoint of t = " in out and "-restart " + folder in out,
          f"SIGUSR1 to a rank of {ranks}: {process.returncode} {error[-300:]!r}")
    gone_on(slow, folder, ranks)
    if ranks == 1:
        check(not differences(reference, folder), f"after SIGUSR1: {differences(reference, folder)[:6]}")
folder = os.path.join(FOLDER, "wall")
process = run({**slow, "-output_dir": folder, "-time_wall": "0.3"})
check(process.returncode == 75, f"-time_wall ends with 75: {process.returncode}")
gone_on(slow, folder)
check(not differences(reference, folder), f"after -time_wall: {differences(reference, folder)[:6]}")
with h5py.File(folder + "/run.h5") as results:
    check(b"after step" in results["provenance/restart_1"][0], "the record says where it went on")
timed = os.path.join(FOLDER, "timed")
process = run({**slow, "-checkpoint_every": "0", "-checkpoint_seconds": "0.05", "-output_dir": timed})
check(process.returncode == 0 and os.path.exists(timed + "/checkpoint_b.h5"), "-checkpoint_seconds makes some")
for number in (signal.SIGTERM, signal.SIGINT):
    folder = os.path.join(FOLDER, "ended_" + number.name)
    process = started({**slow, "-output_dir": folder})
    wait_for(folder + "/fields/step_000007.h5", process)
    process.send_signal(number)
    out, error = process.communicate()
    check(process.returncode == 75 and error.count("\n") == 1 and number.name in error and "-restart" in error,
          f"{number.name} where a checkpoint stands: {process.returncode} {error!r}")
    gone_on(slow, folder)
    check(not differences(reference, folder), f"after {number.name}: {differences(reference, folder)[:6]}")

# As a run that goes on is ended before it has a checkpoint of its own: the one it goes on from stands.
long_steps = {**slow, "-time_end": "40", "-checkpoint_every": "0"}
process = started({**long_steps, "-restart": folder, "-output_dir": folder})
wait_for(folder + "/fields/step_000070.h5", process)
process.send_signal(signal.SIGTERM)
out, error = process.communicate()
check(process.returncode == 75 and "t = 2.4 s stands" in error, f"SIGTERM after -restart: {process.returncode} {error!r}")

# Killed at any moment, again and again, then left to come to its end; on two ranks one of them alone.
def killed_until_done(name, ranks, most):
    folder, kills = os.path.join(FOLDER, name), 0
    while True:
        go_on = {"-restart": folder} if os.path.exists(folder + "/checkpoint.txt") else {}
        process = started({**slow, "-output_dir": folder, **go_on}, ranks)
        try:
            moment = 0.1 + random.random() * (0.4 if ranks == 1 else 1.0)
            process.communicate(timeout=moment if kills < most else 300)
            return process.returncode, folder, kills
        except subprocess.TimeoutExpired:
            kills += 1
        pids, begun = ranks_of(folder), time.time()
        if ranks > 1 and pids:  # mpirun ends the other one
            os.kill(random.choice(pids), signal.SIGKILL)
        else:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate(timeout=60)
        check(time.time() - begun < 30, f"{name}, kill {kills}: nobody waits")


for ranks, most in ((1, 15), (2, 5)) if not LONG else ((1, 150), (2, 50)):
    left, round_number = most, 0
    expected = reference if ranks == 1 else completed(slow, ranks)
    while left > 0:
        round_number += 1
        code, folder, kills = killed_until_done(f"kills_{ranks}_{round_number}", ranks, left)
        left -= max(kills, 1)
        check(code == 0, f"{ranks} ranks, round {round_number}: comes to its end after {kills} kills")
        check(not differences(expected, folder), f"and is the run that went through: {differences(expected, folder)[:6]}")

# A rank that is stopped, not ended, does not make the other one wait for ever; one that computes for long does.
if LONG:
    folder = os.path.join(FOLDER, "rank_stopped")
    process = started({**slow, "-output_dir": folder}, 2)
    wait_for(folder + "/checkpoint.txt", process)
    begun = time.time()
    os.kill(ranks_of(folder)[-1], signal.SIGSTOP)
    out, error = process.communicate(timeout=120)
    lines = [line for line in error.splitlines() if line.startswith("trocar: error: ")]
    check(process.returncode == 75 and len(lines) == 1 and "has not run for 20 s" in lines[0] and "-restart" in lines[0],
          f"one rank of two is stopped: {process.returncode} {lines}")
    check(time.time() - begun < 30, f"nobody waits above 30 s: {time.time() - begun:.0f}")
    gone_on(slow, folder, 2)
    check(not differences(expected, folder), "and it goes on")
finish()
