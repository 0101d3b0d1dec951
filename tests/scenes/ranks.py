"""The same histories and fields on 1, 2 and 3 ranks, to 1e-8 of each history's size."""
import os

import h5py
import numpy as np

from harness import (check, completed, finish, geometry, histories, options, small_block,
                     structured)

gel = options("gel_insertion.opts")
gel.update({"-time_end": "6", "-output_every": "50", "-output_fields": "displacement,velocity"})
ties = options("small_insertion.opts")
ties.update({"-mesh": small_block(), "-output_every": "50"})
# Nothing deforms without friction: the tip then stops exactly on faces and vertices.
exact = {**ties, "-insertion_friction_static": "0", "-insertion_friction_dynamic": "0",
         "-needle_velocity": "0.0125", "-time_step": "0.02", "-time_end": "3"}
plane = {**exact, "-needle_entry": "0,0.0123,0.02", "-insertion_merge": "0"}
iterative = {**ties, "-time_end": "1", "-tissue_ksp_type": "cg", "-tissue_pc_type": "bjacobi",
             "-tissue_ksp_rtol": "1e-13"}
contact = options("ball_on_block.opts")
contact.update({"-time_end": "1.2", "-time_step": "0.15"})
layers = options("layers.opts")
layers.update({"-time_end": "3", "-output_every": "50"})
steering = options("steering.opts")
steering.update({"-time_end": "2", "-output_every": "10"})

phantom = options("phantom.opts")
pulsing = options("pulsing_vessel.opts")
pulsing.update({"-time_end": "0.2"})
puncture = options("bladder_puncture.opts")
puncture.update({"-time_end": "5.4", "-time_step": "0.05", "-output_every": "50"})
frozen = {**puncture, "-cavity_model": "frozen", "-time_end": "2.5"}
for scene in (phantom, pulsing, puncture, frozen):
    scene["-mesh"] = geometry(os.path.splitext(os.path.basename(scene["-mesh"]))[0])

# What a step of turning tissue took, not what it found.
work = {"time_linearisations", "compliance/new_probes", "compliance/reused_probes", "compliance/passes",
        "compliance/factor_age", "constraint/iterations",
        "constraint/condition",  # of W with the factor at hand
        "constraint/contraction"}  # a ratio of two changes near round-off
# Five tets: some ranks have none.
tiny = options("small_insertion.opts")
tiny.update({"-mesh": structured("five_tets", *"--nodes 2 2 2 --size 0.06 0.04 0.04 --split 5".split()),
             "-tissue_model": "corotational", "-time_end": "1", "-output_every": "50"})
# Quadratic tets with shared dilatation reach over two rings of tets.
locked = {"-tissue_poisson": "0.499", "-output_fields": "displacement,nodal_stress"}
shared = {**phantom, **locked, "-tissue_element": "p1_anp", "-error_estimate": ""}
quadratic = {**ties, **locked, "-tissue_element": "p2_anp", "-tissue_model": "corotational",
             "-time_end": "0.6", "-time_scheme": "bdf2", "-needle_entry": "0,0.0193,0.0207"}
rubber = {**phantom, "-mesh": structured("hollow", *"--nodes 7 6 6 --size 0.06 0.05 0.05 --split 6 --volumes gel "
          "--sides probe,stage,bottom,top,front,back --ellipsoid 0.03 0.025 0.025 0.012 0.015 0.012".split()),
          "-tissue_model": "neo_hookean", "-tissue_element": "p2"}
tiny_rubber = {**tiny, "-tissue_model": "neo_hookean", "-gravity": "0,0,-9.81",
               "-time_newton_max": "10"}
# A path along mesh edges, in tissue that hardly changes its volume: lateral forces alternate, and the
# entry is through an edge of a curved surface.
edges = {"-mesh": small_block(), "-tissue_element": "p2", "-tissue_poisson": "0.499",
         "-tissue_young": "20000", "-analysis": "static", "-fix": "z0", "-time_step": "0.1",
         "-time_end": "0.8", "-boundary_z1_displacement": "-0.001,free,free", "-needles": "a,b",
         "-needle_a_entry": "0,0.02,0.02", "-needle_length": "0.1", "-needle_elements": "8",
         "-needle_b_entry": "0.0293,0.04,0.0171", "-needle_b_direction": "0,-1,0",
         "-needle_velocity": "0.06", "-needle_depth": "0.03", "-needle_hold": "0.1",
         "-needle_withdraw_velocity": "0.06", "-insertion_friction_static": "5",
         "-insertion_friction_dynamic": "0", "-constraint_direction_max": "3"}
# Along a line, at a slant, in and out; and along mesh edges, where rings end in tets of every rank.
line = {**ties, "-insertion_placement": "line", "-needle_model": "beam", "-needle_young": "1e10",
        "-needle_entry": "0,0.0173,0.0231", "-needle_direction": "1,0.1,-0.05", "-insertion_friction_viscous": "20",
        "-tissue_model": "corotational"}
