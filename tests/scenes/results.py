"""What a run leaves behind: units, provenance, shapes, order, XDMF that points at real data."""
import os
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np

from harness import (check, completed, finish, geometry, options, small_block, structured,
                     written)
from harness import run as launch

settings = options("small_insertion.opts")
settings.update({"-mesh": small_block(), "-time_end": "1", "-output_every": "10",
                 "-output_fields": "displacement,velocity"})
folder = completed(settings, 2)


def without_units(path):
    missing = []
    with h5py.File(path) as file:
        def look(name, node):
            if isinstance(node, h5py.Dataset) and "units" not in node.attrs:
                missing.append(name)
        file.visititems(look)
    return missing


with h5py.File(os.path.join(folder, "run.h5")) as run:
    rows = len(run["history/time"])
    check(rows == 51, "one history row per step and one for the start")
    check(np.allclose(run["history/time"], 0.02 * np.arange(51), atol=1e-12), "times are n h")
    needle = run["history/needle/needle"]
    for name, shape in [("tip", (rows, 3)), ("depth", (rows,)), ("travel", (rows,)), ("base_force", (rows, 3)),
                        ("base_moment", (rows, 3)), ("shaft_friction", (rows,)),
                        ("tip_force", (rows,))]:
        check(needle[name].shape == shape, f"needle/{name} has shape {shape}")
    for name in ("constraint/rows", "constraint/rank", "constraint/iterations",
                 "constraint/residual", "compliance/probes", "compliance/new_probes",
                 "compliance/reused_probes", "compliance/build_seconds", "step_seconds"):
        check(run["history/" + name].shape == (rows,), f"{name} has a row per step")
    check(np.allclose(needle["tip"][:, 0], np.minimum(0.02 * run["history/time"][:], 0.03)),
          "the rigid tip is where the base put it")
    check(np.allclose(needle["travel"], needle["tip"][:, 0], atol=1e-14), "and so is the travel of the base")
    check(run["history/fix/z0/force"].shape == (rows, 3), "the support has its force")
    check(np.allclose(needle["base_force"][:, 0], needle["shaft_friction"][:], atol=1e-12),
          "a straight rigid needle: axial base force = shaft friction")
    depth = needle["depth"][:]
    x, tets = run["mesh/coordinates"][:], run["mesh/tets"][:]
    check(x.shape == (175, 3) and tets.max() == 174, "the whole mesh is there")
    check(np.all(np.diff(run["mesh/node_tag"][:]) > 0), "nodes by ascending tag")
    edges = x[tets[:, 1:]] - x[tets[:, :1]]
    check(np.isclose(np.linalg.det(edges).sum() / 6, 0.06 * 0.04 * 0.04), "and has its volume")
    p = run["provenance"]
    names = [n.decode() for n in p["options/name"]]
    values = [v.decode() for v in p["options/value"]]
    sources = [s.decode() for s in p["options/source"]]
    at = names.index("needle_needle_velocity")
    check(values[at] == "0.02" and sources[at] == "command line", "resolved options with sources")
    at = names.index("constraint_solver")
    check(values[at] == "auto" and sources[at] == "default", "defaults are recorded as such")
    for name in ("git_commit", "petsc_version", "hdf5_version", "mesh_hash_fnv1a",
                 "command_line", "mpi_ranks"):
        check(len(p[name][0]) > 0, f"provenance/{name}")
    check(all("units" in d.attrs for d in p.values() if isinstance(d, h5py.Dataset)), "units there")
check(without_units(os.path.join(folder, "run.h5")) == [], "every dataset of run.h5 has units")

steps = sorted(os.listdir(os.path.join(folder, "fields")))
check(steps == [f"step_{n:06d}.h5" for n in range(0, 51, 10)], f"field files {steps}")
for step in steps:
    path = os.path.join(folder, "fields", step)
    check(without_units(path) == [], f"every dataset of {step} has units")
    with h5py.File(path) as file:
        check(file["displacement"].shape == (175, 3), f"{step}: displacement")
        if step != steps[0]:
            count = len(file["coupling/id"])
            for name, columns in [("position", 3), ("lambda", 3), ("state", 0), ("tributary", 0)]:
                shape = (count, columns) if columns else (count,)
                check(file["coupling/" + name].shape == shape, f"{step}: coupling/{name}")
            check(np.isclose(file["coupling/tributary"][:].sum(),
                             depth[int(step[5:11])]), f"{step}: tributary lengths add to the depth")

