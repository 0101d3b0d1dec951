"""What the stress scenarios share: base settings, runs that never raise, the table."""
import csv
import glob
import os
import subprocess
import time
from dataclasses import dataclass, field

import h5py
import numpy as np

import harness

TOLERANCE = 1e-9  # [m], on the worst residual of a run
DYNAMIC = {"analysis": "dynamic", "tissue_rayleigh_stiffness": 0.02}
SCENARIOS = []  # (title, function, quick)


def scenario(title, quick=False):
    """Registers a scenario: a function of the table. Quick ones are in the default slice."""
    def keep(function):
        SCENARIOS.append((title, function, quick))
        return function
    return keep


def block(**changes):
    """A beam needle 30 mm into a small corotational block, quasi-static, 20 N/m of friction."""
    settings = {
        "mesh": harness.small_block(), "analysis": "static", "fix": "z0", "time_step": 0.05,
        "time_end": 1.6, "tissue_model": "corotational", "tissue_young": 5000,
        "tissue_poisson": 0.4, "needles": "needle", "needle_model": "beam",
        "needle_elements": 10, "needle_entry": "0,0.0237,0.0229", "needle_direction": "1,0,0",
        "needle_length": 0.08, "needle_radius": 0.0005, "needle_velocity": 0.02,
        "needle_depth": 0.03, "insertion_friction_static": 20, "insertion_friction_dynamic": 20,
        "output_every": 100000}
    settings.update(changes)
    return settings


def trajectory(name, rows):
    """Writes the base's places (time, x, y, z, …) as CSV and gives its path."""
    path = os.path.join(harness.FOLDER, name + ".csv")
    header = ["time", "x", "y", "z", "dx", "dy", "dz", "roll"][:len(rows[0])]
    with open(path, "w", newline="") as stream:
        csv.writer(stream).writerows([header, *rows])
    return path


@dataclass
class Run:
    """One run and what is wrong with it whatever it computes."""
    code: int
    folder: str
    stdout: str
    stderr: list
    faults: list = field(default_factory=list)
    h: dict = field(default_factory=dict)

    def needle(self, quantity, name="needle"):
        return self.h[f"needle/{name}/{quantity}"]

    def final(self, quantity, name="needle"):
        return self.needle(quantity, name)[-1]

    def field(self, dataset="displacement", step=-1):
        """A dataset of a field file, by default of the last one."""
        with h5py.File(sorted(glob.glob(self.folder + "/fields/*.h5"))[step]) as file:
            return file[dataset][...]

    def worst(self, history):
        values = self.h.get(history, np.zeros(1))
        return values.max() if len(values) else 0


def attempt(settings, ranks=1, timeout=600):
    """Runs the program on settings (names without the dash); judges exit, streams and files."""
    harness_runs = len(os.listdir(harness.FOLDER))
    folder = os.path.join(harness.FOLDER, f"stress_{harness_runs}")
    words = ["-output_dir", folder]
    if "tissue_element" not in settings:  # the table is of linear tets
        words += ["-tissue_element", "p1"]
    for name, value in settings.items():
        words += ["-" + name] + ([str(value)] if value != "" else [])
    try:
        # -q: no words of mpirun's own, so that stderr is the program's
        launcher = ["mpirun", "-q", "-n", str(ranks)] if ranks > 1 else []
        process = subprocess.run([*launcher, harness.PROGRAM, *words], cwd=harness.ROOT,
                                 capture_output=True, text=True, timeout=timeout)
    except subprocess.TimeoutExpired:
        return Run(-1, folder, "", [], [f"no end after {timeout} s"])
    run = Run(process.returncode, folder, process.stdout, process.stderr.splitlines())
    if os.path.exists(folder + "/run.h5"):
        run.faults += not_finite(folder)
        run.h = harness.histories(folder)
    run.faults += faults_when_done(run) if run.code == 0 else faults_when_rejected(run)
    return run


def not_finite(folder):
    """Datasets of run.h5 and of the field files that hold a NaN or an infinity."""
    found = []
    for path in [folder + "/run.h5", *glob.glob(folder + "/fields/*.h5")]:
        with h5py.File(path) as file:
            def look(name, node):
                if (isinstance(node, h5py.Dataset) and node.dtype.kind == "f"
                        and not np.isfinite(node[...]).all()):
                    found.append(f"not finite: {os.path.basename(path)}/{name}")
            file.visititems(look)
    return found


