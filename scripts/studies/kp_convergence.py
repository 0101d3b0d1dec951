"""Pressure updates of the fluid paper's proportional control against Newton and the exact cubic.

Cold starts at strains of 0.3 to 15 % for a point, traction and plate, two sources of K_p, four
tolerances; the golden section the paper mentions; then a tool path at 512 Hz and 0.1 m/s.
Writes results/kp_convergence_study/{updates.csv,path.csv,kp_convergence.png}.
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import begin, run, save, write_table

HEIGHT, YOUNG = 0.05, 34000.0
TOLERANCES = (1e-2, 1e-3, 1e-6, 1e-12)
SCENE = "kp_convergence.opts"


def load(kind, strain):
    """Options of a load; the scene's plate is turned off by giving its axes free."""
    depth = strain * HEIGHT
    if kind == "plate":
        return {"boundary_top_displacement": f"0,{-depth},free"}
    none = {"boundary_top_displacement": "free,free,free"}
    if kind == "point":
        return none | {"boundary_needle_point_displacement": f"free,{-depth},free"}
    return none | {"boundary_top_traction": f"0,{-strain * YOUNG},0"}


def updates(folder, changes):
    with run(SCENE, folder / "run", changes) as r:
        cavity = r["history/cavity/hole"]
        return int(cavity["iterations"][-1]), cavity["volume"][-1]


def free_gain(folder):
    """K_p before any tool touches the block (what the paper's steps 1 and 2 say)."""
    with run("block_pv.opts", folder / "run", {}) as r:
        return float(r["pv_curve/slope"][0])


def golden_section(folder, changes, tolerance, span):
    """Evaluations of V until |V/V0 - 1| is within tolerance, on the exact cubic V(p): four runs with
    a given pressure determine it."""
    at = np.linspace(-span, span, 4)
    volumes = []
    for p in at:
        with run(SCENE, folder / "run", changes | {
                "cavity_hole_law": "pressure", "cavity_hole_pressure": p,
                "cavity_hole_solver": "exact"}) as r:
            volumes.append(r["history/cavity/hole/volume"][-1])
    cubic = np.polynomial.Polynomial.fit(at, np.array(volumes) / 4.8e-6, 3)
    low, high, ratio, count = -span, span, (np.sqrt(5) - 1) / 2, 0
    while count < 200:
        left, right = high - ratio * (high - low), low + ratio * (high - low)
        count += 1
        errors = abs(cubic(left) - 1), abs(cubic(right) - 1)
        if min(errors) <= tolerance:
            return count
        low, high = (low, right) if errors[0] < errors[1] else (left, high)
    return count


def cold(folder, strains):
    gain = free_gain(folder)
    rows = []
    for kind in ("point", "traction", "plate"):
        for strain in strains:
            changes = load(kind, strain)
            row = {"load": kind, "strain_%": 100 * strain}
            for source, value in (("own", 0), ("free", gain)):
                for tolerance in TOLERANCES:
                    try:
                        row[f"{source}_{tolerance:g}"] = updates(folder, changes | {
                            "cavity_hole_gain": value, "cavity_hole_tolerance": tolerance})[0]
                    except Exception:  # not converged: exit 70
                        row[f"{source}_{tolerance:g}"] = "-"
            for solver in ("newton", "exact"):
                row[solver] = updates(folder, changes | {"cavity_hole_solver": solver,
                                                         "cavity_hole_tolerance": 1e-12})[0]
            row["golden_0.001"] = golden_section(folder, changes, 1e-3, 8000)
            rows.append(row)
    return rows


def path(folder):
    """The point pressed 7.5 mm deep and back at 0.1 m/s, one solution every 1/512 s."""
    curve = folder / "path.csv_in"
    curve.write_text("time,factor\n0,0\n0.075,1\n0.15,0\n")
    rows = []
    for name, extra in (
            ("proportional 1 %", {"cavity_hole_tolerance": 1e-2}),
            ("proportional 0.1 %", {"cavity_hole_tolerance": 1e-3}),
            ("proportional 1e-12", {"cavity_hole_tolerance": 1e-12}),
            ("newton", {"cavity_hole_solver": "newton", "cavity_hole_tolerance": 1e-12}),
            ("exact", {"cavity_hole_solver": "exact", "cavity_hole_tolerance": 1e-12}),
            ("linear", {"cavity_hole_solver": "newton", "cavity_hole_model": "linear"}),
            ("follower", {"cavity_hole_solver": "newton", "cavity_hole_model": "follower",
                          "cavity_hole_tolerance": 1e-12})):
        changes = load("point", 0.15) | {"boundary_needle_point_curve": curve, "time_step": 1 / 512,
                                         "time_end": 0.15, "output_fields": "\"\""}
        with run(SCENE, folder / "run", changes | extra) as r:
            cavity = r["history/cavity/hole"]
            rows.append({"solver": name, "steps": len(r["history/time"]) - 1,
                         "worst_volume_error": f"{cavity['volume_error'][1:].max():.1e}",
                         "most_updates": int(cavity["iterations"][1:].max()),
                         "median_ms": f"{1e3 * np.median(r['history/step_seconds'][1:]):.3f}"})
    return rows


def main():
    quick, folder = begin("kp_convergence_study", "one strain")
    strains = [0.03] if quick else [0.003, 0.01, 0.03, 0.06, 0.1, 0.15]
    rows = cold(folder, strains)
    write_table(folder / "updates.csv", rows)
    write_table(folder / "path.csv", path(folder))
    figure, axes = plt.subplots(1, 3, figsize=(12.5, 3.8), constrained_layout=True, sharey=True)
    for axis, kind in zip(axes, ("point", "traction", "plate")):
        mine = [row for row in rows if row["load"] == kind]
        x = [row["strain_%"] for row in mine]
        for source, style in (("own", "o-"), ("free", "s--")):
            for k, tolerance in enumerate(TOLERANCES):
                y = [row[f"{source}_{tolerance:g}"] for row in mine]
                axis.plot(x, [np.nan if v == "-" else v for v in y], style, ms=4, color=f"C{k}",
                          label=f"K_p {source}, to {tolerance:g}")
        axis.plot(x, [row["newton"] for row in mine], "k:", label="newton, to 1e-12")
        axis.plot(x, [row["exact"] for row in mine], "k-", lw=2, label="exact, to 1e-12")
        axis.set(xscale="log", yscale="symlog", xlabel="strain [%]", title=kind)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("pressure updates")
    axes[2].legend(frameon=False, fontsize=7, loc="center left", bbox_to_anchor=(1.02, 0.5))
    save(figure, folder / "kp_convergence.png")
    print(f"wrote {folder}/updates.csv, path.csv and kp_convergence.png")


main()
