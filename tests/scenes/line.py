"""-insertion_placement line: the stiffness of a shaft is that of its closed form, and a target beside the path
converges.

A shaft that goes through a block whose sides are held, along its axis: antiplane shear between a circle of
radius r and a square of side a, 2 pi mu / ln(0.53935 a/r) per length; across it plane strain,
8 pi mu (1 - nu)/((3 - 4 nu) ln(a/r) + 1/2 + U), with U the regular part of Kelvin's solution at the middle of
the square (-2.1312 at nu = 0.3, -2.0530 at 0.45: quadratic triangles, three meshes). The difference between
blocks of 6 and 3 cm is free of what happens at their ends.
Target: four places 1 to 2 cm beside 4 cm of a rigid needle with 10 N/m, in a block 6 x 4 x 4 cm on slipping
supports. The reference is another code's, with the shaft resolved: quadratic tets graded to 0.36 mm, 206409 dofs.
With --long all elements on finer and coarser meshes, and the order over four of them.
"""
import functools
import math
import os
import subprocess
import sys

import h5py
import numpy as np

from harness import FOLDER, check, completed, finish, written

LONG = "--long" in sys.argv
SIDE, PUSH, RADIUS = 0.04, 1e-5, 0.0006
REGULAR = {0.3: -2.1312, 0.45: -2.0530}
GEOMETRY = """SetFactory("OpenCASCADE");
Box(1) = {0, %g, %g, %g, 0.04, 0.04};
Mesh.CharacteristicLengthMin = %g;
Mesh.CharacteristicLengthMax = %g;
Physical Volume("gel") = {1};
Physical Surface("x0") = {1};
Physical Surface("x1") = {2};
Physical Surface("sides") = {3, 4, 5, 6};
Physical Surface("y0") = {3};
Physical Surface("z0") = {5};
"""


@functools.cache
def block(length, h, corner=-0.02):
    name = f"line_{length:g}_{h:g}_{corner:g}"
    geometry = written(name + ".geo", GEOMETRY % (corner, corner, length, h, h))
    path = os.path.join(FOLDER, name + ".msh")
    subprocess.run(["gmsh", "-3", geometry, "-o", path], check=True, capture_output=True)
    return path


def held_needle(element, poisson, path, depth, **more):
    """Options of a rigid needle that is in the tissue and whose base follows `path`, in one static step."""
    rows = "".join(f"{t},{x!r},{y!r},{z!r}\n" for t, (x, y, z) in enumerate(path))
    return {"-analysis": "static", "-time_step": "1", "-time_end": "1", "-tissue_model": "linear",
            "-tissue_young": "5000", "-tissue_poisson": str(poisson), "-tissue_element": element, "-needles": "n",
            "-needle_model": "rigid", "-needle_length": repr(depth + 0.03), "-needle_inserted": repr(depth),
            "-needle_trajectory": written("push.csv", "time,x,y,z\n" + rows), "-insertion_placement": "line",
            "-quiet": "", **more}


def through_force(element, poisson, length, h, across):
    start = np.array([-0.03, 0.0008, -0.0005])
    pushed = start + PUSH * np.array([0, 1, 0] if across else [1, 0, 0])
    folder = completed(held_needle(element, poisson, [start.tolist(), pushed.tolist()], length, **{
        "-mesh": block(length, h), "-fix": "sides,x0:x,x1:x" if across else "sides,x0:yz,x1:yz",
        "-needle_entry": "0,0.0008,-0.0005", "-needle_radius": repr(RADIUS),
        "-insertion_friction_static": "1e6", "-insertion_friction_dynamic": "1e6"}))
    with h5py.File(os.path.join(folder, "run.h5")) as run:
        return run["history/needle/n/base_force"][-1, 1 if across else 0]


def closed_form(poisson, across):
    """Of 3 cm of shaft pushed by PUSH [N]."""
    shear = 5000 / (2 * (1 + poisson))
    if across:
        kelvin = (3 - 4 * poisson) * math.log(SIDE / RADIUS) + 0.5 + REGULAR[poisson]
        return 8 * math.pi * shear * (1 - poisson) / kelvin * 0.03 * PUSH
    return 2 * math.pi * shear / math.log(0.53935 * SIDE / RADIUS) * 0.03 * PUSH


