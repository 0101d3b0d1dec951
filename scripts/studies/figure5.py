"""Figure 5 of the needle paper: friction force over 44 mm at 2.1, 3 and 4 mm/s.

The viscous law (a material parameter b per length) and the papers' eta law, on three meshes and
with half the step. Writes results/figure5/{viscous.csv,eta.csv,figure5.png}.
"""
import argparse
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import ROOT, run, write_table

PAPER = {2.1: 0.60, 3.0: 0.85, 4.0: 1.15}  # [N] at 44 mm, read off the figure by others
DEPTH = 0.044
ETA = 0.05


def mesh(folder, factor):
    """The gel block with its edges times `factor`, meshed anew."""
    path = folder / f"gel_{factor}.msh"
    if not path.exists():
        subprocess.run(["gmsh", "-3", "meshes/gel.geo", "-setnumber",
                        "h", str(0.0092 * factor), "-o", str(path)],
                       cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return path


def insertion(folder, velocity, h, changes):
    """Depth, force and number of points of one insertion with steps of h [s]; tets of the mesh."""
    v = 1e-3 * velocity
    h = DEPTH / v / round(DEPTH / v / h)  # no shorter last step: the eta law would show it
    with run("force_profile.opts", folder / "run",
             {"needle_velocity": v, "time_step": h, "time_end": DEPTH / v, **changes}) as r:
        needle = r["history/needle/needle"]
        return (needle["depth"][:], needle["shaft_friction"][:], needle["points"][:],
                r["mesh/tets"].shape[0])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="one mesh, coarse steps")
    args = parser.parse_args()
    folder = ROOT / "results/figure5"
    folder.mkdir(parents=True, exist_ok=True)
    factors = [1.0] if args.quick else [1.0, 0.75, 0.55]
    advance = 4e-4 if args.quick else 1e-4
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)

    rows = []
    for velocity in PAPER:
        for factor in factors:
            for step in (advance,) if factor != 1.0 else (advance, advance / 2):
                depth, force, points, tets = insertion(
                    folder, velocity, step / (1e-3 * velocity), {"mesh": mesh(folder, factor)})
                jump = abs(np.diff(force)).max() / force[-1]
                rows.append({"velocity_mm_s": velocity, "tets": tets, "travel_per_step_mm": 1e3 * step,
                             "depth_mm": f"{1e3 * depth[-1]:.4f}", "force_N": f"{force[-1]:.6f}",
                             "force_over_velocity": f"{force[-1] / velocity:.6f}",
                             "largest_jump": f"{jump:.5f}", "paper_N": PAPER[velocity]})
                if factor == 1.0 and step == advance:
                    axes[0].plot(1e3 * depth, force, label=f"{velocity} mm/s")
                    if velocity == 3.0:
                        for k in np.flatnonzero(np.diff(points)) + 1:
                            axes[0].axvline(1e3 * depth[k], color="k", ls=":", lw=0.5)
        axes[0].plot(1e3 * DEPTH, PAPER[velocity], "k_", ms=12)
    write_table(folder / "viscous.csv", rows)

    eta_rows = []
    longest = advance / 4e-3  # the fastest needle then travels `advance` per step
    for factor in factors:
        for h in (longest, longest / 2):
            for velocity in (2.1,) if (factor, h) != (1.0, longest) else PAPER:
                depth, force, _, tets = insertion(
                    folder, velocity, h, {"mesh": mesh(folder, factor), "insertion_eta": ETA,
                                          "insertion_friction_viscous": 0})
                eta_rows.append({"velocity_mm_s": velocity, "tets": tets, "step_s": h,
                                 "force_N": f"{force[-1]:.6f}"})
                if factor == 1.0 and h == longest:
                    axes[1].plot(1e3 * depth, force, label=f"{velocity} mm/s")
    write_table(folder / "eta.csv", eta_rows)
    axes[0].set_title("viscous law, b = 6500 N s/m² (dotted: points born; marks: paper)")
    axes[1].set_title(f"eta law, eta = {ETA}")
    for ax in axes:
        ax.set(xlabel="depth [mm]", ylabel="shaft friction [N]")
        ax.grid(alpha=0.3)
        ax.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "figure5.png", dpi=130)
    print(f"wrote {folder}/viscous.csv, eta.csv and figure5.png")


main()