root = ElementTree.parse(os.path.join(folder, "run.xdmf")).getroot()
items = list(root.iter("DataItem"))
check(len(list(root.iter("Time"))) == 2 * len(steps), "run.xdmf has every step, of tissue and needle")
check([grid.get("Name") for grid in root.find("Domain")] == ["tissue", "needle_needle"],
      "run.xdmf: the tissue and the needle, each over time")
for item in items:
    shape = tuple(int(n) for n in item.get("Dimensions").split())
    if item.get("Format") == "XML":
        check(item.text.split() == [str(k) for k in range(np.prod(shape))], "a polyline takes its points in order")
        continue
    file, dataset = item.text.split(":")
    with h5py.File(os.path.join(folder, file)) as target:
        if target[dataset].shape != shape:
            check(False, f"run.xdmf: {item.text} has shape {target[dataset].shape}, not {shape}")
check(len(items) == (5 + 3) * len(steps),
      "run.xdmf: mesh, region, displacement, velocity, and of the needle order, axis, radius per step")
with h5py.File(os.path.join(folder, "fields", steps[-1])) as file:
    axis, radius = file["needle/needle/axis"][:], file["needle/needle/radius"][:]
    check(np.allclose(radius, 0.0005) and len(radius) == len(axis) == 21, "the needle has its radius at every node")
    check(np.isclose(np.linalg.norm(axis[-1] - axis[0]), 0.08), "and its length")

# Stress on request: shapes, places in ParaView's file, energy against the work of the plate.
phantom = options("phantom.opts")
phantom["-mesh"] = geometry("phantom")
every = ["stress", "von_mises", "principal_stress", "strain_energy", "nodal_stress"]
folder = completed({**phantom, "-output_fields": ",".join(every)}, 2)
with h5py.File(os.path.join(folder, "run.h5")) as r, \
        h5py.File(os.path.join(folder, "fields", "step_000003.h5")) as step:
    x, tets = r["mesh/coordinates"][:], r["mesh/tets"][:]
    a, b, c, d = (x[tets[:, k]] for k in range(4))
    volume = abs(np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a))) / 6
    shapes = [(len(tets), 6), (len(tets),), (len(tets), 3), (len(tets),), (len(x), 6)]
    check([step[name].shape for name in every] == shapes, "stress fields have their shapes")
    check("displacement" not in step, "and only what is asked for is written")
    force = r["history/boundary/stage/force"][:, 0]
    work = -0.003 * (0.5 * (force[1:] + force[:-1])).sum()
    energy = (volume * step["strain_energy"][:]).sum()
    check(abs(energy - work) < 1e-3 * work, f"strain energy is the plate's work ({energy:.5f} J)")
    check(int(r["ledger"].attrs["stress_evaluations"]) == 4, "one evaluation per field file")
with open(os.path.join(folder, "run.xdmf")) as stream:
    text = stream.read()
check(text.count('Center="Cell"') == 4 * (1 + 4) and 'Name="nodal_stress" AttributeType="Matrix" Center="Node"' in text,
      "ParaView's file names them by tet and by node")

# Two files: rows by file, names of the files, and the same result in each of two equal blocks.
with open(small_block(), encoding="latin-1") as stream:
    text = stream.read()
for group in ("x0", "x1", "y0", "y1", "z0", "z1", "beam"):
    text = text.replace(f'"{group}"', f'"other_{group}"')
first, second = small_block(), written("other.msh", text)
two = {"-mesh": f"{first},{second}", "-analysis": "static", "-fix": "z0,other_z0", "-gravity": "1,2,-9.81"}
folder = completed(two, 2)
with h5py.File(os.path.join(folder, "run.h5")) as r, \
        h5py.File(os.path.join(folder, "fields", "step_000000.h5")) as step:
    u, half = step["displacement"][:], len(r["mesh/coordinates"]) // 2
    check(abs(u).max() > 1e-5 and abs(u[:half] - u[half:]).max() < 1e-12 * abs(u).max() + 1e-15,
          "blocks of two files sag alike")
    check([name.decode() for name in r["mesh/file"][:]] == [first, second]
          and [name.decode() for name in r["mesh/volumes"][:]] == ["beam", "other_beam"],
          "volumes know their files")

