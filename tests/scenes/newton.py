"""Newton's method with a needle's rows, far beyond small strains: a rigid needle through a block of
neo-Hookean gel is pushed sideways. Nothing slides, so that the answer does not depend on the path:
one step must find what ten find, and with a line search it gets along with few linearisations.
"""
import os

import h5py

from harness import check, completed, finish, histories, ledger, small_block, structured, written


def pushed(element, y, z, steps, ranks=1):
    path = written(f"push_{y}_{z}.csv", f"time,x,y,z\n0,-0.03,0.0193,0.0207\n1,-0.03,{y},{z}\n")
    folder = completed({
        "-mesh": small_block(), "-fix": "z0", "-analysis": "static", "-time_end": "1",
        "-time_step": repr(1 / steps), "-tissue_model": "neo_hookean", "-tissue_element": element,
        "-tissue_young": "5000", "-tissue_poisson": "0.4", "-needles": "n",
        "-needle_model": "rigid", "-needle_entry": "0,0.0193,0.0207", "-needle_direction": "1,0,0",
        "-needle_length": "0.1", "-needle_radius": "0.0005", "-needle_inserted": "0.07",
        "-needle_trajectory": path}, ranks)
    with h5py.File(os.path.join(folder, "run.h5")) as run:
        return run["history/needle/n/base_force"][-1], ledger(folder)


# Pushed by 25 mm through a block of 40 mm; and down to 5 mm above the plate it is held by.
for element, y, z, most in (("p2", 0.044, 0.038, 12), ("p1", 0.0193, 0.0047, 15)):
    (one, work), (ten, of_ten) = pushed(element, y, z, 1), pushed(element, y, z, 10)
    off = abs(one - ten).max() / abs(ten).max()
    check(off < 1e-6, f"{element}, to y {y} z {z}: one step and ten differ by {off:.1e}")
    check(work["assemblies"] <= most and of_ten["assemblies"] <= 75
          and work["rejected_steps"] == 0,
          f"in {work['assemblies']} and {of_ten['assemblies']} linearisations, "
          f"{work['rejected_steps']} and {of_ten['rejected_steps']} steps halved")
    many, _ = pushed(element, y, z, 1, 3)
    off = abs(one - many).max() / abs(one).max()
    check(off < 1e-6, f"three ranks differ by {off:.1e}")
# A slender column shortened so fast that a whole step meets tangents that are not definite: those
# steps are halved, whether a factor finds it out or conjugate gradients do.
column = {"-mesh": structured("column", *"--nodes 13 3 3 --size 0.12 0.01 0.01 --split 6".split()),
          "-fix": "x0", "-boundary_x1_displacement": "-0.02,0,0",
          "-boundary_x1_curve": written("ramp.csv", "time,factor\n0,0\n3,1\n"),
          "-time_initial": "unstressed", "-time_step": "0.5", "-time_end": "3",
          "-time_newton_max": "20", "-tissue_tangent": "exact", "-tissue_element": "p2",
          "-tissue_young": "15000", "-tissue_poisson": "0.4", "-tissue_density": "1000"}
gradients = {"-tissue_ksp_type": "cg", "-tissue_pc_type": "jacobi"}
one, two = completed(column), completed({**column, **gradients}, 2)
check(min(ledger(folder)["rejected_steps"] for folder in (one, two)) > 5,
      f"the column's steps are halved: {[ledger(f)['rejected_steps'] for f in (one, two)]}")
one, two = histories(one), histories(two)
force = next(name for name in one if "force" in name)
off = abs(one[force][-1] - two[force][-1]).max() / abs(one[force]).max()
check(off < 1e-6, f"{force} by conjugate gradients on two ranks differs by {off:.1e}")
finish()
