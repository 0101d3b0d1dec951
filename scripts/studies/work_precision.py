"""Error against run time and against dofs: elements, providers, mesh sizes, time steps, solvers.

cube_NU       a manufactured field without forces in a cube, L2 error of the displacement
shell_NU      dP/dV of a cavity in a free hollow sphere against Lame's closed form
eshelby       liquid sphere in a strained body: pressure and shape against Eshelby's closed form
cantilever    block held at one end under its weight: sag of the other end
phantom       pressure in the fluid paper's phantom after 9 mm
insertion     displacement of a target 2 cm beside a needle's path, 50 steps: points with and without
              the radius correction, and a line
swing, insertion_dt  the same two bodies over time steps: backward Euler and bdf2
constraints   residual against time of the constraint solvers on the same problems
Without a closed form the reference is p2 on a mesh finer than all others, in insertion with a line.
Meshes are made anew for every size; round ones are curved for quadratic tets, but the phantom's:
Gmsh folds some of its. Time is processor time of the whole process on one rank, median of three (of
long runs one): other jobs blur it less than a clock's. Writes
results/work_precision/{SCENE.csv,SCENE.png}, prints what 1 % costs.
"""
import argparse
import resource
import statistics
import subprocess
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import ROOT, save, write_table
from precision_scenes import scenes
from precision_steps import SCHEMES, SOLVERS, STEPS, constraint_solvers, time_steps

LONG = 8.0  # [s]: such runs are timed once
FAR = 100.0  # times the longest run: what would cost more is not extrapolated
FINER = 0.6  # edges of the reference's mesh over the finest of the study


