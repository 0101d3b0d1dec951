"""The fluid paper's phantom: contours, surface markers, plate force, pressure and dP/dV.

Three meshes of linear tets and the paper's mesh recipe, slipping and bonded plates, three models.
Linear tets at nu = 0.485 are not converged in pressure and dP/dV: the table says so itself.
The same mesh with every element beside that (slipping plates, follower).
Writes results/phantom_study/{phantom.csv,elements.csv,contours.png,markers.png,elements.png}.
"""

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import begin, mesh, run, write_table

CENTRE = np.array([0.03, 0.025, 0.025])
PLATES = {"slip": {}, "bonded": {"fix": "probe,bottom:y", "boundary_stage_displacement": "-0.009,0,0"}}


def wall_nodes(x, tets):
    """Nodes of boundary faces well inside the block."""
    faces = np.sort(np.concatenate([tets[:, [1, 2, 3]], tets[:, [0, 2, 3]], tets[:, [0, 1, 3]], tets[:, [0, 1, 2]]]), 1)
    unique, count = np.unique(faces, axis=0, return_counts=True)
    nodes = np.unique(unique[count == 1])
    return nodes[(np.abs(x[nodes] - CENTRE) < 0.0185).all(1)]


def field(folder, step):
    with h5py.File(folder / f"fields/step_{step:06d}.h5") as f:
        return f["displacement"][:]


def contour(x, nodes, middle):
    """Nodes near the plane y = middle, by angle: the image plane of the paper."""
    near = nodes[np.abs(x[nodes, 1] - middle) < 0.0035]
    return near[np.argsort(np.arctan2(x[near, 2] - CENTRE[2], x[near, 0] - CENTRE[0]))]


def draw(folder, run_folder):
    with h5py.File(run_folder / "run.h5") as r:
        x, tets = r["mesh/coordinates"][:], r["mesh/tets"][:, :4]
    wall = wall_nodes(x, tets)
    ring = contour(x, wall, CENTRE[1])
    figure, axes = plt.subplots(1, 4, figsize=(11, 3.8), constrained_layout=True, sharey=True)
    for step, axis in enumerate(axes):
        y = x + field(run_folder, step)
        loop = np.append(ring, ring[0])
        axis.plot(1e3 * x[loop, 2], 1e3 * x[loop, 0], color="#6b6b6b", lw=0.8, label="undeformed")
        axis.plot(1e3 * y[loop, 2], 1e3 * y[loop, 0], "o-", color="#1f5f8b", ms=3, label="deformed")
        axis.axhline(0, color="k", lw=2)
        axis.axhline(60 - 3 * step, color="#d9772b", lw=2)
        axis.set(title=f"{3 * step} mm", xlabel="z [mm]", xlim=(0, 50), ylim=(62, -2))
        axis.set_aspect("equal")
    axes[0].set_ylabel("x [mm], probe above, stage below")
    axes[0].legend(frameon=False, fontsize=8, loc="lower center")
    figure.savefig(folder / "contours.png", dpi=130)
    top = np.flatnonzero(np.abs(x[:, 1] - 0.05) < 1e-9)
    figure, axes = plt.subplots(1, 2, figsize=(9, 4), constrained_layout=True)
    for step, colour in ((1, "C0"), (2, "C1"), (3, "C2")):
        u = field(run_folder, step)
        axes[0].plot(1e3 * x[top, 0], -1e3 * u[top, 0], ".", ms=4, color=colour, label=f"{3 * step} mm")
        y = 1e3 * (x[top] + u[top])
        axes[1].plot(y[:, 0], y[:, 2], "o", ms=3, mfc="none", color=colour)
    axes[1].plot(1e3 * x[top, 0], 1e3 * x[top, 2], "k.", ms=2)
    axes[0].set(xlabel="x of the marker [mm]", ylabel="displacement to the probe [mm]", title="Markers on the top surface")
    axes[0].legend(frameon=False)
    axes[1].set(xlabel="x [mm]", ylabel="z [mm]", title="Their places (dots: before)", xlim=(-3, 63), ylim=(-8, 58),
                aspect="equal")
    figure.savefig(folder / "markers.png", dpi=130)
    plt.close("all")


def contour_point(run_folder):
    """Displacement at 9 mm of the contour's point 45 degrees from the probe side [mm]."""
    with h5py.File(run_folder / "run.h5") as r:
        x, tets = r["mesh/coordinates"][:], r["mesh/tets"][:, :4]
    wall = wall_nodes(x, tets)
    target = CENTRE + 0.01 / np.sqrt(2) * np.array([-1, 0, -1])
    node = wall[np.argmin(np.linalg.norm(x[wall] - target, axis=1))]
    u = field(run_folder, 3)
    return 1e3 * np.linalg.norm(u[node]), 1e3 * np.linalg.norm(u[wall], axis=1).max()


