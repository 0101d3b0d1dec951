"""Error against run time and against dofs: elements, providers, mesh sizes, on three scenes.

shell      dP/dV of a cavity against Lame's closed form, nu = 0.3, 0.485, 0.4999
phantom    pressure in the fluid paper's phantom after 9 mm, against the finest p2
insertion  displacement of a target 2 cm beside a needle's path, against the finest p2
Meshes are made anew for every size, of order 2 (linear tets use their corners), that of the
phantom straight: Gmsh folds some of its curved tets. Time is processor
time of the whole process on one rank, median of three: other jobs blur it less than a clock's.
Writes results/work_precision/{SCENE.csv,SCENE.png} and prints what 1 % costs with every method.
"""
import resource
import statistics
import subprocess
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import ROOT, begin, write_table

TARGET = np.array([0.035, 0.0445, 0.0291])  # 2.1 cm beside the path
INNER, OUTER, YOUNG = 0.011, 0.025, 15000.0
P1 = ("p1", "p1 ksp", "p1_anp")
P2 = ("p2", "p2_bbar", "p2_anp")


def processor_seconds():
    """Of all finished children."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def make_mesh(geometry, h, **numbers):
    """A mesh of meshes/GEOMETRY.geo, round where Gmsh's curved tets are not folded; its path."""
    order = "1" if geometry == "phantom" else "2"
    path = f"build/meshes/wp_{geometry}_{h:g}.msh"
    words = [w for k, v in {"h": h, **numbers}.items() for w in ("-setnumber", k, f"{v:g}")]
    subprocess.run(["gmsh", "-3", "-order", order, f"meshes/{geometry}.geo", *words, "-o", path,
                    "-format", "msh41"], cwd=ROOT, check=True, capture_output=True)
    return path


def pressure_of_volume(poisson):
    """dP / (dV/V) of the closed form [Pa]."""
    bulk, shear = YOUNG / (3 - 6 * poisson), YOUNG / (2 + 2 * poisson)
    wall = (1 / INNER**2 - INNER / OUTER**3) / (3 * bulk / OUTER**3 + 4 * shear / INNER**3)
    return INNER / (3 * wall)


def shell_value(run):
    volume = run["history/cavity/fluid/volume"][:]
    return 1.0 / (volume[-1] / volume[0] - 1.0)


def displacement_at(run, folder, place):
    """Displacement at a place of the reference, in its tet."""
    x, tets = run["mesh/coordinates"][:], run["mesh/tets"][:]
    with h5py.File(sorted((folder / "fields").glob("step_*.h5"))[-1]) as step:
        u = step["displacement"][:]
    corner = x[tets[:, :4]]
    edges = np.transpose(corner[:, 1:] - corner[:, :1], (0, 2, 1))
    inner = np.linalg.solve(edges, (place - corner[:, 0])[:, :, None])[:, :, 0]
    at = np.column_stack([1 - inner.sum(axis=1), inner])
    best = np.argmax(at.min(axis=1))
    L = at[best]
    weight = L
    if tets.shape[1] == 10:
        ends = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
        weight = np.concatenate([L * (2 * L - 1), [4 * L[a] * L[b] for a, b in ends]])
    return weight @ u[tets[best]]


class Scene:
    """A scene with its sizes; `value` reads a number or a vector from a run."""

    def __init__(self, name, option_file, geometry, sizes, changes, value, exact=None, numbers=None):
        self.name, self.option_file, self.geometry, self.sizes = name, option_file, geometry, sizes
        self.changes, self.value, self.exact = changes, value, exact
        self.numbers = numbers or (lambda h: {})

    def run(self, folder, h, method, repeats):
        """Value, nodes and median seconds of the process; None when it fails."""
        element, *provider = method.split()
        changes = {"tissue_element": element, **self.changes}
        if provider:
            changes["compliance_provider"] = provider[0]
        words = [w for k, v in changes.items() for w in (f"-{k}", str(v))]
        path = make_mesh(self.geometry, h, **self.numbers(h))
        seconds = []
        for _ in range(repeats):
            start = processor_seconds()
            done = subprocess.run(
                ["build/trocar", "-options_file", f"options/{self.option_file}", "-mesh", path,
                 "-output_dir", str(folder), "-output_every", "1000000", "-quiet", *words],
                cwd=ROOT, capture_output=True, text=True)
            seconds.append(processor_seconds() - start)
            if done.returncode:
                print(f"{self.name} {method} h {h:g}: {done.stderr.strip()}", file=sys.stderr)
                return None
            if seconds[0] > 10:  # of a long run once is enough
                break
        with h5py.File(folder / "run.h5") as run:
            return self.value(run, folder), len(run["mesh/coordinates"]), statistics.median(seconds)


