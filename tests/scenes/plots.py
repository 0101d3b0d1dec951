"""The pictures of a run: what stands on their axes and in their legends, and that the cut is filled."""
import os
import sys
from pathlib import Path

import h5py
import numpy as np

from harness import ROOT, check, completed, finish, options, small_block, structured

sys.path.insert(0, os.path.join(ROOT, "scripts"))
import cut_figure  # noqa: E402
import plot_run  # noqa: E402


def pictures(settings):
    """The figures of a run by name, written as files as well."""
    folder = completed(settings)
    with h5py.File(os.path.join(folder, "run.h5")) as run:
        found = plot_run.figures(run, Path(folder))
    for name, figure in found.items():
        figure.savefig(os.path.join(folder, name))
        check(os.path.getsize(os.path.join(folder, name)) > 5000, f"{name} is written")
    return found


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def filled(tets, x, plane):
    """Area of the triangles that fill a cut [m²]."""
    cells, _ = cut_figure.straight_parts(tets)
    shown, _ = cut_figure.section(x, x[:, 0], cells, plane)
    a, b, c = (np.column_stack([shown.x, shown.y])[shown.triangles[:, k]] for k in range(3))
    return 1e-6 * 0.5 * np.abs(np.cross(b - a, c - a)).sum()


small = options("small_insertion.opts")
small.update({"-mesh": small_block(), "-time_end": "1.4"})

# In and no further: base force first, against travel, and no word of a withdrawal.
found = pictures(small)
first = found["force.png"].axes[0]
check(first.get_title() == "Base force against insertion", "the first plot is the base force")
check(first.get_xlabel() == "travel of the base [mm]", "against the travel")
check(not any("withdrawal" in word for word in legend(first)), f"no withdrawal, none in the legend {legend(first)}")
line = first.get_lines()[0]
check(np.isclose(line.get_xdata().max(), 28.0), "all of the travel is drawn")
# Out again: from where the base turns.
back = pictures({**small, "-time_end": "3"})["force.png"].axes[0]
check(any("withdrawal" in word for word in legend(back)), "a withdrawal is in the legend")
out = back.get_lines()[1].get_xdata()
check(np.isclose(out.max(), 30.0) and np.all(np.diff(out) <= 0.0), "and its line goes back")
check(not any("withdrawal" in word for word in legend(pictures(
    {**small, "-time_end": "2"})["force.png"].axes[0])), "nor is a hold one")

# The cut is filled: its triangles cover the section, of linear tets and of quadratic ones.
for element in ("p1", "p2"):
    folder = completed({**small, "-tissue_element": element, "-time_end": "0.1"})
    with h5py.File(os.path.join(folder, "run.h5")) as run:
        tets, x = run["mesh/tets"][:], run["mesh/coordinates"][:]
    for plane, area in (((1, 0.0173), 0.06 * 0.04), ((1, 0.02), 0.06 * 0.04), ((0, 0.0321), 0.04 * 0.04)):
        check(np.isclose(filled(tets, x, plane), area, rtol=1e-12), f"{element}: a cut at {plane} is filled")
x[:, 2] += 3.0 * (x[:, 0] - 0.03) ** 2  # parabolas, which quadratic tets follow in chords
check(np.isclose(filled(tets, x, (1, 0.0173)), 0.06 * 0.04, rtol=1e-3), "so is one of curved tets")
cut = found["cut.png"].axes[0]
check(len(cut.collections) > 1, "the cut has colours and the mesh")

# A volume that stays is drawn as one that stays.
phantom = options("phantom.opts")
phantom.update({"-mesh": structured("hollow", *"--nodes 7 6 6 --size 0.06 0.05 0.05 --split 6 --volumes gel "
                "--sides probe,stage,bottom,top,front,back --ellipsoid 0.03 0.025 0.025 0.012 0.015 0.012".split())})
panel = [ax for ax in pictures(phantom)["cavities.png"].axes if ax.get_title() == "Volume"][0]
volume = panel.get_lines()[0].get_ydata()
low, high = panel.get_ylim()
check(np.ptp(volume) < 1e-9 * volume[0], "the fluid keeps its volume")
check(high - low > 0.05 * volume[0], f"and the axis does not blow its round-off up ({low} to {high} ml)")
check(panel.yaxis.get_major_formatter().get_offset() == "", "nor has it an offset")

# What touches is drawn as it is.
touching = options("ball_on_block.opts")
touching.update({"-time_end": "0.2"})
area = [ax for ax in pictures(touching)["contact.png"].axes if ax.get_title() == "Area"][0].get_lines()[0].get_ydata()
check(area[0] == 0.0 and 0.01 < area[-1] < 1.0, f"the touching area grows from nothing, in cm² ({area[-1]})")
finish()