line_ties = {**ties, "-insertion_placement": "line", "-tissue_element": "p2", "-time_end": "2"}
tight = options("tight.opts")
for name, settings, tolerance in [
    ("along edges", edges, 1e-8),
    # Its lateral rows have a condition of 7e6: that of rounding is 1e-9.
    ("along edges, tight", {**edges, **tight, "-time_end": "0.5"}, 1e-8),
    ("gel, tight", {**gel, **tight, "-time_end": "1.2"}, 1e-10),
    ("ties, tight", {**ties, **tight}, 1e-10),
    ("pulsing vessel, tight", {**pulsing, **tight}, 1e-10),
    ("contact of two bodies with friction", contact, 1e-8),
    ("five neo-Hookean tets", tiny_rubber, 1e-8),
    ("shared dilatation", shared, 1e-8), ("quadratic tets, BDF2", quadratic, 1e-8),
    ("neo-Hookean", rubber, 1e-8),
    ("five tets", tiny, 1e-8),
    # A hat that has just been born shares most of what it holds with its neighbour: their forces across are known
    # to 1e-11 N, the rounding of places over the least compliance, and the path keeps that.
    ("along a line", line, 1e-8), ("along a line of ties", line_ties, 2e-7),
    ("along a line, tight", {**line, **tight}, 1e-9),
    ("no ties (gel)", gel, 1e-8), ("ties", ties, 1e-8), ("tip exactly on vertices", exact, 1e-8),
    ("path in a face plane", plane, 1e-8), ("puncture in layers", layers, 1e-8),
    ("bevel", steering, 1e-8), ("iterative solver", iterative, 1e-6),
    ("phantom", phantom, 1e-9), ("pulsing vessel", pulsing, 1e-8), ("bladder puncture", puncture, 1e-8),
    ("bladder puncture, frozen", frozen, 1e-8)]:
    counts = (1, 2, 3, 4) if settings is phantom else (1, 2, 3)
    folders = [completed(settings, ranks) for ranks in counts]
    first = histories(folders[0])
    held = max(abs(first[key]).max() for key in first if key.startswith(("fix/", "boundary/")))
    for ranks, folder in zip(counts[1:], folders[1:]):
        other = histories(folder)
        check(first.keys() == other.keys(), f"{name}: same histories on {ranks} ranks")
        worst = ("", 0.0)
        for key, values in first.items():
            if key in work:  # a pass more or less, where round-off decides
                continue
            if key.endswith("volume_error"):  # round-off by nature as well
                check(other[key].max() <= 1e-12, f"{name}: volumes exact on {ranks} ranks")
                continue
            if key == "time_residual":  # of statics round-off as well
                off = abs(values - other[key])
                # What an iterated step leaves below its tolerance, 1e-6, is that of its factor. Round-off decides
                # whether a pass more is made, and with that when a lagged factor is made anew: in steps with
                # factors of different age both are to be within the tolerance.
                same = first["compliance/factor_age"] == other["compliance/factor_age"]
                below = (np.maximum(values, other[key]) <= 1e-6) & (first["time_linearisations"] > 1)
                good = (off <= max(1e-8, 1e-6 * values.max())) | (~same & below)
                check(good.all(), f"{name}: as balanced on {ranks} ranks")
                continue
            if key.endswith("residual"):  # round-off by nature; bounded by the tolerance instead
                check(other[key].max() <= 1e-9, f"{name}: residual <= 1e-9 m on {ranks} ranks")
                continue
            # 1e-6 of a newton, metre or joule stands in where a history is zero but for round-off.
            # A support that carries nothing has the round-off of those that do.
            size = max(abs(values).max(), held if key.startswith("fix/") else 0.0, 1e-6)
            difference = abs(values - other[key]).max() / size
            if difference > worst[1]:
                worst = (key, difference)
        check(worst[1] <= tolerance, f"{name}: {ranks} ranks differ by {worst[1]:.1e} ({worst[0]})")
        steps = sorted(os.listdir(os.path.join(folders[0], "fields")))
        check(steps == sorted(os.listdir(os.path.join(folder, "fields"))), f"{name}: same files")
        with h5py.File(os.path.join(folders[0], "fields", steps[-2])) as a, \
                h5py.File(os.path.join(folder, "fields", steps[-2])) as b:
            u, v = a["displacement"][...], b["displacement"][...]
            check(abs(u - v).max() <= tolerance * max(abs(u).max(), 1e-6), f"{name}: same displacement")
            check(list(a) == list(b), f"{name}: same datasets")
            if "coupling" in a:
                check(np.array_equal(a["coupling/id"], b["coupling/id"]), f"{name}: same points")
    if name == "tip exactly on vertices":
        depth = first["needle/needle/depth"]
        points = first["needle/needle/points"]
        # 0.25 mm steps: at 10, 20 and 30 mm the tip is on a vertex, and its point is there.
        for millimetres in (10, 20, 30):
            step = int(np.argmin(abs(depth - 1e-3 * millimetres)))
            check(points[step] == millimetres // 10 + 1, f"{name}: {millimetres} mm counts its vertex")
finish()
