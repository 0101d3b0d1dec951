"""Figure 4 of the needle paper: building W with and without reuse of isolated columns.

The curved insertion of steering.opts; per step the numbers of new and reused isolated dofs and the
time to build W, standard (all columns in every step) against reuse, with averages over 50 steps.
Writes results/figure4/{figure4.csv,figure4.png}.
"""
import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import ROOT, run, write_table

WAYS = {"reuse": {"compliance_reuse": "exact", "compliance_tube": 0},
        "standard": {"compliance_reuse": "none", "compliance_tube": 0},
        "reuse, corridor last": {"compliance_reuse": "exact", "compliance_tube": 1}}


def smooth(values, width=50):
    """Averages over `width` steps."""
    return np.convolve(values, np.ones(width) / width, mode="valid")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="a fifth of the insertion")
    args = parser.parse_args()
    folder = ROOT / "results/figure4"
    folder.mkdir(parents=True, exist_ok=True)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)
    rows = []
    for way, changes in WAYS.items():
        with run("steering.opts", folder / "run", {
                "time_step": 0.02, "time_end": 2.0 if args.quick else 10.0, "analysis": "dynamic",
                "tissue_rayleigh_stiffness": 0.02, "output_every": 100000, **changes}) as r:
            history = {name: r["history/compliance"][name][:] for name in r["history/compliance"]}
        new, reused = history["new_probes"], history["reused_probes"]
        later = slice(len(new) // 10, None)  # after the first steps
        rows.append({"way": way, "steps": len(new) - 1, "new": int(new.sum()),
                     "reused": int(reused.sum()),
                     "reused_part_later": f"{reused[later].sum() / max((new + reused)[later].sum(), 1):.4f}",
                     "most_new_in_a_step": int(new.max()),
                     "mean_build_ms": f"{1e3 * history['build_seconds'].mean():.4f}"})
        axes[1].semilogy(smooth(1e3 * history["build_seconds"]), label=way)
        if way == "reuse":
            axes[0].plot(smooth(new + reused), label="isolated dofs")
            axes[0].plot(smooth(reused), label="reused")
            axes[0].plot(new, lw=0.6, label="new in the step")
    axes[0].set(xlabel="step", ylabel="dofs (means over 50 steps)", title="Isolated dofs")
    axes[1].set(xlabel="step", ylabel="ms per step (means over 50 steps)", title="Time to build W")
    for axis in axes:
        axis.grid(alpha=0.3)
        axis.legend(frameon=False, fontsize=8)
    write_table(folder / "figure4.csv", rows)
    figure.savefig(folder / "figure4.png", dpi=130)
    print(f"wrote {folder}/figure4.csv and figure4.png")


main()
