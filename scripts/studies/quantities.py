"""What the study of convergence reads from a run."""
import h5py
import numpy as np

from remesh import MIDDLES, last_fields, read_mesh


def barycentric(x, tets, place):
    """Coordinates of the place in every tet, by its corners."""
    a = x[tets[:, 0]]
    sides = np.stack([x[tets[:, k]] - a for k in (1, 2, 3)], axis=2)
    rest = np.linalg.solve(sides, (np.asarray(place) - a)[:, :, None])[:, :, 0]
    return np.column_stack([1.0 - rest.sum(1), rest])


def interpolate(x, tets, u, place):
    """The field at a place; at a curved wall the nearest tet may be left by a tenth of its size."""
    at = barycentric(x, tets, place)
    inside = at.min(1)
    tet = int(np.argmax(inside))
    if inside[tet] < -0.1:
        return np.full(3, np.nan)
    b, nodes = at[tet], tets[tet]
    if len(nodes) == 4:
        return b @ u[nodes]
    shape = np.concatenate([b * (2 * b - 1), [4 * b[i] * b[j] for i, j in MIDDLES]])
    return shape @ u[nodes]


def default_probe(x, tets, volume):
    """The centroid, or where that is no tissue the middle of the tet nearest to it."""
    middles = x[tets[:, :4]].mean(1)
    centroid = (volume[:, None] * middles).sum(0) / volume.sum()
    if barycentric(x, tets, centroid).min(1).max() > 1e-3:
        return centroid
    return middles[np.argmin(np.linalg.norm(middles - centroid, axis=1))]


def needle_force(one, axis):
    """Force along the needle while its tip is in the last fifth of the deepest path, on the way in."""
    force, depth = one["base_force"][:] @ axis, one["depth"][:]
    deepest = int(np.argmax(depth >= depth.max() * (1 - 1e-6)))
    if deepest == 0 or depth.max() <= 0.0:  # inserted at the start, or never
        return force[-1]
    rows = np.arange(deepest + 1)
    return force[rows[depth[: deepest + 1] >= 0.8 * depth.max()]].mean()


def histories(r, first):
    """What the histories say at the end of a run; the first field file knows the needle's axis."""
    found = {}
    history = r["history"]
    for name, one in history.get("needle", {}).items():
        line = first[f"needle/{name}/axis"][:] if f"needle/{name}/axis" in first else None
        if line is not None:
            axis = (line[-1] - line[0]) / np.linalg.norm(line[-1] - line[0])
            found[f"force of {name} [N]"] = needle_force(one, axis)
            found[f"end force of {name} [N]"] = one["base_force"][-1] @ axis
    for name, one in history.get("cavity", {}).items():
        found[f"pressure of {name} [Pa]"] = one["pressure"][-1]
        found[f"volume of {name} [m^3]"] = one["volume"][-1]
    for name, one in history.get("boundary", {}).items():
        found[f"force of {name} [N]"] = np.linalg.norm(one["force"][-1])
    if "pv_curve" in r:
        found["dP/d(V/V0) [Pa]"] = r["pv_curve/slope"][0]
    return found


def measure(folder, probes):
    """Size and quantities of one run; probes is filled from the first (coarsest) run when empty."""
    with h5py.File(folder / "run.h5") as r, last_fields(folder) as f:
        x, tets, volume = read_mesh(r)
        if not probes:
            probes.append(default_probe(x, tets, volume))
        u, s = f["displacement"][:], f["stress"][:]
        mises = (0.5 * ((s[:, 0] - s[:, 1]) ** 2 + (s[:, 1] - s[:, 2]) ** 2
                        + (s[:, 2] - s[:, 0]) ** 2) + 3.0 * (s[:, 3:] ** 2).sum(1))
        found = {"largest |u| [m]": np.linalg.norm(u, axis=1).max()}
        for k, place in enumerate(probes, 1):
            found[f"|u| at probe {k} [m]"] = np.linalg.norm(interpolate(x, tets, u, place))
        found["RMS von Mises [Pa]"] = np.sqrt((volume * mises).sum() / volume.sum())
        found["strain energy [J]"] = (volume * f["strain_energy"][:]).sum()
        with h5py.File(folder / "fields/step_000000.h5") as first:
            found |= histories(r, first)
    size = {"nodes": len(x), "tets": len(tets), "h": np.cbrt(volume.sum() / len(tets)),
            "h_nodes": np.cbrt(volume.sum() / len(x))}
    return size, found
