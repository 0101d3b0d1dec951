"""A plane cut through the deformed tissue, filled with its displacement, and the needles in it."""
import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

ORANGE = "#d9772b"
MIDDLES = {(0, 1): 4, (1, 2): 5, (0, 2): 6, (0, 3): 7, (1, 3): 8, (2, 3): 9}
FACES = [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]


def straight_parts(tets):
    """Tets and faces with corners alone: those of ten nodes are eight such tets, a face is four."""
    if tets.shape[1] == 4:
        return tets, np.concatenate([tets[:, face] for face in FACES])
    parts = [(0, 4, 6, 7), (1, 5, 4, 8), (2, 6, 5, 9), (3, 7, 9, 8),
             (4, 9, 5, 6), (4, 9, 6, 7), (4, 9, 7, 8), (4, 9, 8, 5)]
    faces = []
    for a, b, c in FACES:
        ab, bc, ac = MIDDLES[a, b], MIDDLES[b, c], MIDDLES[a, c]
        faces += [(a, ab, ac), (ab, b, bc), (ac, bc, c), (ab, bc, ac)]
    return (np.concatenate([tets[:, part] for part in parts]),
            np.concatenate([tets[:, face] for face in faces]))


def crossed_edges(cells, side, shapes):
    """Of simplices the edges that cross side = 0, as many triples or pairs as their shapes have:
    shapes[k] lists the edges of one with k negative corners, by the order of their sides."""
    order = np.argsort(side[cells], axis=1, kind="stable")
    cells = np.take_along_axis(cells, order, axis=1)
    negative = (side[cells] < 0).sum(1)
    return np.concatenate([cells[negative == k][:, edges] for k, many in shapes.items() for edges in many])


def triangles(tets, side):
    """Triangles of the plane in tets: (triangles, 3, 2), the ends of the edges their corners are on."""
    return crossed_edges(tets, side, {1: [[(0, 1), (0, 2), (0, 3)]], 3: [[(0, 3), (1, 3), (2, 3)]],
                                      2: [[(0, 2), (0, 3), (1, 3)], [(0, 2), (1, 3), (1, 2)]]})


def segments(faces, side):
    """Lines of the plane in faces: (lines, 2, 2)."""
    return crossed_edges(faces, side, {1: [[(0, 1), (0, 2)]], 2: [[(0, 2), (1, 2)]]})


def at_plane(value, ends, side):
    """Linear between the ends of an edge."""
    p, q = ends[..., 0], ends[..., 1]
    t = side[p] / (side[p] - side[q])
    if value.ndim > 1:
        t = t[..., None]
    return (1 - t) * value[p] + t * value[q]


def section(x, value, tets, plane):
    """The plane x[normal] = at through the tets: a triangulation [mm] and its values."""
    normal, at = plane
    keep = [k for k in range(3) if k != normal]
    side = x[:, normal] - at
    ends = triangles(tets, side)
    edges, corner = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    corner = corner.reshape(-1, 3)
    place = 1e3 * at_plane(x, edges, side)[:, keep]
    one, two = place[corner[:, 1]] - place[corner[:, 0]], place[corner[:, 2]] - place[corner[:, 0]]
    area = np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
    return Triangulation(*place.T, corner[area > 1e-12 * area.max()]), at_plane(value, edges, side)


def fill(ax, x, value, tets, plane):
    """A plane through the tets, filled with the value of the nodes, and the mesh in it."""
    cells, faces = straight_parts(tets)
    shown, values = section(x, value, cells, plane)
    high = max(values.max(), 1e-9)
    body = ax.tricontourf(shown, values, levels=np.linspace(0.0, high, 65), cmap="YlGnBu")
    side = x[:, plane[0]] - plane[1]
    keep = [k for k in range(3) if k != plane[0]]
    lines = 1e3 * at_plane(x, segments(faces, side), side)[..., keep]
    ax.add_collection(LineCollection(lines, colors="#00000020", lw=0.4))
    return body, np.column_stack([shown.x, shown.y])


def frame(ax, corners):
    """The tissue fills the picture; needles stick out of it."""
    low, high = corners.min(0), corners.max(0)
    margin = np.array([0.12, 0.06]) * (high - low)
    ax.set(xlim=(low - margin)[[0]].tolist() + (high + margin)[[0]].tolist(),
           ylim=(low - margin)[[1]].tolist() + (high + margin)[[1]].tolist())
    ax.set_aspect("equal")
    width, height = (high - low) + 2 * margin
    scale = min(8.0 / width, 5.5 / height)
    ax.figure.set_size_inches(scale * width + 2.0, scale * height + 1.0)


def cut_through(tissue, shafts):
    """Normal axis and place of a plane that holds the (first) needle's tip, within the tissue."""
    if not shafts:
        return 1, np.median(tissue[:, 1])
    extent = np.ptp(shafts[0], axis=0)[:2]
    normal = int(np.argmin(extent)) if extent.any() else 1
    low, high = tissue[:, normal].min(), tissue[:, normal].max()
    inside = 1e-6 * (high - low)
    return normal, np.clip(shafts[0][-1, normal], low + inside, high - inside)


def draw_cut(ax, run, step_file, start_file, needles):
    x0 = run["mesh/coordinates"][:]
    with h5py.File(step_file) as step, h5py.File(start_file) as start:
        u = step["displacement"][:]
        since_start = needles and step_file != start_file
        moved = np.linalg.norm(u - start["displacement"][:] if since_start else u, axis=1)
        time = step["time"][0]
        shafts = [step[f"needle/{name}/axis"][:] for name in needles]
        points = step["coupling/position"][:] if "coupling" in step else np.zeros((0, 3))
    plane = cut_through(x0 + u, shafts)
    keep = [k for k in range(3) if k != plane[0]]
    body, corners = fill(ax, x0 + u, 1e3 * moved, run["mesh/tets"][:], plane)
    for shaft in shafts:
        ax.plot(*(1e3 * shaft[:, keep]).T, color="black", lw=2.2, solid_capstyle="round")
    if len(points):
        ax.plot(*(1e3 * points[:, keep]).T, ".", color=ORANGE, ms=5, label="coupling points")
        ax.legend(frameon=False, fontsize=8, loc="lower right", bbox_to_anchor=(1, 1))
    frame(ax, corners)
    ax.set(xlabel=f"{'xyz'[keep[0]]} [mm]", ylabel=f"{'xyz'[keep[1]]} [mm]",
           title=f"t = {time:.2f} s, cut at {'xyz'[plane[0]]} = {1e3 * plane[1]:.1f} mm")
    bar = ax.figure.colorbar(body, ax=ax, shrink=0.9, ticks=MaxNLocator(6), format="%g")
    bar.set_label("displacement since the start [mm]" if since_start else "displacement [mm]")


def cut_figure(run, folder, needles):
    """The cut where the first needle is deepest, else at the end; nothing without displacements."""
    with_field = []
    for path in sorted((folder / "fields").glob("step_*.h5")):
        with h5py.File(path) as step:
            if "displacement" in step:
                with_field.append(path)
    if not with_field:
        return None
    chosen = with_field[-1]
    if needles:
        depth = run[f"history/needle/{needles[0]}/depth"][:]
        chosen = max(with_field, key=lambda s: (depth[int(s.stem[5:])], s.name))
    figure, ax = plt.subplots(constrained_layout=True)
    draw_cut(ax, run, chosen, with_field[0], needles)
    return figure
