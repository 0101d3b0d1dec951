"""A run that goes on from a checkpoint is the one that went through, to the last bit on as many ranks, to 1e-10 on
others. With --long every shipped scene from its middle, and stopped at every step."""
import os
import random
import shutil
import sys

import h5py
import numpy as np

from harness import (FOLDER, check, completed, error_lines, finish, geometry, histories, ledger, options, refusal, run,
                     structured, written)
from restart_kit import copied, deterministic, differences, gone_on, scene, text

LONG = "--long" in sys.argv
random.seed(2)


def from_the_middle(what, settings, every, ranks=1):
    """Through to the end with one checkpoint on the way; again from there; the same."""
    settings = {**settings, "-checkpoint_every": str(every)}
    through = completed(settings, ranks)
    again = copied(through, f"again_{what}_{ranks}".replace(" ", "_"))
    with h5py.File(again + "/checkpoint_a.h5") as file:
        check(file["run/steps"][0] == every, f"{what}: the checkpoint is that of step {every}")
    gone_on(settings, again, ranks)
    check(not differences(through, again), f"{what} on {ranks} ranks from step {every}: "
          f"{differences(through, again)[:6]}")
    return through, settings


def step_by_step(what, settings):
    """Stopped and gone on at every step."""
    settings = deterministic({**settings, "-checkpoint_every": "1"})
    through = completed(settings)
    folder = os.path.join(FOLDER, "stepping_" + what)
    stops = 0
    # Without wall time left, every run ends with its first step.
    while stops < 2000:
        start = {"-restart": folder} if stops else {}
        process = run({**settings, "-output_dir": folder, "-quiet": "", "-time_wall": "1e-9", **start})
        if process.returncode != 75:
            break
        stops += 1
    check(process.returncode == 0, f"{what}: comes to its end after {stops} stops {process.stderr[-300:]}")
    check(not differences(through, folder), f"{what}: {stops} restarts change nothing "
          f"{differences(through, folder)[:6]}")
    return stops


SHIPPED = {"small_insertion": 200, "gel_insertion": 224, "layers": 450, "bladder_puncture": 400, "close_points": 100,
           "compression_test": 5, "force_profile": 523, "gravity_sag": 50, "phantom": 3, "pulsing_vessel": 125,
           "sideways": 50, "line_insertion": 224, "steering": 210, "two_laws": 5, "branch": 100,
           "ball_on_block": 40}

