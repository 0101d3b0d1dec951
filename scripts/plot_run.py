#!/usr/bin/env python3
"""Plots a result folder: force against depth, and the needle in a cut through the tissue.

usage: plot_run.py FOLDER     writes FOLDER/force.png, FOLDER/cut.png, FOLDER/cavities.png and
                              FOLDER/pv_curve.png, as far as the run has them
"""
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

BLUE, ORANGE, GREY = "#1f5f8b", "#d9772b", "#6b6b6b"
EDGES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]


def names(run):
    return sorted(run["history/needle"]) if "needle" in run["history"] else []


def phases(depth):
    """Index of the first step after the deepest one: where the withdrawal begins."""
    deepest = depth.max()
    return int(np.flatnonzero(depth >= deepest * (1 - 1e-9))[-1]) + 1


def plot_force(run, folder):
    needles = names(run)
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    time = run["history/time"][:]
    for name in needles:
        one = run[f"history/needle/{name}"]
        depth = 1e3 * one["depth"][:]
        friction = one["shaft_friction"][:]
        base = one["base_force"][:]
        turn = phases(depth)
        label = "" if len(needles) == 1 else f" ({name})"
        axes[0].plot(depth[:turn], friction[:turn], color=BLUE, label="advance and hold" + label)
        axes[0].plot(depth[turn - 1 :], friction[turn - 1 :], color=ORANGE, label="withdrawal" + label)
        tip = one["tip_force"][:]
        if tip.max() > 0:
            axes[0].plot(depth, tip, color=GREY, lw=1.0, label="tip" + label)
        for k, axis in enumerate("xyz"):
            axes[1].plot(time, base[:, k], label=f"base force {axis}{label}", lw=1.2)
    axes[0].set(xlabel="depth [mm]", ylabel="force [N]", title="Shaft friction and tip force")
    axes[1].set(xlabel="time [s]", ylabel="force of the holder [N]", title="Base force")
    for ax in axes:
        ax.grid(alpha=0.3)
        ax.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "force.png", dpi=130)
    plt.close(figure)


def plot_cavities(run, folder):
    """Pressures, volumes, flows and tool forces against time."""
    history = run["history"]
    cavities = run["history/cavity"] if "cavity" in history else {}
    edges = run["history/edge"] if "edge" in history else {}
    tools = run["history/boundary"] if "boundary" in history else {}
    time = run["history/time"][:]
    panels = [bool(len(cavities)), bool(len(cavities)), bool(len(edges)), bool(len(tools))]
    figure, axes = plt.subplots(1, sum(panels), figsize=(4.2 * sum(panels), 3.8), constrained_layout=True, squeeze=False)
    ax = iter(axes[0])
    marker = "." if len(time) < 30 else None
    if len(cavities):
        pressure, volume = next(ax), next(ax)
        for name, one in cavities.items():
            pressure.plot(time, one["pressure"][:], marker=marker, label=name)
            volume.plot(time, 1e6 * one["volume"][:], marker=marker, label=name)
            alarm = np.flatnonzero(one["alarm"][:])
            if len(alarm):
                pressure.axvline(time[alarm[0]], color=ORANGE, lw=1, ls="--", label=f"alarm of {name}")
        pressure.set(ylabel="pressure [Pa]", title="Pressure")
        volume.set(ylabel="volume [ml]", title="Volume")
        volume.ticklabel_format(useOffset=False)
    if len(edges):
        flow = next(ax)
        for name, one in edges.items():
            flow.plot(time, 1e6 * one["flow"][:], label=f"{name}: flow [ml/s]")
            flow.plot(time, 1e6 * one["moved"][:], ls="--", label=f"{name}: moved [ml]")
        flow.set(title="Network")
    if len(tools):
        force = next(ax)
        for name, one in tools.items():
            for k, axis in enumerate("xyz"):
                force.plot(time, one["force"][:, k], marker=marker, label=f"{name} {axis}")
        force.set(ylabel="force on the tissue [N]", title="Tools")
    for one in axes[0]:
        one.set_xlabel("time [s]")
        one.grid(alpha=0.3)
        one.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "cavities.png", dpi=130)
    plt.close(figure)


def plot_pv_curve(run, folder):
    curve = run["pv_curve"]
    ratio = curve["volume_ratio"][:]
    figure, ax = plt.subplots(figsize=(5.5, 4.2), constrained_layout=True)
    ax.plot(ratio, 1e-3 * curve["pressure"][:], ".", color=BLUE, label="equilibria")
    ax.plot(ratio, 1e-3 * curve["line"][:], color=ORANGE, lw=1,
            label=f"line: slope {1e-3 * curve['slope'][0]:.3g} kPa, R² {curve['r_squared'][0]:.4f}")
    ax.plot(ratio, 1e-3 * curve["pieces"][:], color=GREY, lw=1, ls="--", label="piecewise fit")
    ax.set(xlabel="volume ratio V/V₀", ylabel="pressure [kPa]", title="P-V curve")
    ax.grid(alpha=0.3)
    ax.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "pv_curve.png", dpi=130)
    plt.close(figure)


