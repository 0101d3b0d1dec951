"""P-V curves of a cavity in a 5 x 5 x 1.2 cm block: figure 4 of the fluid paper, whose cavity and
supports are not said, for four declared choices and two models.

Writes results/block_pv_study/{block_pv.csv,block_pv.png,shapes.png}.
"""

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

from common import begin, mesh, run, write_table

CASES = {
    "plane, 2 cm hole, bottom held": ("pv_slab", 0.02, "bottom,faces:z"),
    "plane, 2.3 cm hole, all sides held": ("pv_slab", 0.023, "bottom,top,left,right,faces:z"),
    "3D, 2 x 2 x 0.6 cm, bottom held": ("pv_block", 0.02, "bottom"),
    "3D, 2 x 2 x 0.6 cm, all sides held": ("pv_block", 0.02, "bottom,top,left,right"),
}


def draw_shape(axis, folder, which, title):
    """The front face (z = 0) at one end of the curve, deformed."""
    with h5py.File(folder / "run.h5") as r:
        x, tets, ratio = r["mesh/coordinates"][:], r["mesh/tets"][:], r["pv_curve/volume_ratio"][:]
    below = int((ratio <= 1.0).sum())  # records: downwards first, then upwards
    step = below if which == 0 else len(ratio)
    with h5py.File(folder / f"fields/step_{step:06d}.h5") as field:
        y = x + field["displacement"][:]
    front = x[:, 2] < 1e-9
    lines = {tuple(sorted(pair)) for t in tets for pair in zip(t[[0, 0, 0, 1, 1, 2]], t[[1, 2, 3, 2, 3, 3]])
             if front[pair[0]] and front[pair[1]]}
    axis.add_collection(LineCollection([1e2 * y[list(pair), :2] for pair in lines], lw=0.5, color="#1f5f8b"))
    axis.autoscale_view()
    axis.set_aspect("equal")
    axis.set(title=title, xlabel="x [cm]", ylabel="y [cm]")


def main():
    quick, folder = begin("block_pv_study", "plane cases only")
    rows = []
    figure, axis = plt.subplots(figsize=(6, 4.4), constrained_layout=True)
    for k, (name, (geometry, side, fix)) in enumerate(CASES.items()):
        if quick and geometry != "pv_slab":
            continue
        path = mesh(geometry, f"pv_{k}", side=side)
        changes = {"mesh": path, "fix": fix}
        for model in ("frozen", "follower"):
            if geometry == "pv_block":
                changes["cavity_hole_cap"] = "false"
            with run("block_pv.opts", folder / f"{k}_{model}", changes | {"cavity_hole_model": model}) as r:
                curve = r["pv_curve"]
                ratio, p = curve["volume_ratio"][:], curve["pressure"][:]
                rows.append({"case": name, "model": model, "p70_Pa": f"{p[0]:.0f}", "p130_Pa": f"{p[-1]:.0f}",
                             "Kp_Pa": f"{curve['slope'][0]:.0f}", "R2": f"{curve['r_squared'][0]:.5f}"})
                axis.plot(ratio, 1e-3 * p, "-" if model == "frozen" else "--", color=f"C{k}",
                          label=name if model == "frozen" else None)
    write_table(folder / "block_pv.csv", rows)
    axis.axhline(8, color="#6b6b6b", lw=0.8, ls=":")
    axis.axhline(-8, color="#6b6b6b", lw=0.8, ls=":", label="paper's axis (read off)")
    axis.set(xlabel="volume ratio V/V₀", ylabel="pressure [kPa]",
             title="Figure 4 of the fluid paper (full: frozen, dashed: follower)")
    axis.grid(alpha=0.3)
    axis.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "block_pv.png", dpi=130)
    shapes, axes = plt.subplots(2, 2, figsize=(8, 8), constrained_layout=True)
    for k in (0, 1):
        for end, part in enumerate((70, 130)):
            draw_shape(axes[k, end], folder / f"{k}_frozen", end, f"{list(CASES)[k]}: {part} %")
    shapes.savefig(folder / "shapes.png", dpi=130)
    print(f"wrote {folder}/block_pv.csv, block_pv.png and shapes.png")


main()
