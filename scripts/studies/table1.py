"""Table 1 of the needle paper: displacement of the nodes around a rigid needle in a soft beam,
against the spacing of the coupling points and for crossings.

The paper gives the beam (15 x 2 x 2 cm, 50 x 6 x 6 nodes, 500 Pa), gravity and the row counts. It
does not give Poisson's ratio, density, supports or the line of the needle; they are varied here.
Writes results/table1/{table1.csv,table1.png}.
"""
import argparse

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import ROOT, run, save, write_table

PAPER = {1.0: (32, 0.04167), 0.5: (62, 0.02557), 0.2: (152, 0.01991), 0.1: (302, 0.01815),
         0.07: (430, 0.01815), 0.04: (752, 0.01814), "crossings": (206, 0.0175)}
SUPPORTS = {"both ends": "x0,x1", "one end": "x0", "bottom": "z0"}


def nodes_around(run_file, points):
    """Nodes of the tets the needle's line y, z crosses: those whose tet holds a part of it."""
    x, tets = run_file["mesh/coordinates"][:], run_file["mesh/tets"][:]
    y, z = points
    samples = np.linspace(0, 0.15, 6001)
    near = tets[(x[tets][:, :, 1].min(1) <= y) & (x[tets][:, :, 1].max(1) >= y)
                & (x[tets][:, :, 2].min(1) <= z) & (x[tets][:, :, 2].max(1) >= z)]
    crossed = []
    for tet in near:
        inside = samples[(samples >= x[tet][:, 0].min()) & (samples <= x[tet][:, 0].max())]
        p = np.column_stack([inside, np.full_like(inside, y), np.full_like(inside, z)])
        b = np.linalg.solve((x[tet[1:]] - x[tet[0]]).T, (p - x[tet[0]]).T)
        if len(p) and (np.minimum(b.min(0), 1 - b.sum(0)) > 1e-9).any():
            crossed.append(tet)
    return np.unique(np.array(crossed))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="two spacings, one support")
    args = parser.parse_args()
    folder = ROOT / "results/table1"
    folder.mkdir(parents=True, exist_ok=True)
    line = (0.0093, 0.0107)
    spacings = [1.0, 0.2] if args.quick else [k for k in PAPER if k != "crossings"]
    supports = {"both ends": "x0,x1"} if args.quick else SUPPORTS
    rows = []
    for support, fix in supports.items():
        cases = [(f"{d} cm", {"insertion_placement": "spacing", "insertion_spacing": d / 100}, d)
                 for d in spacings]
        cases += [("crossings, raw", {"insertion_merge": 0}, "crossings"),
                  ("crossings, merged", {}, None)]
        for label, changes, key in cases:
            # Dense rows of a straight path are exactly redundant; the solver leaves them out.
            with run("paper_beam.opts", folder / "run", {"fix": fix, **changes}) as r:
                around = nodes_around(r, line)
                with h5py.File(folder / "run/fields/step_000000.h5") as step:
                    u = np.linalg.norm(step["displacement"][:][around], axis=1)
                history = r["history/constraint"]
                rows.append({
                    "supports": support, "placement": label, "rows": int(history["rows"][0]),
                    "rank": int(history["rank"][0]),
                    "max_displacement_cm": f"{100 * u.max():.6g}",
                    "mean_displacement_cm": f"{100 * u.mean():.6g}",
                    "residual_m": f"{history['residual'][0]:.2e}",
                    "paper_rows": PAPER[key][0] if key else "",
                    "paper_displacement_cm": PAPER[key][1] if key else ""})
    write_table(folder / "table1.csv", rows)

    figure, ax = plt.subplots(figsize=(7, 4.2), constrained_layout=True)
    if not args.quick:
        d = [k for k in PAPER if k != "crossings"]
        ax.loglog(d, [PAPER[k][1] for k in d], "ks--", label="paper")
        ax.axhline(PAPER["crossings"][1], color="k", ls=":", label="paper, crossings")
    for i, support in enumerate(supports):
        mine = [r for r in rows if r["supports"] == support]
        ax.loglog(spacings, [float(r["max_displacement_cm"]) for r in mine[:len(spacings)]], "o-",
                  color=f"C{i}", label=support)
        ax.axhline(float(mine[-2]["max_displacement_cm"]), color=f"C{i}", ls=":")
    ax.set(xlabel="distance between points [cm]", ylabel="largest displacement around the needle [cm]",
           title="Table 1: dotted lines are crossings")
    ax.grid(alpha=0.3, which="both")
    ax.legend(frameon=False, fontsize=8)
    save(figure, folder / "table1.png")
    print(f"wrote {folder}/table1.csv and table1.png")


main()