if LONG:
    for name, steps in SHIPPED.items():
        shipped = scene(name + ".opts")
        for every in sorted({max(1, steps * k // 4 + 1) for k in (1, 2)} - {steps}):
            if 2 * every > steps:
                from_the_middle(name, deterministic(shipped), every)
                from_the_middle(name, deterministic(shipped), every, ranks=2)
        stops = step_by_step(name, shipped)
        check(stops >= steps - 1, f"{name}: {stops} stops in {steps} steps")
else:
    small = scene("small_insertion.opts", output_every="10", time_end="2")
    gel = scene("gel_insertion.opts", time_end="4", output_every="20", output_fields="displacement,velocity")
    from_the_middle("small", deterministic(small), 57)
    from_the_middle("gel", deterministic(gel), 52, ranks=2)
    from_the_middle("pulsing", deterministic(scene("pulsing_vessel.opts", time_end="0.4")), 13, ranks=2)
    from_the_middle("puncture", deterministic(scene("bladder_puncture.opts", time_end="5.4", time_step="0.05")), 61)
    from_the_middle("static", deterministic(scene("two_laws.opts")), 3)
    from_the_middle("contact", deterministic(scene("ball_on_block.opts", time_end="1.2", time_step="0.1")), 7)
    step_by_step("small", {**small, "-time_end": "0.5"})

# Run twice, or on other ranks.
small = scene("small_insertion.opts", output_every="50", time_end="2")
turning = scene("gel_insertion.opts", time_end="2.4", output_every="20")
for n in range(10 if LONG else 1):
    one, other = (completed(deterministic(turning), 2) for _ in range(2))
    check(not differences(one, other), f"run twice: {differences(one, other)[:6]}")
work = {"time_linearisations", "compliance/new_probes", "compliance/reused_probes", "compliance/passes",
        "compliance/factor_age", "constraint/iterations", "constraint/condition", "constraint/residual",
        "constraint/contraction", "time_residual"}
for name, settings in {"turning": turning, **({"small": small} if LONG else {})}.items():
    settings = {**settings, **options("tight.opts"), "-checkpoint_every": "31"}
    through = completed(settings)
    for ranks in (2, 3):
        folder = copied(completed({**settings, "-time_end": str(31 * float(settings["-time_step"]))}, 4 - ranks),
                        f"other_{name}_{ranks}")
        gone_on(settings, folder, ranks)
        a, b = histories(through), histories(folder)
        worst = max((np.abs(a[key] - b[key]).max() / max(np.abs(a[key]).max(), 1e-12), key)
                    for key in a if key not in work and a[key].size)
        check(worst[0] <= 1e-10, f"{name}: from {4 - ranks} to {ranks} ranks: {worst}")

# Nothing is paid for what is not asked for, and a checkpoint by itself changes no number that matters.
plain, kept = completed(small), completed({**small, "-checkpoint_every": "31"})
check("checkpoint.txt" not in os.listdir(plain), "no checkpoint without being asked")
more = ledger(kept)["factorisations"] - ledger(plain)["factorisations"]
check(0 <= more <= 3, f"a checkpoint costs a factorisation: {more} for 3")


# A longer run keeps its steps, and meets an end that is none of theirs with the first one after it.
short = {**small, "-time_end": "1", "-checkpoint_every": "25"}
folder = completed(short)
process = run({**short, "-restart": folder, "-output_dir": folder, "-time_end": "1.507"})
times = histories(folder)["time"]
check(process.returncode == 0 and "the run ends at t = 1.52" in process.stdout and abs(times[-1] - 1.52) < 1e-12
      and np.allclose(np.diff(times), 0.02), f"a longer run ends at {times[-1]}")
through = completed({**short, "-time_end": "1.52"})
shared = histories(through)["needle/needle/base_force"][:51]
check(np.array_equal(shared, histories(folder)["needle/needle/base_force"][:51]), "and has the same steps before")

# Another folder begins after the checkpoint and leaves the first alone.
before = {name: os.path.getmtime(os.path.join(folder, name)) for name in os.listdir(folder)}
branch = completed({**short, "-restart_from": folder, "-time_end": "2", "-needle_velocity": "0.02",
                    "-needle_hold": "0.2"})
check(abs(histories(branch)["time"][0] - 1.52) < 1e-12 and os.path.exists(branch + "/fields/step_000100.h5"),
      "a branch begins after the checkpoint of step 75 and goes on counting")
check(before == {name: os.path.getmtime(os.path.join(folder, name)) for name in os.listdir(folder)},
      "and touches nothing of the other run")
if not LONG:
    base = completed({**scene("branch.opts"), "-checkpoint_every": "100"})
    last = {}
    for name in ("faster", "withdrawn", "turned"):
        more = {key: value for key, value in options(f"branch_{name}.opts").items() if key != "-options_file"}
        last[name] = histories(completed({**scene("branch.opts"), **more, "-restart_from": base}))
    force = {name: found["needle/needle/base_force"][:, 0] for name, found in last.items()}
    check(force["faster"][10] > 1.5 * force["turned"][10] and force["withdrawn"][10] < 0, "branch_*.opts differ")
    check(last["turned"]["needle/needle/depth"][-1] > 0.06, "as their cards say")

# What may not change, and what is no checkpoint.
curve = written("push.csv", "time,factor\n0,0\n2,1\n")
scene_of_refusals = {**short, "-boundary_z1_traction": "1,0,0", "-boundary_z1_curve": curve}
folder = completed(scene_of_refusals)
refused = refusal({**scene_of_refusals, "-restart": folder})


def refuses(what, code, words, changes, **more):
    refused(what, code, words, {"-output_dir": folder, **changes}, **more)


refuses("another material", 64, ["-tissue_beam_young", "5000"], {"-tissue_young": "5001"})
refuses("another needle", 64, ["-needle_needle_radius"], {"-needle_radius": "0.0006"})
refuses("another motion", 64, ["-needle_needle_velocity", "-restart_from"], {"-needle_velocity": "0.03"})
refuses("another mesh", 64, ["-mesh"], {"-mesh": structured("longer", *"--nodes 8 5 5 --size 0.06 0.04 0.04 --split 5".split())})
refuses("another step", 64, ["-time_step"], {"-time_step": "0.01"})
refuses("an end before", 64, ["-time_end", "before the checkpoint"], {"-time_end": "0.5"})
refuses("another folder", 64, ["-output_dir", "-restart_from"], {"-output_dir": folder + "_other"})
refuses("no name", 64, ["-restart:", "missing"], {"-restart": ""})
refuses("its own branch", 64, ["-restart_from", "would replace"],
        {"-restart_from": folder, "-output_dir": folder + "/../" + os.path.basename(folder)}, remove=["-restart"])
refuses("other histories", 64, ["-constraint_compare"], {"-constraint_compare": "pgs"})
refuses("more needles", 64, ["-needles", "'needle'"], {"-needles": "needle,other"})
refuses("no needle", 64, ["-needles"], {"-needles": '""'}, remove=["-restart_nothing"])
refuses("an energy account", 64, ["-output_energy"], {"-output_energy": ""})
refuses("a branch without a step", 64, ["-time_end", "no step is left"],
        {"-restart_from": folder, "-output_dir": folder + "_late"}, remove=["-restart"])
refuses("none there", 65, ["has no checkpoint"], {"-restart": FOLDER, "-output_dir": FOLDER})
refuses("a jump", 64, ["-restart_from", "would jump by"],
        {"-restart_from": folder, "-output_dir": folder + "_jump", "-needle_velocity": "0.03", "-time_end": "2"}, remove=["-restart"])
changed = written("changed.csv", "time,factor\n0,0\n2,2\n")
refuses("other contents", 64, ["-boundary_z1_curve"], {"-boundary_z1_curve": changed})
moved = written("moved.csv", text(curve))
done = run({**scene_of_refusals, "-restart": folder, "-output_dir": folder})
check(done.returncode == 0 and "no step is left" in done.stdout, f"nothing is left to do {done.stdout[-200:]}")
longer = {"-time_end": "1.2"}
good = run({**scene_of_refusals, "-boundary_z1_curve": moved, "-restart": folder, "-output_dir": folder,
            "-tissue_young": "5e3", "-needle_direction": "1.0,0,0", "-output_energy": "0", "-constraint_tolerance": "1e-10",
            "-quiet": "", **longer})
check(good.returncode == 0, f"the same in another file, number or tolerance is taken {good.stderr}")

# A run.h5 that is damaged, of another run, or gone: 65 or, of a bit that nobody reads, no matter; never a crash.
kept = copied(folder, "kept")
with open(kept + "/run.h5", "rb") as stream:
    whole = stream.read()
for n in range(200 if LONG else 8):
    broken = bytearray(whole)
    broken[random.randrange(len(broken) if n % 2 else 20000)] ^= 1 << random.randrange(8)
    with open(kept + "/run.h5", "wb") as stream:
        stream.write(broken)
    process = run({**scene_of_refusals, **longer, "-restart": kept, "-output_dir": kept, "-quiet": ""})
    if process.returncode == 0:  # a row that comes again, or its count
        shutil.rmtree(kept)
        kept = copied(folder, "kept")
    check(process.returncode == 0 or (process.returncode == 65 and "run.h5" in error_lines(process)[0]),
          f"a flipped bit of run.h5: {process.returncode} {error_lines(process)}")
shutil.copy(completed({**scene_of_refusals, "-tissue_young": "9000", "-time_end": "2"}) + "/run.h5", kept + "/run.h5")
process = run({**scene_of_refusals, **longer, "-restart": kept, "-output_dir": kept, "-quiet": ""})
check(process.returncode == 65 and "run.h5" in error_lines(process)[0], f"another run's {error_lines(process)}")
os.remove(kept + "/run.h5")
process = run({**scene_of_refusals, **longer, "-restart": kept, "-output_dir": kept, "-quiet": ""})
check(process.returncode == 65 and "not there" in error_lines(process)[0], f"none {error_lines(process)}")

# What somebody else calls so is not touched.
own = os.path.join(FOLDER, "own")
os.makedirs(own)
written("own/checkpoint.txt", "my notes")
process = run({**short, "-output_dir": own})
check(process.returncode == 74 and text(own + "/checkpoint.txt") == "my notes", "a stranger's checkpoint.txt stays")

# A name with a blank; a branch that is stopped and goes on with the options it was given.
named = {"-needles": "my needle", **{("-needle_my needle" + key[7:] if key.startswith("-needle_") else key): value
                                     for key, value in short.items() if key != "-needles"}}
folder = completed(named)
gone_on({**named, "-time_end": "1.2"}, folder)
root = completed(short)
branched = {**short, "-restart_from": root, "-time_end": "1.5", "-checkpoint_every": "5"}
through = completed(branched)
folder = os.path.join(FOLDER, "branched")
check(run({**branched, "-output_dir": folder, "-time_wall": "1e-9"}).returncode == 75, "a branch is stopped")
gone_on({**branched, "-restart": folder}, folder)
check(histories(folder)["time"].size == histories(through)["time"].size, "and goes on with the options it was given")
finish()
