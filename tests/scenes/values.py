"""Values that other programs computed on the very meshes of tests/data/values: DOLFINx 0.5 (tissue
of large strains, follower cavities), programs in NumPy written for it (corotational beam, needle)
and CVXOPT (friction). Values are met to the digits given here. Last, a law that needs no program:
cavities that are joined keep what is in them.
"""
import os

import h5py
import numpy as np

from harness import ROOT, check, completed, finish, histories, written

DATA = os.path.join(ROOT, "tests", "data", "values")


def results(what, mesh, settings, ranks=1):
    """Folder and histories of a run on a mesh of tests/data/values."""
    try:
        folder = completed({"-mesh": os.path.join(DATA, mesh + ".msh"), **settings}, ranks)
    except SystemExit as end:
        raise SystemExit(f"FAILED  {what}: {end}") from None
    return folder, histories(folder)


def compare(what, found, expected, tolerance):
    """Difference as a part of the largest component expected."""
    found, expected = np.asarray(found), np.asarray(expected)
    off = abs(found - expected).max() / abs(expected).max()
    shown = [", ".join(f"{value:.10g}" for value in values) for values in (found, expected)]
    check(off < tolerance, f"{what} is {shown[0]}, expected {shown[1]}: {off:.1e} apart")


# Force on the drawn face [N], by element, Poisson's ratio and numbers of ranks: DOLFINx, Newton's
# method to 1e-13.
PULLED = [
    ("p1", 0.3, (1,), (745.23843114, -24.6122732, 363.70651181)),
    ("p1", 0.45, (1,), (843.23133471, -28.24992687, 363.35741656)),
    ("p2", 0.3, (1, 2), (721.33858477, -28.61297737, 352.05943774)),
    ("p2", 0.45, (1,), (715.56904545, -33.99152179, 344.66143906)),
    ("p2_bbar", 0.45, (1, 3), (707.68328822, -35.04041898, 342.07924374)),
    ("p2_bbar", 0.4999, (1,), (710.50174332, -36.48603584, 340.26328366)),
]


def pulled_block():
    """A neo-Hookean block drawn by a third of its length and aside, with a load on its top."""
    for element, poisson, ranks, force in PULLED:
        for count in ranks:
            what = f"neo-Hookean block of {element}, nu {poisson}, on {count} ranks"
            _, found = results(what, "pulled_block", {
                "-analysis": "static", "-tissue_model": "neo_hookean", "-tissue_young": "5000",
                "-tissue_element": element, "-tissue_poisson": repr(poisson), "-fix": "x0",
                "-boundary_x1_displacement": "0.35,0.12,0.25",
                "-boundary_z1_traction": "0,300,-450"}, count)
            compare(what + ": force", found["boundary/x1/force"][-1], force, 1e-8)


# The void's volume at rest [m^3]; and by the fluid's law its pressure [Pa], its volume [m^3] and
# the force on the top, pressed down and aside [N] (None: the top is free): DOLFINx, by Newton's
# method bordered with the pressure.
VOID = 7.929016675309664e-06
HOLLOW = [
    ({"law": "pressure", "pressure": "900"}, 900, 1.01130691e-05, None),
    ({"law": "pressure", "pressure": "-700"}, -700, 6.821401633e-06, None),
    ({"law": "constant_volume"}, 847.2244885, VOID,
     (0.268918051, -0.000387388723, -2.85072026)),
    ({"law": "constant_volume", "volume": repr(1.25 * VOID)}, 1671.478404, 9.911270844e-06,
     (0.269325389, -0.0013472247, -3.08554959)),
    ({"law": "bulk", "bulk_modulus": "4000"}, 401.6224664, 7.171561482e-06,
     (0.267947175, -0.000100518855, -2.75312897)),
    ({"law": "gas", "ambient_pressure": "5000"}, 459.6568474, 7.261460653e-06,
     (0.26809959, -0.00013191735, -2.76500299)),
]


def hollow_block():
    """A follower cavity in a neo-Hookean block, with every law of its fluid."""
    for fluid, pressure, volume, force in HOLLOW:
        settings = {
            "-analysis": "static", "-tissue_model": "neo_hookean", "-tissue_element": "p1",
            "-tissue_young": "5000", "-tissue_poisson": "0.3", "-fix": "z0", "-cavities": "c",
            "-cavity_surface": "wall", **{f"-cavity_{key}": word for key, word in fluid.items()}}
        if force:
            settings["-boundary_z1_displacement"] = "0.004,0,-0.008"
        what = f"follower cavity, {', '.join(fluid.values())}"
        _, found = results(what, "hollow_block", settings)
        compare(what + ": pressure", found["cavity/c/pressure"][-1:], [pressure], 1e-8)
        compare(what + ": volume", found["cavity/c/volume"][-1:], [volume], 1e-8)
        if force:
            compare(what + ": force on the top", found["boundary/z1/force"][-1], force, 1e-8)


# Largest component of displacement [m] and elastic energy [J], by element and tangent ("": the
# default): NumPy, with the exact tangent.
BENT = [
    ("p1", "", 0.946809, 4.506602),
    ("p2", "", 1.801346, 6.7426919),
    ("p1", "exact", 0.946809, 4.506602),
    ("p2", "exact", 1.801346, 6.7426919),
]


