"""-insertion_radius_correction: a sticking needle's force is that of its shaft, on any mesh.

Along the axis of a block whose sides are held the force has a closed form: antiplane shear between
a shaft of radius r and a square, F = 2 pi mu L u / ln(R/r), R = 0.53935 sides being the square's
inner radius. Across it there is none; the meshes must agree: two, with --long three.
"""
import functools
import math
import os
import subprocess
import sys

import h5py

from harness import FOLDER, check, completed, finish, written

SIDE, PUSH, RADIUS, SHEAR = 0.04, 1e-5, 0.0006, 5000 / 2.9
CLOSED_FORM = 2 * math.pi * SHEAR * SIDE * PUSH / math.log(0.53935 * SIDE / RADIUS)
BLOCK = """SetFactory("OpenCASCADE");
Box(1) = {0, -0.02, -0.02, 0.04, 0.04, 0.04};
Mesh.CharacteristicLengthMin = %g;
Mesh.CharacteristicLengthMax = %g;
Physical Volume("gel") = {1};
Physical Surface("x0") = {1};
Physical Surface("x1") = {2};
Physical Surface("sides") = {3, 4, 5, 6};
"""


@functools.cache
def block(h):
    geometry = written(f"block_{h:g}.geo", BLOCK % (h, h))
    path = os.path.join(FOLDER, f"block_{h:g}.msh")
    subprocess.run(["gmsh", "-3", geometry, "-o", path], check=True, capture_output=True)
    return path


def force(mesh, element, across, corrected):
    start = SIDE - 0.1
    rows = [(0, start, 0.0003), (1, start + (0 if across else PUSH), 0.0003 + across * PUSH)]
    path = written("push.csv", "time,x,y,z\n" + "".join(
        f"{t},{x!r},{y!r},0.0002\n" for t, x, y in rows))
    folder = completed({
        "-mesh": mesh, "-analysis": "static", "-time_step": "1", "-time_end": "1",
        "-fix": "sides,x0:x,x1:x" if across else "sides,x0:yz,x1:yz", "-tissue_model": "linear",
        "-tissue_young": "5000", "-tissue_poisson": "0.45", "-tissue_element": element,
        "-needles": "n", "-needle_model": "rigid", "-needle_entry": "0,0.0003,0.0002",
        "-needle_direction": "1,0,0", "-needle_length": "0.1", "-needle_radius": repr(RADIUS),
        "-needle_inserted": repr(SIDE), "-needle_trajectory": path,
        "-insertion_friction_static": "1e6", "-insertion_friction_dynamic": "1e6",
        **({"-insertion_radius_correction": ""} if corrected else {}),
        "-quiet": ""})
    with h5py.File(os.path.join(folder, "run.h5")) as run:
        return run["history/needle/n/base_force"][-1, 1 if across else 0]


for element, sizes in (("p1", (0.0028, 0.002, 0.0016)), ("p1_anp", (0.0028, 0.002, 0.0016)),
                       ("p2", (0.005, 0.0035, 0.0025))):
    sizes = sizes if "--long" in sys.argv else sizes[:2]
    bare = force(block(sizes[0]), element, False, False) / CLOSED_FORM
    check(bare > 1.3, "a bare line is too stiff")
    axial = [force(block(h), element, False, True) / CLOSED_FORM for h in sizes]
    lateral = [force(block(h), element, True, True) for h in sizes]
    print(f"{element}, edges {', '.join(f'{1e3 * h:g}' for h in sizes)} mm: "
          f"{', '.join(f'{f:.4f}' for f in axial)} of the closed form (bare {bare:.2f}); across "
          f"{', '.join(f'{f:.4g}' for f in lateral)} N")
    for f in axial:
        check(abs(f - 1) < 0.02, f"the corrected force is {f:.4f}")
    mean = sum(lateral) / len(lateral)
    for f in lateral:
        check(abs(f / mean - 1) < 0.02, f"across, a mesh is {f / mean - 1:.1%} off the others")
finish()