# Contact on request: at the slave's corners, what the histories count.
ball = options("ball_on_block.opts")
ball.update({"-mesh": geometry("ball_on_block"), "-time_end": "0.6", "-output_every": "4",
             "-output_fields": "contact"})
folder = completed(ball, 2)
with h5py.File(os.path.join(folder, "run.h5")) as r, \
        h5py.File(os.path.join(folder, "fields", "step_000012.h5")) as step:
    now, history = step["contact/contact"], r["history/contact/contact"]
    state, pressure, gap = now["state"][:], now["pressure"][:], now["gap"][:]
    check((state == 2).sum() == history["sticking"][-1] > 3 and (state == 1).sum() == history["slipping"][-1],
          "corners stick and slip as the histories say")
    check(np.array_equal(pressure > 0, state > 0) and abs(gap[state > 0]).max() < 1e-8 and (gap[state == 0] > 0).all(),
          "pressure where they touch, a gap where they do not")
    pull = now["traction"][:]
    check(np.allclose(np.linalg.norm(pull, axis=1)[state == 0], 0) and pull[state > 0, 2].min() > 0,
          "tractions push the ball up")
    check(0 < history["largest_penetration"][-1] < 2e-4, "points between corners go in by less than 0.2 mm")

# The error estimate: falls with the edges, parts add to one, nothing without it.
estimates = []
for n in ("5", "9"):
    cube = options("compression_test.opts")
    cube.update({"-mesh": structured("cube_" + n, *f"--nodes {n} {n} {n} --size 0.04 0.04 0.04 --split 5".split()),
                 "-fix": "z0", "-boundary_z1_displacement": "0,0,-0.002", "-tissue_poisson": "0.3",
                 "-error_target": "0.01"})
    with h5py.File(os.path.join(completed(cube, 2), "run.h5")) as r:
        estimates.append(float(r["error_estimate/relative"][0]))
        check(abs(r["error_estimate/part"][:].sum() - 1.0) < 1e-12, "parts of the error add to one")
check(1.2 < estimates[0] / estimates[1] < 2.2, f"the estimate falls with the edges {estimates}")
said = launch({**cube, "-output_dir": os.path.join(folder, "said")}).stdout
check("times shorter" in said and "estimated error" in said, "the log says how far off the run is")
# The locking gauge: 1 of what it compares with, more of linear tets, equal on 2 ranks.
hollow = options("phantom.opts")
hollow.update({"-mesh": structured("hollow", *"--nodes 7 6 6 --size 0.06 0.05 0.05 --split 6 --volumes gel "
               "--sides probe,stage,bottom,top,front,back --ellipsoid 0.03 0.025 0.025 0.012 0.015 0.012".split()),
               "-time_end": "1", "-locking_gauge": ""})
gauge = {}
for element, ranks in (("p1", 1), ("p1", 2), ("p2_bbar", 1)):
    with h5py.File(os.path.join(completed({**hollow, "-tissue_element": element}, ranks), "run.h5")) as run:
        gauge[element, ranks] = run["locking_gauge/ratio"][0]
        check(run["ledger"].attrs["factorisations"] == 1, "the gauge's factors are not the run's")
check(gauge["p1", 1] > 1.5, f"linear tets lock: {gauge['p1', 1]:.2f}")
check(abs(gauge["p1", 2] / gauge["p1", 1] - 1) < 1e-9, "the same gauge on 2 ranks")
check(abs(gauge["p2_bbar", 1] - 1) < 1e-9, f"p2_bbar is what it is compared with: {gauge['p2_bbar', 1]:.12f}")

# Quadratic tets: ten nodes each, in ParaView's order, with the middles of a straight mesh in the middle.
curved = completed({**settings, "-tissue_element": "p2", "-time_end": "0.02"})
with h5py.File(os.path.join(curved, "run.h5")) as run:
    x, tets = run["mesh/coordinates"][:], run["mesh/tets"][:]
check(tets.shape[1] == 10, "ten nodes in a quadratic tet")
ends = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
check(all(np.allclose(x[tets[:, 4 + k]], 0.5 * (x[tets[:, a]] + x[tets[:, b]]))
          for k, (a, b) in enumerate(ends)), "middles of edges 01 12 20 03 13 23")
with open(os.path.join(curved, "run.xdmf")) as stream:
    check('TopologyType="Tetrahedron_10"' in stream.read(), "run.xdmf says Tetrahedron_10")
finish()