def bent_beam():
    """A corotational beam that a load on its end, brought up in ten steps, bends far over."""
    ramp = written("ramp.csv", "time,factor\n0,0\n1,1\n")
    for element, tangent, largest, energy in BENT:
        what = f"corotational beam of {element}, {tangent or 'default'} tangent"
        folder, found = results(what, "bent_beam", {
            "-analysis": "static", "-tissue_model": "corotational", "-tissue_element": element,
            "-tissue_young": "5000", "-tissue_poisson": "0.35", "-fix": "x0",
            "-boundary_x1_traction": "0,12,-30", "-boundary_x1_curve": ramp, "-time_step": "0.1",
            "-time_end": "1", "-output_energy": "", "-output_every": "10",
            **({"-tissue_tangent": tangent} if tangent else {})})
        with h5py.File(os.path.join(folder, "fields", "step_000010.h5")) as fields:
            u = fields["displacement"][...]
        compare(what + ": largest displacement", [abs(u).max()], [largest], 1e-6)
        compare(what + ": elastic energy", found["energy/elastic"][-1:], [energy], 1e-7)


# Force of the holder [N] and number of points that slip, by friction per length [N/m]: NumPy for
# block and beam, CVXOPT to 1e-16 for the friction.
STUCK = [
    (2, (0.09000304, -0.00307133, 0.01507282), 6),
    (9, (0.27074284, 0.01180639, 0.0057574), 3),
    (15, (0.28257306, 0.01280536, 0.00490103), 2),
    (30, (0.2867154, 0.01315061, 0.00442498), 0),
]


def held_needle():
    """The first step of a bending needle that sits in a block and is pushed and turned, linearised
    once. The values are of inertia M/h^2; a step that sets out from a start has h/2 for one of the two lengths
    (docs/theory.md section 1), which is twice the mass. So the block gets half the density, and
    twice the gravity and mass damping, for the same weight and damping."""
    for friction, force, slipping in STUCK:
        what = f"beam needle held by friction of {friction} N/m"
        _, found = results(what, "needle_block", {
            "-tissue_model": "linear", "-tissue_element": "p1", "-tissue_young": "6000",
            "-tissue_poisson": "0.4", "-tissue_density": "500", "-tissue_rayleigh_mass": "2",
            "-tissue_rayleigh_stiffness": "0.01", "-gravity": "0,0,-19.62", "-fix": "z0",
            "-time_step": "0.02", "-time_end": "0.02", "-time_newton_max": "1", "-needles": "n",
            "-needle_model": "beam",
            "-needle_entry": "0,0.0213,0.0187", "-needle_direction": "1,0.08,-0.05",
            "-needle_length": "0.08", "-needle_radius": "0.0005",
            "-needle_inner_radius": "0.0002", "-needle_young": "2e9", "-needle_poisson": "0.3",
            "-needle_elements": "8", "-needle_inserted": "0.043",
            "-needle_trajectory": os.path.join(DATA, "needle_turn.csv"),
            "-insertion_friction_static": str(friction),
            "-insertion_friction_dynamic": str(friction), "-insertion_merge": "0.3",
            "-constraint_tolerance": "1e-16"})
        off = abs(found["needle/n/base_force"][-1] - force).max()
        check(off < 6e-9, f"{what}: the holder's force is {off:.1e} N off {force} N")
        slips = found["needle/n/slipping"][-1], found["needle/n/points"][-1]
        check(slips == (slipping, 6),
              f"{what}: {slips[0]:.0f} of {slips[1]:.0f} points slip, expected {slipping} of 6")


# Amount per volume at a pressure, by fluid: Boyle's law, and that of a bulk modulus.
PRESSURE_SCALE = 2e4
AMOUNT = {
    "gas": lambda p: p + PRESSURE_SCALE,
    "bulk": lambda p: np.exp(p / PRESSURE_SCALE),
}


def joined_cavities():
    """Two unlike follower cavities at unlike pressures and a pipe between them: what one loses the
    other gains, by the volumes and pressures that the program writes (linear cavities write the
    volume of the deformed wall, which is not the one of their law). No other program is asked."""
    for law, amount in AMOUNT.items():
        what = f"{law} in two joined cavities"
        folder, found = results(what, "twice_hollow_block", {
            "-analysis": "static", "-tissue_model": "linear", "-tissue_element": "p1",
            "-tissue_young": "7000", "-tissue_poisson": "0.4", "-fix": "z0",
            "-time_step": "0.1", "-time_end": "5", "-cavities": "a,b", "-cavity_a_surface": "wa",
            "-cavity_b_surface": "wb", "-cavity_model": "follower", "-cavity_law": law,
            "-cavity_ambient_pressure" if law == "gas" else "-cavity_bulk_modulus":
                repr(PRESSURE_SCALE),
            "-cavity_a_initial_pressure": "3000", "-cavity_b_initial_pressure": "0",
            "-conduits": "ab:a:b", "-conduit_ab_resistance": "4e8"})
        with h5py.File(os.path.join(folder, "run.h5")) as run:
            check((run["history/edge/ab/flow"][...] == found["conduit/ab/flow"]).all(),
                  f"{what}: the flow has its old name too")
        pressure = [found[f"cavity/{name}/pressure"] for name in "ab"]
        total = sum(found[f"cavity/{name}/volume"] * amount(p) for name, p in zip("ab", pressure))
        off = abs(total / total[0] - 1).max()
        check(off < 1e-10, f"{what}: its amount changes by {off:.1e}")
        left = abs(pressure[0] - pressure[1])
        check(left[0] > 2999 and left[-1] < 1,
              f"{what}: {left[-1]:.0f} Pa of {left[0]:.0f} between them are left")


for scene in (pulled_block, hollow_block, bent_beam, held_needle, joined_cavities):
    scene()
finish()