def slope_of(folder, path, plates, changes):
    """dP/d(V/V0) [Pa] about the undeformed phantom."""
    held = "0,0,0" if plates == "bonded" else "0,free,free"
    with run("phantom.opts", folder / "pv", PLATES[plates] | changes | {
            "mesh": path, "analysis": "pv_curve", "pv_low": 0.97, "pv_high": 1.03, "pv_points": 5,
            "output_fields": "\"\"", "boundary_stage_displacement": held}) as r:
        return r["pv_curve/slope"][0]


def compare_elements(folder, path):
    """Contour, force, pressure and P-V stiffness of every element on one mesh."""
    rows = []
    figure, axis = plt.subplots(figsize=(4.6, 4.4), constrained_layout=True)
    for element in ("p1", "p1_anp", "p2", "p2_bbar", "p2_anp"):
        changes, at = {"tissue_element": element}, folder / f"element_{element}"
        slope = slope_of(folder, path, "slip", changes)
        with run("phantom.opts", at, changes | {"mesh": path}) as r:
            p, force = r["history/cavity/pocket/pressure"][:], r["history/boundary/stage/force"][-1, 0]
            x, tets = r["mesh/coordinates"][:], r["mesh/tets"][:, :4]
        y = x + field(at, 3)
        ring = contour(x, wall_nodes(x, tets), CENTRE[1])
        axis.plot(1e3 * y[np.append(ring, ring[0]), 2], 1e3 * y[np.append(ring, ring[0]), 0], lw=1.2, label=element)
        rows.append({"element": element, "nodes": len(x), "p3_Pa": f"{p[1]:.0f}", "p6_Pa": f"{p[2]:.0f}",
                     "p9_Pa": f"{p[3]:.0f}", "F9_N": f"{-force:.3f}", "point_mm": f"{contour_point(at)[0]:.2f}",
                     "dP/d(V/V0)_kPa": f"{1e-3 * slope:.2f}"})
    axis.set(xlabel="z [mm]", ylabel="x [mm]", title="Contour at 9 mm", aspect="equal")
    axis.invert_yaxis()
    axis.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "elements.png", dpi=130)
    plt.close(figure)
    write_table(folder / "elements.csv", rows)


def main():
    quick, folder = begin("phantom_study", "the coarsest mesh and the recipe")
    meshes = {"recipe": "build/meshes/phantom_recipe.msh", "h": "build/meshes/phantom.msh"}
    if not quick:
        meshes["h/1.5"] = mesh("phantom", "phantom_2", h=0.0052 / 1.5, hw=0.0048 / 1.5)
        meshes["h/2.2"] = mesh("phantom", "phantom_3", h=0.0052 / 2.2, hw=0.0048 / 2.2)
    rows = []
    for name, path in meshes.items():
        for plates, changes in PLATES.items():
            slope = slope_of(folder, path, plates, {})
            for model in ("linear", "frozen", "follower"):
                at = folder / f"{name.replace('/', '_')}_{plates}_{model}"
                with run("phantom.opts", at, changes | {"mesh": path, "cavity_model": model}) as r:
                    cavity, force = r["history/cavity/pocket"], r["history/boundary/stage/force"][:, 0]
                    point, most = contour_point(at)
                    rows.append({"mesh": name, "nodes": len(r["mesh/coordinates"]), "plates": plates, "model": model,
                                 **{f"p{mm}_Pa": f"{cavity['pressure'][k]:.0f}" for k, mm in ((1, 3), (2, 6), (3, 9))},
                                 **{f"F{mm}_N": f"{-force[k]:.3f}" for k, mm in ((1, 3), (2, 6), (3, 9))},
                                 "V9_error": f"{cavity['volume_error'][3]:.1e}",
                                 "point_mm": f"{point:.2f}", "most_mm": f"{most:.2f}",
                                 "dP/d(V/V0)_kPa": f"{1e-3 * slope:.1f}"})
    write_table(folder / "phantom.csv", rows)
    draw(folder, folder / "h_slip_follower")
    if not quick:  # the quadratic tets take their time
        compare_elements(folder, meshes["h"])
    print(f"wrote {folder}/phantom.csv, contours.png and markers.png")


main()