def scenes(quick):
    steps = {"tissue_model": "linear", "time_initial": "unstressed", "gravity": "0,0,0",
             "time_step": 0.2, "time_end": 2, "needle_hold": 0, "needle_withdraw_velocity": 0,
             "needle_model": "rigid"}
    found = [
        Scene(f"shell_{poisson:g}", "shell.opts", "shell", {"p1": [6e-3, 4e-3, 2.8e-3, 2e-3],
                                                             "p2": [12e-3, 8e-3, 6e-3, 4e-3]},
              {"tissue_poisson": poisson}, lambda run, _: shell_value(run),
              pressure_of_volume(poisson)) for poisson in (0.3, 0.485, 0.4999)]
    found.append(Scene(
        "phantom", "phantom.opts", "phantom", {"p1": [6e-3, 4.2e-3, 3e-3, 2.2e-3],
                                               "p2": [12e-3, 8e-3, 6e-3, 4.2e-3]}, {},
        lambda run, _: run["history/cavity/pocket/pressure"][-1],
        numbers=lambda h: {"hw": 0.9 * h}))
    found.append(Scene(
        "insertion", "gel_insertion.opts", "gel", {"p1": [12e-3, 8e-3, 5.5e-3, 4e-3],
                                                   "p2": [24e-3, 16e-3, 12e-3, 8e-3]}, steps,
        lambda run, folder: displacement_at(run, folder, TARGET)))
    if quick:
        for scene in found:
            scene.sizes = {order: sizes[:1] for order, sizes in scene.sizes.items()}
    return found


def measure(scene, folder, repeats):
    """Rows of all methods; errors against the closed form or the finest p2 run."""
    rows = []
    for method in P1 + P2:
        sizes = scene.sizes[method[:2]]
        for h in sizes:
            found = scene.run(folder / "run", h, method, repeats)
            if found:
                rows.append({"method": method, "h_mm": f"{1e3 * h:g}", "nodes": found[1],
                             "seconds": found[2], "value": found[0]})
    exact = scene.exact
    if exact is None:
        finest = scene.run(folder / "run", 0.75 * scene.sizes["p2"][-1], "p2", 1)
        if not finest:
            raise SystemExit(f"{scene.name}: no reference")
        exact = finest[0]
    for row in rows:
        row["error"] = float(np.linalg.norm(row["value"] - exact) / np.linalg.norm(exact))
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
        return float(np.exp(s1 + (np.log(error) - e1) * (s1 - s0) / (e1 - e0))), "extrapolated "
    return None, "never"


def draw(scene, rows, folder):
    figure, axes = plt.subplots(1, 2, figsize=(9, 4.2), sharey=True, constrained_layout=True)
    for axis, key, label in zip(axes, ("seconds", "nodes"), ("processor time [s]", "nodes")):
        for method in P1 + P2:
            mine = [r for r in rows if r["method"] == method]
            axis.loglog([r[key] for r in mine], [r["error"] for r in mine], "o-", ms=4, label=method)
        axis.axhline(0.01, color="k", lw=0.6, ls=":")
        axis.set(xlabel=label)
    best = [r for r in rows if r["front"]]
    axes[0].loglog([r["seconds"] for r in best], [r["error"] for r in best], "ko", ms=9, mfc="none",
                   label="Pareto front")
    axes[0].set(ylabel="relative error", title=scene.name.replace("_", ", ν = "))
    axes[0].legend(frameon=False, fontsize=8)
    figure.savefig(folder / f"{scene.name}.png", dpi=130)
    plt.close(figure)


def main():
    quick, folder = begin("work_precision", "one size of each, one run")
    for scene in scenes(quick):
        rows = measure(scene, folder, 1 if quick else 3)
        mark_front(rows)
        draw(scene, rows, folder)
        for method in P1 + P2:
            seconds, how = cost(rows, method)
            print(f"{scene.name} {method}: 1 % costs " + (f"{how}{seconds:.2g} s" if seconds else how))
        write_table(folder / f"{scene.name}.csv",
                    [{**r, "error": f"{r['error']:.3g}", "seconds": f"{r['seconds']:.3f}"}
                     for r in rows])
    print(f"wrote {folder}/*.csv and *.png")


main()
