"""scripts/calibrate: finds the truth, states honest intervals, refuses what data cannot tell."""
import csv
import glob
import os
import re
import subprocess
import sys

import h5py
import numpy as np

from harness import FOLDER, PROGRAM, ROOT, check, completed, finish, run, small_block

sys.path.insert(0, os.path.join(ROOT, "scripts", "calibration"))
from curves import write_curves  # noqa: E402
from fit import calibrate  # noqa: E402
from synthetic import TRUTH, synthetic_curves  # noqa: E402

SHIPPED = os.path.join(ROOT, "tests", "data", "insertion_synthetic.csv")
OUTPUT = os.path.join(FOLDER, "fit")


def script(*arguments, through=(sys.executable, os.path.join(ROOT, "scripts/calibration/main.py"))):
    return subprocess.run([*through, *map(str, arguments)], capture_output=True, text=True,
                          timeout=600)


def fitted(*arguments):
    """Rows of fit.csv by parameter; stops when the script fails."""
    process = script(*arguments, "--output", OUTPUT)
    if process.returncode != 0:
        raise SystemExit(f"calibrate failed with {process.returncode}: {process.stderr}")
    with open(os.path.join(OUTPUT, "fit.csv"), newline="") as stream:
        return {row["parameter"]: row for row in csv.DictReader(stream)}


def written(name, text):
    path = os.path.join(FOLDER, name)
    with open(path, "w") as stream:
        stream.write(text)
    return path


def refuses(what, code, words, *arguments):
    process = script(*arguments, "--output", OUTPUT)
    lines = process.stderr.splitlines()
    good = (process.returncode == code and len(lines) == 1 and
            lines[0].startswith("calibrate: error: ") and all(w in lines[0] for w in words))
    check(good, f"{what}: {process.returncode} {lines[-1:]}")


def synthetic_data():
    again = os.path.join(FOLDER, "again.csv")
    script("--synthetic", again, through=[os.path.join(ROOT, "scripts", "calibrate")])
    with open(again) as mine, open(SHIPPED) as shipped:
        check(mine.read() == shipped.read(), "tests/data holds what --synthetic writes")
    rows = fitted(SHIPPED)
    for name, truth in TRUTH.items():
        value, low, high = (float(rows[name][c]) for c in ("value", "low95", "high95"))
        check(low <= truth <= high, f"{name}: {low:.5g} <= {truth:g} <= {high:.5g}")
        check(abs(value / truth - 1) < 0.02, f"{name}: {value:.5g} is within 2 % of {truth:g}")
    for name in ("fit.csv", "fit.opts", "fit.png"):
        check(os.path.getsize(os.path.join(OUTPUT, name)) > 500, f"{name} is there")


def coverage(seeds=100):
    hits = dict.fromkeys(TRUTH, 0)
    for seed in range(seeds):
        estimates = calibrate(synthetic_curves(seed)).estimates
        for name, truth in TRUTH.items():
            hits[name] += estimates[name].low <= truth <= estimates[name].high
    for name, count in hits.items():
        check(0.85 * seeds <= count, f"{name}: {count} of {seeds} intervals hold the truth")