def processor_seconds():
    """Of all finished children."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def timed(words, folder, repeats):
    """Median seconds of a run; None when it fails, which is said."""
    seconds = []
    for _ in range(repeats):
        start = processor_seconds()
        done = subprocess.run(
            ["build/trocar", "-output_dir", str(folder), "-output_every", "1000000", "-quiet",
             *words], cwd=ROOT, capture_output=True, text=True)
        seconds.append(processor_seconds() - start)
        if done.returncode:
            print(f"{' '.join(words)}: {done.stderr.strip()}", file=sys.stderr)
            return None
        if seconds[0] > LONG:
            break
    return statistics.median(seconds)


def over_meshes(scene, folder, repeats, quick):
    """Rows of all methods and sizes of a scene."""
    rows = []
    for method in scene.methods:
        sizes = scene.sizes[method[:2]]
        for h in sizes[:1] if quick else sizes:
            seconds = timed(scene.words(h, method, folder), folder / "run", repeats)
            if seconds is None:
                continue
            found, nodes = scene.judge(folder / "run")
            rows.append({"method": method, "h_mm": f"{1e3 * h:g}", "nodes": nodes,
                         "seconds": seconds, "value": found})
    if scene.error:
        return [{**row, "error": row["value"]} for row in rows]
    exact = scene.exact
    if exact is None:
        h = FINER * scene.sizes["p2"][0 if quick else -1]
        if timed(scene.words(h, scene.reference, folder), folder / "run", 1) is None:
            raise SystemExit(f"{scene.name}: no reference")
        exact, _ = scene.judge(folder / "run")
    return with_errors(rows, exact)


def over_steps(name, folder, repeats, quick):
    def one(words, value, once=False):
        seconds = timed(words, folder / "run", 1 if once else repeats)
        if seconds is None:
            raise SystemExit(f"{name}: a run failed")
        with h5py.File(folder / "run/run.h5") as run:
            return {"seconds": seconds, "value": value(run, folder / "run")}
    rows, exact = time_steps(name, folder, one, quick)
    return with_errors(rows, exact)


def with_errors(rows, exact):
    """Errors relative to the exact numbers, in the norm of all of them."""
    for row in rows:
        off = np.asarray(row["value"]) - exact
        row["error"] = float(np.linalg.norm(off) / np.linalg.norm(exact))
        row["value"] = np.array2string(np.atleast_1d(row["value"]), precision=6)[1:-1]
    return rows


def mark_front(rows):
    """A run is on the front when none is both faster and more accurate."""
    for row in rows:
        row["front"] = not any(o["seconds"] < row["seconds"] and o["error"] < row["error"]
                               for o in rows)


def cost(rows, method, error=0.01):
    """Seconds for an error, between the runs of a method on log scales; beyond its finest run by
    its last two (then marked)."""
    mine = sorted((r for r in rows if r["method"] == method), key=lambda r: r["seconds"])
    logs = [(np.log(r["error"]), np.log(r["seconds"])) for r in mine]
    if logs and mine[0]["error"] <= error:
        return mine[0]["seconds"], "at most "
    for (e0, s0), (e1, s1) in zip(logs, logs[1:]):
        if min(e0, e1) <= np.log(error) <= max(e0, e1):
            return float(np.exp(s0 + (np.log(error) - e0) * (s1 - s0) / (e1 - e0))), ""
    if len(logs) > 1 and logs[-1][0] < logs[-2][0]:
        (e0, s0), (e1, s1) = logs[-2:]
        seconds = float(np.exp(min(50.0, s1 + (np.log(error) - e1) * (s1 - s0) / (e1 - e0))))
        if seconds < FAR * mine[-1]["seconds"]:
            return seconds, "extrapolated "
    return None, "never"


def draw(name, rows, methods, folder):
    keys = [("seconds", "processor time [s]")]
    if "nodes" in rows[0]:
        keys.append(("nodes", "nodes"))
    figure, axes = plt.subplots(1, len(keys), figsize=(1 + 4 * len(keys), 4.2), sharey=True,
                                squeeze=False, constrained_layout=True)
    for axis, (key, label) in zip(axes[0], keys):
        for method in methods:
            mine = [r for r in rows if r["method"] == method]
            axis.loglog([r[key] for r in mine], [r["error"] for r in mine],
                        "s--" if method.split()[1:] else "o-", ms=4,
                        label=method.replace("_", " ") if len(keys) == 1 else method)
        if name != "constraints":
            axis.axhline(0.01, color="k", lw=0.6, ls=":")
        axis.set(xlabel=label)
        axis.grid(alpha=0.3)
    best = [r for r in rows if r["front"]]
    axes[0, 0].loglog([r["seconds"] for r in best], [r["error"] for r in best], "ko", ms=9,
                      mfc="none", label="Pareto front")
    if name == "constraints":
        axes[0, 0].set(xlabel="median time of a solve [s]")
    axes[0, 0].set(ylabel="median residual [m]" if name == "constraints" else "relative error",
                   title=name.replace("_0", ", ν = 0").replace("_dt", ", time steps"))
    axes[0, 0].legend(frameon=False, fontsize=8)
    save(figure, folder / f"{name}.png")
    plt.close(figure)


def report(name, rows, methods, folder):
    mark_front(rows)
    draw(name, rows, methods, folder)
    for method in methods if name != "constraints" else ():
        seconds, how = cost(rows, method)
        print(f"{name} {method}: 1 % costs " + (f"{how}{seconds:.2g} s" if seconds else how))
    write_table(folder / f"{name}.csv",
                [{**r, "error": f"{r['error']:.3g}", "seconds": f"{r['seconds']:.4g}"}
                 for r in rows])


def main():
    by_mesh = {scene.name: scene for scene in scenes()}
    names = [*by_mesh, *STEPS, "constraints"]
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="one or two sizes of each, one run")
    parser.add_argument("scenes", nargs="*", help=f"of {', '.join(names)}; all without")
    args = parser.parse_args()
    if unknown := set(args.scenes) - set(names):
        parser.error(f"no scene {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    folder = ROOT / "results/work_precision"
    folder.mkdir(parents=True, exist_ok=True)
    repeats = 1 if args.quick else 3
    for name in args.scenes or names:
        if name in by_mesh:
            scene = by_mesh[name]
            report(name, over_meshes(scene, folder, repeats, args.quick), scene.methods, folder)
        elif name in STEPS:
            report(name, over_steps(name, folder, repeats, args.quick), SCHEMES, folder)
        else:
            report(name, constraint_solvers(folder, args.quick), SOLVERS, folder)
    print(f"wrote {folder}/*.csv and *.png")


main()
