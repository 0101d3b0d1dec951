"""What updating the constraint directions within a step buys for a bent needle.

Scene sideways.opts at several steps with frozen directions (the papers), one and four updates, and
fully iterated steps; errors at the end against an iterated run with a small step.
Writes results/directions/{directions.csv,directions.png}.
"""
import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import ROOT, run, save, write_table

WAYS = {"frozen": {"constraint_direction_max": 1}, "one update": {"constraint_direction_max": 2},
        "four updates": {"constraint_direction_max": 5},
        "iterated": {"constraint_direction_max": 1, "time_newton_max": 20}}


def end_of(folder, h, way):
    """Place of the tip, force and moment of the base at the end; half-sweeps and seconds."""
    with run("sideways.opts", folder / "run",
             {"time_step": h, "output_every": 100000, **WAYS[way]}) as r:
        needle = r["history/needle/needle"]
        return (needle["tip"][-1], needle["base_force"][-1], needle["base_moment"][-1],
                int(r["ledger"].attrs["half_sweeps"]), r["history/step_seconds"][:].sum())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="two steps, a coarser reference")
    args = parser.parse_args()
    folder = ROOT / "results/directions"
    folder.mkdir(parents=True, exist_ok=True)
    steps = [0.2, 0.1] if args.quick else [0.2, 0.1, 0.05, 0.025]
    tip, force, moment, _, _ = end_of(folder, 0.01 if args.quick else 0.00125, "iterated")
    rows = []
    for h in steps:
        for way in WAYS:
            x, f, m, half_sweeps, seconds = end_of(folder, h, way)
            rows.append({"step_s": h, "directions": way,
                         "tip_error_m": f"{np.linalg.norm(x - tip):.2e}",
                         "force_error": f"{np.linalg.norm(f - force) / np.linalg.norm(force):.2e}",
                         "moment_error": f"{np.linalg.norm(m - moment) / np.linalg.norm(moment):.2e}",
                         "half_sweeps": half_sweeps, "seconds": f"{seconds:.3f}"})
    write_table(folder / "directions.csv", rows)
    figure, axis = plt.subplots(figsize=(6, 4.2), constrained_layout=True)
    for way in WAYS:
        mine = [row for row in rows if row["directions"] == way]
        axis.loglog([row["half_sweeps"] for row in mine], [float(row["force_error"]) for row in mine],
                    "o-", label=way)
    axis.set(xlabel="half-sweeps of the tissue", ylabel="error of the base force",
             title="Sideways needle: directions within the step")
    axis.grid(alpha=0.3, which="both")
    axis.legend(frameon=False)
    save(figure, folder / "directions.png")
    print(f"wrote {folder}/directions.csv and directions.png")


main()
