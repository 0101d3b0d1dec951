"""Same displacements as CalculiX (ccx) on the same mesh, with its elements C3D4 and C3D10.

ccx prints seven digits of a displacement but fourteen of its stiffness and mass matrices
(*FREQUENCY, SOLVER=MATRIXSTORAGE). So there are two comparisons: with NumPy's solution of ccx's
stiffness, gravity being ccx's mass times g, to 1e-10; and with what ccx itself solves and prints,
to its digits.
Exit code 77 when there is no ccx.
"""
import os
import shutil
import subprocess

import numpy as np

from harness import FOLDER, check, finish, written
from tet_book import (DENSITY, GRAVITY, POISSON, YOUNG, difference, solution, solved,
                      traction_loads, weights)

CASES = [("p1", 1, "top"), ("p2", 1, "top"), ("p2", 2, "top"), ("p2", 2, "skin")]
MATRICES = "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n1\n*END STEP\n"


def mesh_deck(body):
    """Nodes, elements and materials; ccx has the nodes of C3D10 in VTK's order."""
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{n + 1}, " + ", ".join(f"{c:.13e}" for c in x) for n, x in enumerate(body.x)]
    kind = f"C3D{body.tets.shape[1]}"
    for region in (0, 1):
        lines.append(f"*ELEMENT, TYPE={kind}, ELSET=E{region}")
        lines += [", ".join(str(n) for n in (e + 1, *(tet + 1)))
                  for e, tet in enumerate(body.tets) if body.region[e] == region]
        lines += [f"*MATERIAL, NAME=M{region}", "*ELASTIC", f"{YOUNG[region]}, {POISSON[region]}",
                  "*DENSITY", f"{DENSITY[region]}",
                  f"*SOLID SECTION, ELSET=E{region}, MATERIAL=M{region}"]
    return "\n".join(lines) + "\n"


def static_step(body, loads, gravity):
    """The bottom held, nodal loads and, if asked for, ccx's own gravity."""
    lines = ["*BOUNDARY"] + [f"{n + 1}, 1, 3" for n in body.held] + ["*STEP", "*STATIC", "*CLOAD"]
    lines += [f"{n + 1}, {k + 1}, {f:.13e}" for n, row in enumerate(loads.reshape(-1, 3))
              for k, f in enumerate(row) if f != 0.0]
    if gravity:
        g = np.linalg.norm(GRAVITY)
        along = ", ".join(f"{c:.13e}" for c in GRAVITY / g)
        lines += ["*DLOAD"] + [f"E{region}, GRAV, {g:.13e}, {along}" for region in (0, 1)]
    return "\n".join(lines + ["*NODE PRINT, NSET=ALL", "U", "*END STEP"]) + "\n"


def launch(name, deck):
    written(name + ".inp", deck)
    process = subprocess.run(["ccx", name], cwd=FOLDER, capture_output=True, text=True, timeout=900)
    if process.returncode != 0:
        print(process.stdout[-2000:])
        raise SystemExit(f"ccx failed with {process.returncode}")


def matrix(name, suffix):
    """A symmetric matrix that ccx stored by its lower triangle, in the order of nodes and axes."""
    with open(os.path.join(FOLDER, f"{name}.dof")) as stream:
        places = [3 * int(node) - 4 + int(axis) for node, axis in
                  (line.strip().split(".") for line in stream)]
    rows, columns, values = np.loadtxt(os.path.join(FOLDER, f"{name}.{suffix}"), unpack=True)
    rows, columns = (np.array(places)[index.astype(int) - 1] for index in (rows, columns))
    full = np.zeros((len(places), len(places)))
    full[rows, columns] = full[columns, rows] = values
    return full


def printed(name, count):
    """Displacements of the .dat file."""
    u = np.full((count, 3), np.nan)
    with open(os.path.join(FOLDER, f"{name}.dat")) as stream:
        for line in stream:
            words = line.split()
            if len(words) == 4 and words[0].isdigit():
                u[int(words[0]) - 1] = [float(word) for word in words[1:]]
    return u


def compare(element, order, surface):
    body = solved(element, order, surface)
    title = f"{element} on a mesh of order {order}, load on the {surface}: "
    # Faces on the skin are curved, their area is no polynomial: the program's rule leaves 1e-8.
    curved = order == 2 and surface == "skin"
    traction, weight = traction_loads(body, surface), weights(body)
    launch("matrices", mesh_deck(body) + MATRICES)
    # On curved tets ccx integrates the mass by four points only, which is not exact.
    own = order == 1
    if own:
        weight = matrix("matrices", "mas") @ np.tile(GRAVITY, len(body.x))
    off = difference(body.u, solution(body, matrix("matrices", "sti"), traction + weight))
    whose = "its" if own else "our"
    check(off < (1e-6 if curved else 1e-10),
          f"{title}ccx's stiffness and {whose} weight, differs by {off:.1e}")
    loads = traction if own else traction + weight
    launch("static", mesh_deck(body) + static_step(body, loads, own))
    off = difference(body.u, printed("static", len(body.x)))
    check(off < 1e-6, f"{title}ccx's solution with {whose} weight, differs by {off:.1e}")


if not shutil.which("ccx"):
    print("skipped: CalculiX (ccx) is not installed")
    shutil.rmtree(FOLDER, ignore_errors=True)
    raise SystemExit(77)
for case in CASES:
    compare(*case)
finish()
