"""What a tip meets: curved walls and thresholds of surfaces and volumes, interfaces of tissues that
are cut, thin walls and voids within one step, and a first tet that alone holds the needle.
"""
import os
import subprocess

import numpy as np

from harness import FOLDER, MESHES, ROOT, check, completed, finish, histories, options, run, structured

# A bladder with straight and with curved walls is pierced at its threshold, in the same step but two.
pierced = {}
for order in (1, 2):
    mesh = os.path.join(MESHES, f"bladder_{order}.msh")
    subprocess.run(["gmsh", "-3", "-order", str(order), os.path.join(ROOT, "meshes", "bladder.geo"), "-o", mesh],
                   check=True, stdout=subprocess.DEVNULL)
    scene = {**options("bladder_puncture.opts"), "-mesh": mesh, "-tissue_element": "p2", "-time_end": "3.2", "-time_step": "0.04",
             "-output_fields": '""', "-insertion_puncture_force": "0",
             "-insertion_entry_puncture_force": "0.6", "-insertion_bladder_puncture_force": "0.6"}
    h = histories(completed(scene))
    name = next(key for key in h if key.endswith("punctures")).rsplit("/", 1)[0]
    at = np.flatnonzero(np.diff(h[name + "/punctures"]))
    force = h[name + "/tip_force"][at + 1]
    pierced[order] = h["time"][at + 1], force
    check(len(at) == 2 and abs(force - 0.6).max() < 0.01 * 0.6,
          f"order {order}: skin and bladder pierced at {h['time'][at + 1]} s, at {force} N")
check(abs(pierced[1][0] - pierced[2][0]).max() < 0.15, "and at the same time")

# A surface that no threshold was named for takes that of the volume behind it.
block = {"-mesh": structured("block", *"--nodes 7 5 5 --size 0.06 0.04 0.04 --split 5".split()),
         "-analysis": "static", "-fix": "z0", "-tissue_young": "20000", "-needles": "n",
         "-needle_entry": "0,0.0193,0.0171", "-needle_velocity": "0.02", "-needle_depth": "0.03",
         "-time_step": "0.05", "-time_end": "1.5"}
for named, asked in (({"-insertion_puncture_force": "0.05", "-insertion_beam_puncture_force": "0.2"}, 0.2),
                     ({"-insertion_puncture_force": "0.2"}, 0.2),
                     ({"-insertion_beam_puncture_force": "0.2", "-insertion_x0_puncture_force": "0.1"}, 0.1)):
    h = histories(completed({**block, **named}))
    most = h["needle/n/tip_force"].max()
    check(0.85 * asked < most <= asked * (1 + 1e-9), f"{named}: pierced at {most:.3f} N of {asked}")
told = run({**block, "-insertion_cutting_force": "0.05", "-insertion_tip_radius": "0.001",
            "-output_dir": os.path.join(FOLDER, "told")})
check(told.stdout.count("not within -insertion_tip_radius") == 1, "a support that cannot be so small is told of")

# From a tissue that is cut with more force into one that takes less: the tip goes on without falling
# back, and the change of force is that of the laws, the more so the shorter the steps.
two = {**block, "-mesh": structured("two", *("--nodes 9 7 7 --size 0.06 0.04 0.04 --split 6 "
                                             "--volumes a,b").split()),
       "-insertion_a_cutting_force": "0.5", "-insertion_b_cutting_force": "0.1",
       "-insertion_b_puncture_force": "0.2", "-needle_depth": "0.045", "-time_end": "2.3",
       "-insertion_friction_static": "4", "-insertion_friction_dynamic": "4"}
for model in ("linear", "corotational"):
    drops = []
    for step in (0.05, 0.025):
        h = histories(completed({**two, "-tissue_model": model, "-time_step": repr(step)}))
        depth, tip, base = (h["needle/n/" + key] for key in ("depth", "tip_force", "base_force"))
        moving = h["time"] < 0.045 / 0.02
        fell = np.diff(depth)[moving[1:]].min()
        check(fell > -1e-9, f"{model}, h {step}: depth never falls while the base advances ({fell:.1e} m)")
        k = np.flatnonzero((depth > 0.02) & (tip < 0.45))[0]  # the first step beyond the first tissue
        check(tip[k] > 0.09, f"{model}, h {step}: no step without force on the tip ({tip[k]:.3f} N)")
        lowest, drop = tip[(depth > 0.02) & moving].min(), base[k - 1][0] - base[k][0]
        drops.append(drop)
        check(lowest > 0.099, f"{model}, h {step}: nor later ({lowest:.3f} N)")
    off = [abs(drop - 0.3) for drop in drops]
    check(off[0] < 0.02 and off[1] < 0.7 * off[0], f"{model}: base force falls by {drops} N, the laws by 0.3")