def files_of_runs():
    """One file per velocity is the same as one file; one velocity alone is refused."""
    curves = synthetic_curves()
    files = [os.path.join(FOLDER, f"speed_{k}.csv") for k in range(len(curves))]
    for file, curve in zip(files, curves):
        write_curves(file, [curve])
    one, many = fitted(SHIPPED), fitted(*files)
    check(all(np.isclose(float(one[n]["value"]), float(many[n]["value"]), rtol=1e-12) for n in one),
          "a file per velocity gives the same")
    lines = "".join(f"{v:.9g},{t:.9g},{z:.9g},{f:.9g},{c.name}\n" for c in curves
                    for v, t, z, f in zip(c.rate, c.time, c.depth, c.force))
    told = fitted(written("told.csv", "velocity,time,depth,force,run\n" + lines))
    check(all(np.isclose(float(one[n]["value"]), float(told[n]["value"]), rtol=1e-6) for n in one),
          "a velocity column is used, in any order of columns")
    refuses("a single velocity", 65, ["dynamic", "viscous", "two clearly different velocities",
                                      "--viscous 0"], files[0])
    refuses("the withdrawal too", 65, ["withdrawal", "viscous_withdraw", "--viscous-withdraw 0"],
            files[0], "--viscous", "0")
    rows = fitted(files[0], "--viscous", "900", "--viscous-withdraw", "1200")
    check(rows["viscous"]["status"] == "fixed" and abs(float(rows["dynamic"]["value"]) - 12) < 0.5,
          f"one velocity with b given: tau {rows['dynamic']['value']}")
    check(rows["puncture"]["status"] == "one run" and rows["puncture"]["low95"] == "",
          "one peak has no interval")
    check("dynamic_withdraw" not in fitted(files[0], "--viscous", "0", "--no-withdrawal"),
          "--no-withdrawal leaves the withdrawal out")
    refuses("a narrow range of depths", 65, ["dynamic", "cutting", "cannot be told apart"],
            files[0], "--no-withdrawal", "--viscous", "900", "--depths", "0.030", "0.032")
    text = open(files[0]).read()
    turned = re.sub(r"(?m)^([\d.e-]+,[\d.e-]+),([-\d.e]+)", r"\1,-\2", text).replace("--", "")
    refuses("a force of the wrong sign", 65, ["negative"], written("turned.csv", turned),
            "--viscous", "0", "--no-withdrawal")
    refuses("no law to fix", 64, ["--viscous"], files[0], "--viscous", "-1")
    refuses("an unknown option", 64, ["--viscos"], files[0], "--viscos", "1")
    refuses("no file", 64, ["no CSV"])


def bad_files():
    header = "time,depth,force\n"
    rows = [f"{k},{k * 1e-3},{0.1 * k}\n" for k in range(40)]

    def bad(what, words, text):
        path = written(what.replace(" ", "_") + ".csv", text)
        refuses(what, 65, [os.path.basename(path), *words], path)

    def with_row(row):
        return header + "".join(rows[:20]) + row + "\n" + "".join(rows[21:])

    refuses("missing file", 65, ["nowhere.csv"], "nowhere.csv")
    bad("empty", ["empty"], "")
    bad("header alone", ["no rows"], header)
    bad("missing column", ["line 1", "'force'"], "time,depth\n0,0\n")
    bad("wrong header", ["line 1", "'fource'"], "time,depth,force,fource\n0,0,0,0\n")
    bad("no header", ["line 1", "'time'"], "".join(rows))
    bad("NaN", ["line 22", "column force", "nan"], with_row("20,0.02,nan"))
    bad("a word", ["line 22", "column depth", "deep"], with_row("20,deep,1"))
    bad("a short row", ["line 22", "2 columns"], with_row("20,0.02"))
    bad("time running back", ["line 22", "column time", "increase"], with_row("18.5,0.02,2"))
    bad("time standing still", ["line 22", "increase"], with_row("19,0.02,2"))
    bad("few rows", ["5 rows"], header + "".join(rows[:5]))
    bad("no advance", ["no advance"], header + "".join(f"{k},0.01,1\n" for k in range(40)))
    bad("velocity of the wrong sign", ["column velocity", "sign"], "time,depth,force,velocity\n" +
        "".join(row.strip() + ",-0.001\n" for row in rows))
    refuses("no run", 65, ["run.h5"], "--from-run", "run.h5", os.path.join(FOLDER, "no.csv"))


def noisy(path):
    """White noise of 2 mN on the force column: without any, the statistics have nothing to say."""
    with open(path) as stream:
        header, *rows = [line for line in stream.read().splitlines() if not line.startswith("#")]
    column = header.split(",").index("force")
    noise = np.random.default_rng(3).normal(0.0, 2e-3, len(rows))
    with open(path, "w") as stream:
        stream.write(header + "\n")
        for row, error in zip(rows, noise):
            cells = row.split(",")
            cells[column] = repr(float(cells[column]) + error)
            stream.write(",".join(cells) + "\n")