for element, poisson, sizes in (
        ("p1", 0.3, (0.0027,)), ("p1_anp", 0.45, (0.0027,)), ("p2", 0.45, (0.0044,)), ("p2_bbar", 0.45, (0.0044,)),
        *((("p1", 0.45, (0.0033, 0.0022)), ("p1_anp", 0.3, (0.0033, 0.0022)), ("p2", 0.3, (0.0055, 0.004, 0.003)),
           ("p2_anp", 0.45, (0.0055, 0.004)), ("p2_bbar", 0.3, (0.0055, 0.004))) if LONG else ())):
    most = 0.015 if element.startswith("p2") else 0.025
    for h in sizes:
        for across in (False, True):
            force = (through_force(element, poisson, 0.06, h, across) -
                     through_force(element, poisson, 0.03, h, across)) / closed_form(poisson, across)
            print(f"{element}, nu {poisson}, edges {1e3 * h:g} mm, {'across' if across else 'along'}: {force:.4f} of the "
                  f"closed form")
            check(abs(force - 1) < most, f"{element} {h} {across}: {force:.4f}")

ENTRY = np.array([0, 0.0193, 0.0207])
AXIS = np.array([1, 0.05, -0.03]) / np.linalg.norm([1, 0.05, -0.03])
TARGETS = np.array([[0.030, 0.0045, 0.0345], [0.025, 0.0345, 0.0060], [0.040, 0.0110, 0.0300], [0.028, 0.0300, 0.0290]])
# [m] at 10 N/m along 4 cm; the other code's ring loses 0.02 % of the force at the surface.
RESOLVED = 1e-3 * 0.4 / 0.39991 * np.array([[1.130709, 0.061124, 0.587946], [1.334338, 0.615715, 0.050327],
                                            [0.950135, 0.170965, 0.683895], [1.374044, 0.454731, 0.356355]])
FRICTION = 1e-3  # [N/m]: displacements so small that the path stays 4 cm long; the tissue is linear


def displacement(folder, place):
    """Interpolated in the last field, quadratic or linear."""
    with h5py.File(os.path.join(folder, "run.h5")) as run:
        x, tets = run["mesh/coordinates"][()], run["mesh/tets"][()]
    fields = os.path.join(folder, "fields")
    with h5py.File(os.path.join(fields, sorted(os.listdir(fields))[-1])) as last:
        u = last["displacement"][()]
    corner = x[tets[:, :4]]
    edges = np.moveaxis(corner[:, 1:] - corner[:, :1], 1, 2)
    inner = np.linalg.solve(edges, (place - corner[:, 0])[:, :, None])[:, :, 0]
    at = np.concatenate([1 - inner.sum(1, keepdims=True), inner], 1)
    tet = at.min(1).argmax()
    w = at[tet]
    if tets.shape[1] == 10:
        middles = [4 * w[i] * w[j] for i, j in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]
        w = np.concatenate([w * (2 * w - 1), middles])
    return w @ u[tets[tet]]


def target_error(element, h):
    """Root mean square over the targets of error over displacement."""
    base = ENTRY - 0.03 * AXIS
    folder = completed(held_needle(element, 0.45, [base.tolist(), (base + 1e-6 * AXIS).tolist()], 0.04, **{
        "-mesh": block(0.06, h, 0.0), "-fix": "x1:x,y0:y,z0:z", "-needle_radius": "0.0005",
        "-needle_entry": ",".join(map(repr, ENTRY.tolist())), "-needle_direction": ",".join(map(repr, AXIS.tolist())),
        "-insertion_friction_static": str(FRICTION), "-insertion_friction_dynamic": str(FRICTION),
        "-constraint_tolerance": "1e-14", "-output_fields": "displacement"}))
    off = [np.linalg.norm(displacement(folder, place) * 10 / FRICTION - exact) / np.linalg.norm(exact)
           for place, exact in zip(TARGETS, RESOLVED)]
    return math.sqrt(np.mean(np.square(off)))


error = target_error("p2", 0.0044)
print(f"target, p2, edges 4.4 mm: {100 * error:.3f} %")
check(error < 0.0015, f"target: {error:.5f}")
if LONG:
    sizes = (0.0095, 0.007, 0.0053, 0.0034)
    errors = [target_error("p2", h) for h in sizes]
    order = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    print("target, p2:", ", ".join(f"{1e3 * h:g} mm {100 * e:.3f} %" for h, e in zip(sizes, errors)), f"order {order:.2f}")
    check(order > 1.8, f"order {order:.2f}")
finish()
