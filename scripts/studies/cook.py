"""Cook's membrane at nu = 0.4999: which tets lock, on four meshes.

The vertical displacement of the loaded side's middle (48, 52) mm and upper corner, and the locking
factor: what a locking-free element would give (p2_anp on the finest mesh) over what this one gives.
A last run has the data of a published value: lambda = 20000 mu, u mu / F = 16.432584 * 0.375 mm at
the middle (P. Krysl's FinEALE, Cook_3D_strain, quadratic triangles extrapolated).
Writes results/cook/{cook.csv,cook.png}.
"""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import begin, last_field, mesh, run, write_table

ELEMENTS = ("p1", "p1_anp", "p2", "p2_bbar", "p2_anp")
MU, SHEAR = 80.194, 100.0  # [MPa], and force per thickness [N/mm]
PUBLISHED = 16.432584 * 0.375


def rise(path, folder, **changes):
    """Vertical displacement [mm] of middle and corner of the loaded side, means over z; nodes."""
    with run("cook.opts", folder / "run", {"mesh": path, **changes}) as r:
        x = r["mesh/coordinates"][:]
    u = last_field(folder / "run")
    found = [1e3 * u[np.linalg.norm(x[:, :2] - [0.048, y], axis=1) < 1e-9, 1].mean()
             for y in (0.052, 0.060)]
    return *found, len(x)


def draw(folder, rows, reference):
    figure, axis = plt.subplots(figsize=(5.5, 4.2), constrained_layout=True)
    for element in ELEMENTS:
        mine = [row for row in rows if row["element"] == element]
        axis.semilogx([row["cells"] for row in mine], [float(row["corner_mm"]) for row in mine],
                      "o-", label=element, base=2)
    axis.axhline(reference, color="k", lw=0.8)
    axis.set(xlabel="cells along a side", ylabel="rise of the corner [mm]",
             title="Cook's membrane, ν = 0.4999")
    axis.legend(frameon=False)
    figure.savefig(folder / "cook.png", dpi=130)


def main():
    quick, folder = begin("cook", "two meshes")
    rows = []
    meshes = {n: mesh("cook", f"cook_{n}", n=n) for n in ([4, 8] if quick else [4, 8, 16, 32])}
    for cells, path in meshes.items():
        for element in ELEMENTS:
            middle, corner, nodes = rise(path, folder, tissue_element=element)
            rows.append({"cells": cells, "element": element, "nodes": nodes,
                         "middle_mm": f"{middle:.4f}", "corner_mm": f"{corner:.4f}"})
    reference = float(rows[-1]["corner_mm"])
    for row in rows:
        row["locking"] = f"{reference / float(row['corner_mm']):.3f}"
    write_table(folder / "cook.csv", rows)
    draw(folder, rows, reference)
    cells, path = list(meshes.items())[-1]
    ratio = 20000.0
    poisson = ratio / (2.0 * (ratio + 1.0))
    middle, _, _ = rise(path, folder, tissue_poisson=repr(poisson),
                        tissue_young=repr(2e6 * MU * (1.0 + poisson)))
    off = middle * MU / SHEAR / PUBLISHED - 1.0
    print(f"lambda = 20000 mu, {cells} cells: middle {middle:.4f} mm, {100 * off:+.2f} % off")
    print(f"wrote {folder}/cook.csv and cook.png")


main()