# A needle that ends inside its first tet: turned about its entry by its base it is held as one that
# has more points, and does not turn freely. The coarse mesh is stiffer, as it is for many points.
lateral = {}
for cells, name in ((3, "coarse"), (9, "fine")):
    mesh = structured(name, *f"--nodes {cells + 1} {cells + 1} {cells + 1} --size 0.09 0.09 0.09 --split 6".split())
    for placement in ("crossings", "spacing"):
        path = os.path.join(FOLDER, "aside.csv")
        with open(path, "w") as stream:
            stream.write("time,x,y,z\n0,-0.08,0.041,0.047\n1,-0.08,0.043,0.047\n")
        scene = {"-mesh": mesh, "-analysis": "static", "-fix": "z0", "-tissue_young": "20000", "-needles": "n",
                 "-needle_model": "rigid", "-needle_entry": "0,0.041,0.047", "-needle_length": "0.1",
                 "-needle_inserted": "0.02", "-needle_trajectory": path, "-time_step": "1", "-time_end": "1",
                 "-insertion_placement": placement, "-insertion_spacing": "0.004", "-tissue_model": "linear"}
        h = histories(completed(scene))
        lateral[name, placement] = abs(h["needle/n/base_force"][-1][1]), abs(h["needle/n/base_moment"][-1][2])
for name in ("coarse", "fine"):
    (few, turn), (many, turn_many) = lateral[name, "crossings"], lateral[name, "spacing"]
    check(0.7 < few / many < 1.4 and 0.7 < turn / turn_many < 1.4,
          f"{name}: {few:.3f} N with few points, {many:.3f} N with many; {turn:.4f} and {turn_many:.4f} N m")

# A cavity in stiff tissue, gone through with steps of half its width, with and without cutting: the
# channel's length in tissue is what the tip has passed of it.
hollow = {**block, "-mesh": structured("hollow", *("--nodes 7 7 7 --size 0.04 0.04 0.04 --split 6 --ellipsoid "
                                                   "0.02 0.02 0.02 0.008 0.008 0.008").split()),
          "-tissue_young": "1e7", "-needle_model": "rigid", "-needle_length": "0.2", "-needle_entry": "0,0.0193,0.0188",
          "-needle_velocity": "0.06", "-needle_depth": "0.039", "-time_end": "0.7"}
depth = {}
for step, cutting, model in ((0.15, 0.005, "linear"), (0.1, 0.005, "linear"), (0.1, 0.005, "corotational"),
                             (0.02, 0.005, "linear"), (0.1, 0.0, "linear"), (0.15, 0.0, "corotational")):
    h = histories(completed({**hollow, "-time_step": repr(step), "-tissue_model": model,
                             "-insertion_cutting_force": repr(cutting)}))
    depth[step, cutting, model] = h["needle/n/depth"][-1]
values = np.array(list(depth.values()))
check(values.max() - values.min() < 2e-5, f"through a void by steps of any length: {values.min():.5f} to {values.max():.5f} m")

# A needle as long as it is deep stands in the tissue up to its base, which is outside; drawn aside
# along the surface as well. A millimetre deeper it is in.
aside = os.path.join(FOLDER, "up_to_the_base.csv")
with open(aside, "w") as stream:
    stream.write("time,x,y,z\n0,0,0.0193,0.0171\n1,0,0.0203,0.0171\n")
stands = {"-mesh": block["-mesh"], "-fix": "z0", "-analysis": "static", "-needles": "n", "-needle_model": "rigid",
          "-needle_entry": "0,0.0193,0.0171", "-needle_length": "0.03", "-needle_inserted": "0.03",
          "-time_step": "0.5", "-time_end": "1", "-output_dir": os.path.join(FOLDER, "stands")}
for name, more in (("rigid", {}), ("beam", {"-needle_model": "beam"}), ("drawn aside", {"-needle_trajectory": aside})):
    done = run({**stands, **more})
    check(done.returncode == 0, f"in up to its base, {name}: {done.stderr[-200:]}")
check(run({**stands, "-needle_inserted": "0.031"}).returncode == 65, "not deeper than its length")
finish()
