"""NAFEMS LE10: stress at point D of the thick elliptic plate, three kinds of tets, three meshes.

Linear tets use the corners of the same meshes. Writes results/le10/{le10.csv,le10.png}.
"""
import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import begin, mesh, run, write_table

D, TARGET = np.array([2.0, 0.0, 0.3]), -5.38


def stress_at_d(x, folder):
    """sigma_yy [MPa] as recovered at the node at D."""
    node = np.argmin(np.linalg.norm(x - D, axis=1))
    assert np.linalg.norm(x[node] - D) < 1e-9, "no node at D"
    with h5py.File(sorted((folder / "fields").glob("step_*.h5"))[-1]) as step:
        return 1e-6 * step["nodal_stress"][node, 1]


def main():
    quick, folder = begin("le10", "the coarsest mesh")
    rows = []
    for h in [0.4] if quick else [0.4, 0.25, 0.16]:
        path = mesh("le10", f"le10_{h:g}", h=h)
        for element in ("p1", "p1_anp", "p2"):
            changes = {"mesh": path, "tissue_element": element, "output_fields": "nodal_stress"}
            with run("le10.opts", folder / "run", changes) as r:
                x, tets = r["mesh/coordinates"][:], r["mesh/tets"][:]
            stress = stress_at_d(x, folder / "run")
            rows.append({"h_m": h, "tets": len(tets), "element": element, "nodes": len(x),
                         "stress_D_MPa": f"{stress:.4f}", "of_target": f"{stress / TARGET:.4f}"})
    write_table(folder / "le10.csv", rows)
    figure, axis = plt.subplots(figsize=(5.5, 4.2), constrained_layout=True)
    for element in ("p1", "p1_anp", "p2"):
        mine = [row for row in rows if row["element"] == element]
        axis.semilogx([row["nodes"] for row in mine], [float(row["stress_D_MPa"]) for row in mine],
                      "o-", label=element)
    axis.axhline(TARGET, color="k", lw=0.8, label="NAFEMS")
    axis.set(xlabel="nodes", ylabel="stress yy at D [MPa]", title="Thick elliptic plate, LE10")
    axis.legend(frameon=False)
    figure.savefig(folder / "le10.png", dpi=130)
    print(f"wrote {folder}/le10.csv and le10.png")


main()
