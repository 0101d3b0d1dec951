"""Meshes from outside: files that pose as one, elements listed twice, groups of one name, tets that overlap."""
import itertools
import os

import h5py
import numpy as np
from harness import FOLDER, check, check_refusals, completed, finish, refusal, run, written

SIZE = (4, 2, 2)  # cells of 1 cm
KUHN = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def block():
    """Nodes, tets and the triangles of the ends "x0" and "x1" of a bar along x."""
    nodes = {p: i + 1 for i, p in enumerate(itertools.product(*(range(n + 1) for n in SIZE)))}
    tets = []
    for cell in itertools.product(*map(range, SIZE)):
        corner = [nodes[tuple(c + (k >> a & 1) for a, c in enumerate(cell))] for k in range(8)]
        tets += [tuple(corner[k] for k in tet) for tet in KUHN]
    place = {i: p for p, i in nodes.items()}
    end = {}
    for name, x in (("x0", 0), ("x1", SIZE[0])):
        end[name] = [f for t in tets for f in itertools.combinations(t, 3)
                     if all(place[i][0] == x for i in f)]
    return {i: [0.01 * c for c in p] for i, p in place.items()}, tets, end


def file(name, edit=lambda mesh: None):
    """Writes the bar as MSH 2.2; `edit` changes its parts before."""
    nodes, tets, end = block()
    mesh = {"nodes": nodes, "tets": [(1, t) for t in tets],
            "faces": [(1, f) for f in end["x0"]] + [(2, f) for f in end["x1"]],
            "names": [(2, 1, "x0"), (2, 2, "x1"), (3, 1, "gel")]}
    edit(mesh)
    elements = [f"2 2 {g} {g} " + " ".join(map(str, f)) for g, f in mesh["faces"]]
    elements += [f"4 2 {g} {g} " + " ".join(map(str, t)) for g, t in mesh["tets"]]
    return written(name + ".msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"
                   + f"{len(mesh['names'])}\n" + "".join(f'{d} {t} "{n}"\n' for d, t, n in mesh["names"])
                   + f"$EndPhysicalNames\n$Nodes\n{len(mesh['nodes'])}\n"
                   + "".join(f"{i} {x} {y} {z}\n" for i, (x, y, z) in mesh["nodes"].items())
                   + f"$EndNodes\n$Elements\n{len(elements)}\n"
                   + "".join(f"{i + 1} {e}\n" for i, e in enumerate(elements)) + "$EndElements\n")


PULL = {"-fix": "x0", "-boundary_x1_traction": "100,0,0", "-analysis": "static", "-tissue_model": "linear",
        "-tissue_poisson": "0.3"}


def stretched(name, edit, settings=PULL, ranks=1):
    """Displacement of the bar with a changed file, and what was said of the mesh."""
    folder = os.path.join(FOLDER, "out_" + name)
    process = run({**settings, "-mesh": file(name, edit), "-output_dir": folder}, ranks)
    check(process.returncode == 0, f"{name}: {process.returncode} {process.stderr[-500:]}")
    with h5py.File(os.path.join(folder, "fields", "step_000000.h5")) as fields:
        u = fields["displacement"][...]
    return u, [line for line in process.stdout.splitlines() if "note: " in line]


refuse = refusal({**PULL, "-output_dir": os.path.join(FOLDER, "none")})


def refuses(what, words, edit, more={}):
    refuse(what, 65, words, {**more, "-mesh": file(what.replace(" ", "_"), edit)})


# What is listed twice, or belongs to two groups, loads once.
plain, said = stretched("plain", lambda mesh: None)
check(not said, f"a sound mesh has no notes {said}")


def same(what, words, edit, ranks=1):
    u, said = stretched(what.replace(" ", "_"), edit, ranks=ranks)
    equal = u.shape == plain.shape and np.abs(u - plain).max() < 1e-12 * np.abs(plain).max()
    check(equal and all(any(w in line for line in said) for w in words), f"{what} {said}")


same("every tet twice", ["96 tetrahedra are listed again"], lambda m: m["tets"].extend(list(m["tets"])))
same("every tet twice on 3 ranks", ["96 tetrahedra are listed again"],
     lambda m: m["tets"].extend(list(m["tets"])), ranks=3)
same("loaded triangles twice", ["'x1': 8 triangles are listed again"],
     lambda m: m["faces"].extend([f for f in m["faces"] if f[0] == 2]))


def two_groups(mesh):
    mesh["names"].append((2, 9, "also"))
    mesh["faces"] += [(9, f) for g, f in mesh["faces"] if g == 2]


same("an end in two groups", [], two_groups)


def halves(mesh):
    """The loaded end in two groups of one name."""
    end = [f for f in mesh["faces"] if f[0] == 2]
    mesh["names"].append((2, 9, "x1"))
    mesh["faces"] = [f for f in mesh["faces"] if f[0] == 1] + end[:3] + [(9, f) for _, f in end[3:]]


same("two groups of one name", ["surfaces 2 and 9 are both named 'x1'"], halves)


def loose(mesh):
    """A tet beside the bar in no physical volume."""
    mesh["nodes"].update({1001: [1, 0, 0], 1002: [2, 0, 0], 1003: [1, 1, 0], 1004: [1, 0, 1]})
    mesh["tets"].append((0, (1001, 1002, 1003, 1004)))


same("a tet in no volume", ["1 tetrahedra are in no physical volume"], loose)

# What is no body is refused with its tags.
refuses("a triangle that is no face", ["'x1'", "no face of a tetrahedron", "17"],
        lambda m: m["faces"].append((2, (1, 23, 45))))
refuses("a tet over others", ["overlap", "113"], lambda m: m["tets"].append((1, (1, 19, 7, 3))))
refuses("a tet in two volumes", ["two physical volumes", "'gel'", "'far'"],
        lambda m: (m["names"].append((3, 2, "far")), m["tets"].append((2, m["tets"][0][1]))))
refuses("ends that disagree on a node", ["disagree along x", "'x0'", "'all'"],
        lambda m: (m["names"].append((2, 9, "all")), m["faces"].extend([(9, f) for _, f in m["faces"]])),
        {"-boundary_all_displacement": "0.001,free,free"})

# Nothing in a file, or beside it, is run.
trap = os.path.join(FOLDER, "trap")
script = f'SystemCall "touch {trap}";\n'
for name, text in (("script.msh", script), ("box.geo", 'SetFactory("OpenCASCADE");\n' + script),
                   ("late.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + script)):
    refuse("a script as " + name, 65, [name], {"-mesh": written(name, text)})
with open(file("sound") + ".opt", "w") as stream:
    stream.write(script)
completed({**PULL, "-mesh": os.path.join(FOLDER, "sound.msh"), "-check": ""})
for name, path in (("a folder", FOLDER), ("a device", "/dev/zero")):
    refuse("a mesh that is " + name, 65, ["no file that can be read as a mesh"], {"-mesh": path})
gone = written("fifo", "")
os.remove(gone)
os.mkfifo(gone)
refuse("a mesh that is a pipe", 65, ["no file that can be read"], {"-mesh": gone})

check_refusals()
check(not os.path.exists(trap), "nothing was run")
finish()
