"""Parts of work_precision without a mesh to refine: time steps, and constraint solvers."""
import numpy as np

from common import mesh, run
from precision_scenes import TARGET, YOUNG, at_place, command_line

STEPS = {  # time steps [s] by scene, the last one the reference's
    "swing": [0.05, 0.025, 0.0125, 0.00625, 0.003125, 0.0015625, 0.0003125],
    "insertion_dt": [0.2, 0.1, 0.05, 0.025, 0.0125, 0.00625, 0.0015625]}
SCHEMES = ("backward_euler", "bdf2")
TOLERANCES = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10]  # [m]
SOLVERS = ("pgs", "hybrid", "active_set", "interior_point", "auto")


def swing(folder):
    """A gel block held at one end; the other is pulled aside and let go within half a second."""
    t = np.linspace(0, 2, 4001)
    factor = np.where(t < 0.5, np.sin(2 * np.pi * t) ** 4, 0.0)
    np.savetxt(folder / "pull.csv", np.column_stack([t, factor]), fmt="%.12g", delimiter=",",
               header="time,factor", comments="")
    return {"mesh": mesh("gel", "wp_swing", h=0.016), "tissue_element": "p2", "fix": "entry",
            "boundary_exit_traction": "0,0,20", "boundary_exit_curve": folder / "pull.csv",
            "tissue_model": "linear", "tissue_young": YOUNG, "tissue_poisson": 0.45,
            "tissue_density": 1000, "tissue_rayleigh_stiffness": 0.005,
            "time_end": 0.6}, at_place([0.15, 0.025, 0.025])


def insertion_dt(folder):
    """The gel insertion's block and needle, with inertia and friction that slides."""
    return {"options_file": "options/gel_insertion.opts", "tissue_element": "p2",
            "mesh": mesh("gel", "wp_swing", h=0.016), "tissue_model": "linear",
            "time_initial": "unstressed", "gravity": "0,0,0", "time_end": 2}, at_place(TARGET)


def time_steps(name, folder, timed, quick):
    """Rows of both schemes over the steps; errors against bdf2 with the shortest step."""
    options, value = {"swing": swing, "insertion_dt": insertion_dt}[name](folder)
    *steps, shortest = STEPS[name]
    words = command_line(options)
    rows = []
    for scheme in SCHEMES:
        for step in steps[:2] if quick else steps:
            found = timed([*words, "-time_step", str(step), "-time_scheme", scheme], value)
            rows.append({"method": scheme, "step_ms": f"{1e3 * step:g}", **found})
    finest = timed([*words, "-time_step", str(steps[2] if quick else shortest), "-time_scheme",
                    "bdf2"], value, once=True)
    return rows, finest["value"]


def constraint_solvers(folder, quick):
    """Residual and time of all constraint solvers on the same problems: stick-slip, rows every 4 mm."""
    t = np.linspace(0, 1, 201)
    entry, direction = np.array([0, 0.0337, 0.0361]), np.array([1, 0.013, -0.021])
    direction = direction / np.linalg.norm(direction)
    base = entry - 0.005 * direction + np.outer(-0.001 * (1 - np.cos(4 * np.pi * t)), direction)
    base += np.outer(0.0005 * t, [0, 1, 0])
    np.savetxt(folder / "base.csv", np.column_stack([t, base]), fmt="%.12g", delimiter=",",
               header="time,x,y,z", comments="")
    methods = {f"{solver}:residual:{tolerance:g}": (solver, tolerance)
               for solver in SOLVERS for tolerance in (TOLERANCES[:2] if quick else TOLERANCES)}
    with run("close_points.opts", folder / "run", {
            "needle_trajectory": folder / "base.csv", "time_end": 0.1 if quick else 1,
            "constraint_compare": ",".join(methods)}) as r:
        compared = r["history/constraint/compare"]
        rows = []
        for name, (solver, tolerance) in methods.items():
            of = compared[name]
            rows.append({"method": solver, "asked_m": f"{tolerance:g}",
                         "seconds": float(np.median(of["seconds"][1:])
                                          + np.median(of["factor_seconds"][1:])),
                         "iterations": f"{of['iterations'][1:].mean():.1f}",
                         "error": float(np.median(of["residual"][1:])),
                         "worst_m": f"{of['residual'][1:].max():.1e}"})
    return rows