def faults_when_done(run):
    found = []
    if run.stderr:
        found.append(f"exit 0 with words on stderr: {run.stderr[0]}")
    if not run.h:
        return found + ["exit 0 without run.h5"]
    if run.worst("constraint/residual") > TOLERANCE:
        found.append("residual over the tolerance")
    for name, values in run.h.items():
        friction = abs(run.h.get(name.replace("_work", "").replace("friction", "shaft_friction"), 0))
        if name.endswith("friction_work") and values.max() > 1e-12 + TOLERANCE * np.max(friction):
            found.append(f"friction gives energy: {values.max():.1e} J")
        if name.endswith("/depth") and values.min() < 0.0:
            found.append("negative depth")
    return found


def faults_when_rejected(run):
    if run.code not in (64, 65, 70):
        return [f"exit code {run.code}: {' | '.join(run.stderr[:2])}"]
    if len(run.stderr) != 1 or not run.stderr[0].startswith("trocar: error: "):
        return [f"{len(run.stderr)} lines on stderr: {' | '.join(run.stderr[:3])}"]
    return []


class Table:
    """Rows of the stress table; a row that is not good is a failure of the test."""

    def __init__(self):
        self.rows = []
        self.group = ""
        self.began = time.time()

    def case(self, name, run, test, expect="right"):
        """expect: 'right' (completes and passes the test), 'rejected', or 'either' of them.
        test(run) gives (good, note)."""
        if run.faults:
            good, outcome, note = False, "DEFECT", "; ".join(run.faults)
        elif run.code != 0:
            good, outcome = expect != "right", f"rejected ({run.code})"
            note = run.stderr[0].removeprefix("trocar: error: ")
        else:
            try:
                good, note = test(run)
            except Exception as problem:  # a missing history must not end the table
                good, note = False, f"no comparison: {problem!r}"
            outcome = "right" if good else "WRONG"
            good = good and expect != "rejected"
        self.add(name, run, outcome, bool(good), note)

    def skip(self, name, why):
        self.add(name, Run(0, "", "", []), "skipped", True, why)

    def add(self, name, run, outcome, good, note):
        done = run.h and run.code == 0
        rows, rank = run.worst("constraint/rows"), run.worst("constraint/rank")
        self.rows.append({
            "scenario": f"{self.group}: {name}", "outcome": outcome if good else f"**{outcome}**",
            "residual_m": f"{run.worst('constraint/residual'):.1e}" if done else "",
            "rank/rows": f"{int(rank)}/{int(rows)}" if done else "", "note": note,
            "good": good, "seconds": f"{time.time() - self.began:.2f}"})
        print(f"{'ok     ' if good else 'FAILED '} {self.group}: {name}: {outcome}; {note}", flush=True)
        self.began = time.time()


def relative(a, b):
    """Largest difference of two arrays over the largest entry of the second."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    return abs(a - b).max() / max(abs(b).max(), 1e-300)


def friction_error(run, limit, name="needle"):
    """Worst distance of the shaft friction from limit * depth while every point slips, relative."""
    force, depth = abs(run.needle("shaft_friction", name)), run.needle("depth", name)
    points = run.needle("points", name)
    sliding = (points > 0) & (run.needle("slipping", name) == points)
    if not sliding.any():
        raise ValueError("the needle never slipped as a whole")
    return (abs(force - limit * depth)[sliding] / (limit * depth.max())).max()


def slides(limit=20):
    """A test: the friction is limit * depth while all slips, and never above."""
    def test(run):
        error = friction_error(run, limit)
        excess = (abs(run.needle("shaft_friction")) - limit * run.needle("depth")).max()
        good = error <= 1e-6 and excess <= 1e-6 * limit * run.needle("depth").max()
        return good, f"friction = τ · depth to {error:.0e}, {run.final('shaft_friction'):.4f} N"
    return test


def like(reference, bound, what, displacement=0.0):
    """A test: base force and displacement of the end as those of another run. displacement: its
    own bound, 0 for the same, None to leave it out."""
    def test(run):
        if reference.code != 0:
            return False, f"no comparison: {what} was rejected"
        force = relative(run.final("base_force"), reference.final("base_force"))
        note, good = f"force {force:.1e} (bound {bound:g})", force <= bound
        if displacement is not None:
            most = displacement or bound
            u = relative(run.field(), reference.field())
            note, good = note + f", displacement {u:.1e} ({most:g})", good and u <= most
        return good, f"{note} from {what}"
    return test


def both(*tests):
    def test(run):
        answers = [one(run) for one in tests]
        return all(a[0] for a in answers), "; ".join(a[1] for a in answers)
    return test
