"""One insertion and what became of it: branch.opts, and the three that go on from its checkpoint.

Draws the axial base force and the way of the tip across the needle against time.
Writes results/branches/{branches.csv,branches.png}.
"""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import begin, run, save, write_table

BRANCHES = {"faster": "on at 3 cm/s, then at rest", "withdrawn": "back at 2 cm/s",
            "turned": "half a turn, then on at 1 cm/s"}


def history(file, folder, options):
    """Times, axial base force and sideways place of the tip."""
    with run(file, folder, options) as results:
        needle = results["history/needle/needle"]
        return results["history/time"][:], needle["base_force"][:, 0], needle["tip"][:, 2]


def main():
    _, folder = begin("branches", "the same: it takes seconds")
    saved = folder / "saved"
    lines = {"saved at 5 s": history("branch.opts", saved, {})}
    start = lines["saved at 5 s"]
    for name, what in BRANCHES.items():
        found = history(f"branch_{name}.opts", folder / name, {"restart_from": saved})
        lines[what] = tuple(np.insert(values, 0, first[-1]) for values, first in zip(found, start))
    write_table(folder / "branches.csv",
                [{"branch": what, "end_s": f"{t[-1]:g}", "force_N": f"{force[-1]:.4f}",
                  "tip_mm": f"{1e3 * (tip[-1] - start[2][0]):.2f}"} for what, (t, force, tip) in lines.items()])
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 3.8), constrained_layout=True)
    for what, (t, force, tip) in lines.items():
        style = {"color": "0.3", "lw": 2} if what.startswith("saved") else {}
        axes[0].plot(t, force, label=what, **style)
        axes[1].plot(t, 1e3 * (tip - start[2][0]), **style)
    for axis in axes:
        axis.axvline(5.0, color="0.7", lw=0.8, zorder=0)
        axis.set_xlabel("time [s]")
        axis.grid(alpha=0.3)
    axes[0].set(ylabel="axial force on the base [N]", title="One insertion, three continuations")
    axes[1].set(ylabel="tip across the needle [mm]", title="The bevel's tip goes aside")
    axes[0].legend(frameon=False, fontsize=9)
    save(figure, folder / "branches.png")
    print(f"wrote {folder}/branches.csv and branches.png")


main()
