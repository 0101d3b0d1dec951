#!/usr/bin/env python3
"""Plots a result folder: base force against insertion, and the needle in a cut through the tissue.

usage: plot_run.py FOLDER     writes FOLDER/force.png, FOLDER/cut.png, FOLDER/cavities.png,
                              FOLDER/contact.png and FOLDER/pv_curve.png, as far as the run has them
"""
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from cut_figure import cut_figure

BLUE, ORANGE, GREY, PALE = "#1f5f8b", "#d9772b", "#6b6b6b", "#cccccc"


def names(run):
    return sorted(run["history/needle"]) if "needle" in run["history"] else []


def insertion(needle):
    """How far the base has come [mm]; of older results the depth."""
    return 1e3 * needle["travel" if "travel" in needle else "depth"][:]


def turn(travel):
    """Rows before the withdrawal; all of them when there is none."""
    furthest = travel.max()
    return int(np.flatnonzero(travel >= furthest - 1e-9 * max(abs(furthest), 1.0))[-1]) + 1


def direction(run, name):
    """Unit vector along the needle at the start."""
    options = [word.decode() for word in run["provenance/options/name"]]
    value = run["provenance/options/value"][options.index(f"needle_{name}_direction")].decode()
    along = np.array([float(x) for x in value.split(",")])
    return along / np.linalg.norm(along)


def settle(ax):
    """A quantity that is constant but for round-off is drawn as constant."""
    lines = [line.get_ydata() for line in ax.get_lines() if len(line.get_ydata()) > 2]
    if not lines:
        return
    low, high = min(np.min(y) for y in lines), max(np.max(y) for y in lines)
    size = max(abs(low), abs(high))
    if high - low <= 1e-9 * size:
        half = 0.05 * size if size > 0.0 else 1.0
        ax.set_ylim(0.5 * (low + high) - half, 0.5 * (low + high) + half)
    ax.ticklabel_format(axis="y", useOffset=False)


def draw_insertion(ax, run, name, label):
    """Force along the needle against the advance of its base, with what it is made of."""
    needle = run[f"history/needle/{name}"]
    travel = insertion(needle)
    force = needle["base_force"][:] @ direction(run, name)
    back = turn(travel)
    ax.plot(travel[:back], force[:back], color=BLUE, label="base, advance and hold" + label)
    if back < len(travel):
        ax.plot(travel[back - 1 :], force[back - 1 :], color=ORANGE, label="base, withdrawal" + label)
    for part, style in (("shaft_friction", {"color": PALE, "lw": 3.5}), ("tip_force", {"color": GREY, "ls": ":"})):
        values = needle[part][:]
        if np.any(values != 0.0):
            ax.plot(travel, values, label=part.replace("_", " ") + label, zorder=1, **style)
    if travel.max() > 0.0:  # what is beyond the start, after a withdrawal, is beside the tissue
        ax.set_xlim(left=max(travel.min(), 0.0) - 0.05 * travel.max())
    ax.set(xlabel="travel of the base [mm]" if "travel" in needle else "depth [mm]",
           ylabel="force along the needle [N]", title="Base force against insertion")


def force_figure(run):
    needles = names(run)
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    for name in needles:
        label = "" if len(needles) == 1 else f" ({name})"
        draw_insertion(axes[0], run, name, label)
        base = run[f"history/needle/{name}/base_force"]
        for k, axis in enumerate("xyz"):
            axes[1].plot(run["history/time"][:], base[:, k], label=f"base force {axis}{label}", lw=1.2)
    axes[1].set(xlabel="time [s]", ylabel="force of the holder [N]", title="Base force")
    for ax in axes:
        settle(ax)
        ax.grid(alpha=0.3)
        ax.legend(frameon=False, fontsize=8)
    return figure


def draw_cavities(pressure, volume, cavities, time, marker):
    for name, one in cavities.items():
        pressure.plot(time, one["pressure"][:], marker=marker, label=name)
        volume.plot(time, 1e6 * one["volume"][:], marker=marker, label=name)
        alarm = np.flatnonzero(one["alarm"][:])
        if len(alarm):
            pressure.axvline(time[alarm[0]], color=ORANGE, lw=1, ls="--", label=f"alarm of {name}")
    pressure.set(ylabel="pressure [Pa]", title="Pressure")
    volume.set(ylabel="volume [ml]", title="Volume")


def cavities_figure(run):
    """Pressures, volumes, flows and tool forces against time."""
    history = run["history"]
    cavities, conduits, tools = (history.get(name, {}) for name in ("cavity", "conduit", "boundary"))
    time = history["time"][:]
    count = 2 * bool(len(cavities)) + bool(len(conduits)) + bool(len(tools))
    figure, axes = plt.subplots(1, count, figsize=(4.2 * count, 3.8), constrained_layout=True, squeeze=False)
    ax = iter(axes[0])
    marker = "." if len(time) < 30 else None
    if len(cavities):
        draw_cavities(next(ax), next(ax), cavities, time, marker)
    if len(conduits):
        flow = next(ax)
        for name, one in conduits.items():
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
        settle(one)
        one.set_xlabel("time [s]")
        one.grid(alpha=0.3)
        one.legend(frameon=False, fontsize=8)
    return figure


def contact_figure(run):
    """Forces of the pairs, and how much of them touches, against time."""
    time = run["history/time"][:]
    figure, (force, area, corners) = plt.subplots(1, 3, figsize=(12.6, 3.8), constrained_layout=True)
    for name, pair in run["history/contact"].items():
        for k, axis in enumerate("xyz"):
            force.plot(time, pair["force"][:, k], label=f"{name} {axis}")
        area.plot(time, 1e4 * pair["area"][:], label=name)
        corners.plot(time, pair["sticking"][:], label=f"{name}: sticking")
        corners.plot(time, pair["slipping"][:], label=f"{name}: slipping")
    force.set(ylabel="force on the master [N]", title="Contact")
    area.set(ylabel="touching area [cm²]", title="Area")
    corners.set(ylabel="corners", title="Slave corners that touch")
    for one in (force, area, corners):
        settle(one)
        one.set_xlabel("time [s]")
        one.grid(alpha=0.3)
        one.legend(frameon=False, fontsize=8)
    return figure


def pv_figure(run):
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
    return figure


def figures(run, folder):
    """The pictures of a run by name."""
    rows = len(run["history/time"])
    found = {}
    if names(run) and rows > 1:
        found["force.png"] = force_figure(run)
    if "pv_curve" in run:
        found["pv_curve.png"] = pv_figure(run)
    elif rows > 1 and {"cavity", "boundary"} & set(run["history"]):
        found["cavities.png"] = cavities_figure(run)
    if rows > 1 and "contact" in run["history"]:
        found["contact.png"] = contact_figure(run)
    cut = cut_figure(run, folder, names(run))
    if cut:
        found["cut.png"] = cut
    return found


def main():
    folder = Path(sys.argv[1])
    with h5py.File(folder / "run.h5") as run:
        found = figures(run, folder)
    for name, figure in found.items():
        figure.savefig(folder / name, dpi=130)
    print("pictures:", " ".join(f"{folder}/{name}" for name in found) or "none")


if __name__ == "__main__":
    main()