def cut_polygons(x, value, tets, normal_axis, at):
    """Polygons of the plane x[normal_axis] = at with the deformed tets, and their values."""
    side = x[:, normal_axis] - at
    corners = side[tets]
    crossed = tets[(corners.min(1) < 0) & (corners.max(1) >= 0)]
    keep = [k for k in range(3) if k != normal_axis]
    polygons, values = [], []
    for tet in crossed:
        points, colours = [], []
        for a, b in EDGES:
            p, q = tet[a], tet[b]
            if (side[p] < 0) == (side[q] < 0):
                continue
            t = side[p] / (side[p] - side[q])
            points.append((1 - t) * x[p] + t * x[q])
            colours.append((1 - t) * value[p] + t * value[q])
        points = np.array(points)[:, keep]
        middle = points.mean(0)
        order = np.argsort(np.arctan2(*(points - middle).T[::-1]))
        polygons.append(1e3 * points[order])
        values.append(np.mean(colours))
    return polygons, values


def draw_cut(ax, run, step_file, start_file, needles):
    x0 = run["mesh/coordinates"][:]
    tets = run["mesh/tets"][:]
    with h5py.File(step_file) as step, h5py.File(start_file) as start:
        u = step["displacement"][:]
        moved = np.linalg.norm(u - start["displacement"][:], axis=1)
        if not needles or step_file == start_file:
            moved = np.linalg.norm(u, axis=1)
        time = step["time"][0]
        shafts = [step[f"needle/{name}/axis"][:] for name in needles]
        points = step["coupling/position"][:] if "coupling" in step else np.zeros((0, 3))
    # The plane of the cut holds the (first) needle's tip and leaves out its most constant axis.
    normal, at = 1, np.median(x0[:, 1])
    if shafts:
        normal = int(np.argmin(np.ptp(shafts[0], axis=0)[:2])) if np.ptp(shafts[0], axis=0)[:2].any() else 1
        at = shafts[0][-1, normal]
    keep = [k for k in range(3) if k != normal]
    polygons, values = cut_polygons(x0 + u, 1e3 * moved, tets, normal, at)
    body = PolyCollection(polygons, array=np.array(values), cmap="YlGnBu", edgecolors="#00000022", lw=0.4)
    ax.add_collection(body)
    for shaft in shafts:
        ax.plot(*(1e3 * shaft[:, keep]).T, color="black", lw=2.2, solid_capstyle="round")
    if len(points):
        ax.plot(*(1e3 * points[:, keep]).T, ".", color=ORANGE, ms=5, label="coupling points")
        ax.legend(frameon=False, fontsize=8, loc="lower left")
    ax.autoscale_view()
    ax.set_aspect("equal")
    letters = "xyz"
    ax.set(xlabel=f"{letters[keep[0]]} [mm]", ylabel=f"{letters[keep[1]]} [mm]", title=f"t = {time:.2f} s")
    return body


def plot_cut(run, folder):
    steps = sorted((folder / "fields").glob("step_*.h5"))
    with_field = [s for s in steps if "displacement" in h5py.File(s)]
    if not with_field:
        return False
    needles = names(run)
    chosen = with_field[-1]
    if needles:
        depth = run[f"history/needle/{needles[0]}/depth"][:]
        chosen = max(with_field, key=lambda s: (depth[int(s.stem[5:])], s.name))
    figure, ax = plt.subplots(figsize=(10, 4.2), constrained_layout=True)
    body = draw_cut(ax, run, chosen, with_field[0], needles)
    figure.colorbar(body, ax=ax, shrink=0.8).set_label(
        "displacement since the start [mm]" if needles and chosen != with_field[0] else "displacement [mm]"
    )
    figure.savefig(folder / "cut.png", dpi=130)
    plt.close(figure)
    return True


def main():
    folder = Path(sys.argv[1])
    written = []
    with h5py.File(folder / "run.h5") as run:
        if names(run) and len(run["history/time"]) > 1:
            plot_force(run, folder)
            written.append("force.png")
        if "pv_curve" in run:
            plot_pv_curve(run, folder)
            written.append("pv_curve.png")
        elif len(run["history/time"]) > 1 and ({"cavity", "boundary"} & set(run["history"])):
            plot_cavities(run, folder)
            written.append("cavities.png")
        if plot_cut(run, folder):
            written.append("cut.png")
    print("pictures:", " ".join(f"{folder}/{name}" for name in written) or "none")


main()
