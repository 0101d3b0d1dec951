"""A needle coupled along its line beside one coupled at points: line_insertion.opts with each.

Draws the change of the force from step to step while the needle goes in, the forces along the shaft at full
depth, and how far a place 12 mm beside the path is off over meshes. There the reference is `line` on a mesh
finer than all others. Writes results/line/{line.csv,line.png}.
"""
import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import begin, last_field, mesh, run, save, write_table

WAYS = {"crossings": {"insertion_placement": "crossings"},
        "crossings, corrected": {"insertion_placement": "crossings", "insertion_radius_correction": "true"},
        "line": {"insertion_placement": "line"}}
COLOURS = {"crossings": "0.6", "crossings, corrected": "tab:orange", "line": "tab:blue"}
PLACE = np.array([0.025, 0.0382, 0.0291])  # beside the path, whose middle is (0.025, 0.0262, 0.0254)
ONCE = {"length": 0.06}


def interpolated(results, u):
    """Displacement at PLACE."""
    x, tets = results["mesh/coordinates"][:], results["mesh/tets"][:]
    corner = x[tets[:, :4]]
    edges = np.moveaxis(corner[:, 1:] - corner[:, :1], 1, 2)
    inner = np.linalg.solve(edges, (PLACE - corner[:, 0])[:, :, None])[:, :, 0]
    at = np.concatenate([1 - inner.sum(1, keepdims=True), inner], 1)
    tet = at.min(1).argmax()
    w = at[tet]
    middles = [4 * w[i] * w[j] for i, j in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]
    return np.concatenate([w * (2 * w - 1), middles]) @ u[tets[tet]]


def target(h, way, folder):
    """Displacement beside the path after 4 cm in static steps, on a block of 6 cm. Its supports slip: the edge of
    a held face would limit the order of every coupling."""
    changes = {"mesh": mesh("gel", f"line_{h:g}", h=h, **ONCE), "analysis": "static", "needle_depth": 0.04,
               "needle_length": 0.08, "time_end": 2, "time_step": 0.05, "output_every": 1000,
               "insertion_friction_viscous": 0, "fix": "exit:x,front:y,bottom:z", **WAYS[way]}
    with run("line_insertion.opts", folder, changes) as results:
        return interpolated(results, last_field(folder)), results["history/time"].shape[0]


def coupling(folder):
    """Place along x and forces per length [N/m] (two across, one along) of every point at full depth."""

    with h5py.File(folder / "fields" / "step_000100.h5") as step:
        points = step["coupling"]
        held = points["tributary"][:]
        order = np.argsort(points["position"][:, 0])
        return points["position"][order, 0], (points["lambda"][:] / held[:, None])[order]


def main():
    quick, folder = begin("line", "two coarse meshes instead of four")
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.9), constrained_layout=True)
    rows = []
    for way, changes in WAYS.items():
        with run("line_insertion.opts", folder / "run", {**changes, "output_every": 100}) as results:
            force = results["history/needle/needle/shaft_friction"][:].ravel()[:100]
        second = 100 * np.abs(np.diff(force, 2)) / force.max()
        travel = 0.5 * np.arange(1, 99)
        axes[0].semilogy(travel[4:], second[4:], color=COLOURS[way], label=way)
        x, density = coupling(folder / "run")
        style = {"color": COLOURS[way], "marker": "o", "ms": 3, "lw": 1}
        axes[1].plot(1e3 * x, density[:, 0], label=way, **style)
        rows.append({"coupling": way, "rows_per_direction": len(x), "largest_jump_%": f"{second[4:].max():.3f}"})
    sizes = (0.0092, 0.0075) if quick else (0.0092, 0.0075, 0.006, 0.005)
    reference = target(0.0055 if quick else 0.0038, "line", folder / "run")[0]
    for way, row in zip(WAYS, rows):
        errors = []
        for h in sizes:
            found = target(h, way, folder / "run")[0]
            errors.append(100 * np.linalg.norm(found - reference) / np.linalg.norm(reference))
            row[f"target_%_{1e3 * h:g}_mm"] = f"{errors[-1]:.3f}"
        axes[2].semilogy(1e3 * np.array(sizes), errors, "o-", color=COLOURS[way], label=way)
    write_table(folder / "line.csv", rows)
    axes[0].set(xlabel="travel [mm]", ylabel="second difference [% of the largest force]",
                title="Force, change from step to step")
    axes[1].set(xlabel="place along the block [mm]", ylabel="force across per length [N/m]",
                title="Along the shaft, at 5 cm")
    axes[2].set(xlabel="edge [mm]", ylabel="error [%]", title="A place 12 mm beside the path")
    for axis in axes:
        axis.grid(alpha=0.3)
    axes[1].legend(frameon=False, fontsize=9, loc="lower right")
    save(figure, folder / "line.png")
    print(f"wrote {folder}/line.csv and line.png")


main()