def closed_loop(tip):
    """Two runs of the program in stiff tissue: their curves give back what was put in. With the
    tip's laws the force is one step behind the depth, some per mille of it."""
    files = []
    put_in = {"dynamic": 12.0, "viscous": 900.0,
              "dynamic_withdraw": 14.0, "viscous_withdraw": 1200.0}
    for k, velocity in enumerate((0.002, 0.006)):
        folder = completed({
            "-mesh": small_block(), "-fix": "z0", "-analysis": "static", "-tissue_model": "linear",
            "-tissue_young": "1e8", "-tissue_poisson": "0.4", "-needles": "needle",
            "-needle_model": "rigid", "-needle_entry": "0,0.0203,0.0207",
            "-needle_direction": "1,0,0", "-needle_length": "0.08", "-needle_radius": "0.0005",
            "-needle_velocity": str(velocity), "-needle_withdraw_velocity": str(velocity),
            "-needle_depth": "0.03", "-time_step": str(3e-4 / velocity),
            "-time_end": str(0.06 / velocity), "-output_fields": "",
            "-insertion_friction_static": "12", "-insertion_friction_static_withdraw": "14",
            **{f"-insertion_{name}_force": str(value) for name, value in tip.items()},
            **{f"-insertion_friction_{name}": str(value) for name, value in put_in.items()}})
        files.append(os.path.join(FOLDER, f"run_at_{k}.csv"))
        script("--from-run", os.path.join(folder, "run.h5"), files[-1])
        if tip:
            noisy(files[-1])
    rows = fitted(*files, "--entry", "0") if tip else fitted(*files, "--cutting", "0")
    for name, truth in {**put_in, **tip}.items():
        error = float(rows[name]["value"]) / truth - 1
        check(abs(error) < (0.03 if tip else 2e-4), f"closed loop, {name}: {rows[name]['value']} (error {error:.1e})")
    accepted(os.path.join(OUTPUT, "fit.opts"), "the fitted options")


def accepted(path, what):
    """The program takes the options after those of a scene, and the later file wins."""
    with open(path) as stream:
        lines = [line for line in stream if line.startswith("-")]
    folder = os.path.join(FOLDER, "accepted")
    process = run({"-options_file": os.path.join(ROOT, "options", "small_insertion.opts"),
                   "-mesh": small_block(), "-time_end": "0.02", "-quiet": "",
                   "-output_dir": folder},
                  arguments=("-options_file", path))
    check(process.returncode == 0, f"{what}: a run after a scene's file {process.stderr[-300:]}")
    with h5py.File(os.path.join(folder, "run.h5")) as results:
        names = [n.decode() for n in results["provenance/options/name"][:]]
        values = [v.decode() for v in results["provenance/options/value"][:]]
    for line in lines:
        option, value = line.split()[:2]
        used = {values[k] for k, name in enumerate(names)
                if name in (option[1:], option[1:].replace("insertion_", "insertion_beam_"))}
        check(value in used, f"{what}: {option} {value} is used")


def presets():
    for path in sorted(glob.glob(os.path.join(ROOT, "options", "tissue", "*.opts"))):
        name = os.path.basename(path)
        with open(path) as stream:
            card = [line for line in stream if line.startswith("#")]
        for word in ("Source", "Needle", "Tissue", "Measured", "Uncertainty", "Use"):
            check(any(line.startswith("# " + word) for line in card),
                  f"{name}: the card says '{word}'")
        with open(os.path.join(ROOT, "docs", "calibration.md")) as stream:
            check(name in stream.read(), f"{name}: docs/calibration.md names it")
        accepted(path, name)


synthetic_data()
coverage()
files_of_runs()
bad_files()
closed_loop({})
closed_loop({"cutting": 0.5, "puncture": 1.5})
presets()
finish()
