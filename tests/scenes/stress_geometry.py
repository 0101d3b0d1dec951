"""Stress scenarios of geometry: placement, ties, slivers, scales, surfaces."""
import os

import numpy as np

import harness
from stress_kit import DYNAMIC, attempt, block, both, like, relative, scenario, slides, trajectory


def counted(spacing):
    """A test: a point every `spacing` along the path, from the entry to the tip."""
    def test(run):
        expected = int(np.floor(run.final("depth") / spacing + 1e-9)) + 1
        points = run.final("points")
        return abs(points - expected) <= 1, f"{points:.0f} points"
    return test


DISTANCES = [4e-3, 1e-3, 3e-4, 1e-4]


def spacings(table, name, settings, distances=DISTANCES, expect="right", more=lambda d: slides(),
             displacement=0.2):
    """Spacings against crossings: force to 5 %, displacement to its own bound (it is local)."""
    reference = attempt({**settings, "insertion_merge": 0})
    table.case(f"{name}, raw crossings", reference, more(None), expect)
    for d in distances:
        run = attempt({**settings, "insertion_placement": "spacing", "insertion_spacing": d},
                      timeout=1200)
        near = like(reference, 0.05, "crossings", displacement)
        table.case(f"{name}, {1e3 * d:g} mm", run, both(counted(d), more(d), near), expect)


def straight(**changes):
    """30 mm deep from the start, gravity, one equilibrium: no step bends the path."""
    return block(needle_inserted=0.03, needle_depth=0.03, needle_velocity=0, time_end=0,
                 insertion_friction_static=0, insertion_friction_dynamic=0, gravity="0,0,-2", **changes)


def two_rows_a_point(d):
    def test(run):
        rows, points = run.worst("constraint/rows"), run.final("points")
        return rows == 2 * points, f"{run.worst('constraint/rank'):.0f} of {rows:.0f} rows independent"
    return test


def bent():
    """A thin, soft needle whose base drifts 8 mm sideways while it goes in."""
    path = trajectory("bent", [(0, -0.08, 0.0237, 0.0229), (1.5, -0.05, 0.0317, 0.0259),
                               (1.6, -0.05, 0.0317, 0.0259)])
    return block(needle_trajectory=path, needle_young=2e10, needle_radius=0.0004,
                 tissue_young=20000)


LINEAR = {"tissue_model": "linear", "needle_model": "rigid"}


@scenario("spacing", quick=True)
def spacing(table):
    spacings(table, "straight path, rigid, linear", straight(**LINEAR), more=two_rows_a_point)


@scenario("spacing")
def dense_spacing(table):
    spacings(table, "straight path, beam", straight(), expect="either", more=two_rows_a_point)
    spacings(table, "insertion, rigid, linear", block(**LINEAR), expect="either")
    spacings(table, "insertion, rigid, linear, dynamic", block(**LINEAR, **DYNAMIC), expect="either")
    spacings(table, "insertion, rigid", block(needle_model="rigid"), expect="either")
    spacings(table, "insertion, beam", block(), expect="either")
    spacings(table, "insertion, beam, dynamic", block(**DYNAMIC), expect="either")
    spacings(table, "bent path, beam", bent(), expect="either", displacement=0.5)
    run = attempt(block(insertion_placement="spacing", insertion_spacing=0.1))
    table.case("one point only (100 mm)", run, both(counted(0.1), slides()))


def cube():
    return harness.structured("cube", *"--nodes 5 5 5 --size 0.04 0.04 0.04 --split 6".split())


TIES = {
    "along edges through vertices": ("0,0.02,0.02", "1,0,0"),
    "entry on a vertex": ("0,0.02,0.02", "1,0.13,0.07"),
    "along face diagonals that are edges": ("0,0.02,0.02", "1,1,0"),
    "along face diagonals across edges": ("0,0.02,0.02", "1,-1,0"),
    "along the cells' main diagonals": ("0,0.01,0.01", "1,1,1"),
    "in face planes": ("0,0.02,0.0234", "1,0,0"),
    "in diagonal face planes": ("0,0.0237,0.0237", "1,0,0"),
    "entry on an edge, through edges": ("0,0.02,0.0234", "1,0.3,0"),
}


def ties(table, names):
    for name in names:
        entry, direction = TIES[name]
        exact = block(mesh=cube(), needle_entry=entry, needle_direction=direction,
                      needle_depth=0.025, time_end=1.35)
        x, y, z = map(float, entry.split(","))
        shifted = attempt({**exact, "needle_entry": f"{x},{y + 1.3e-4},{z + 0.7e-4}"})
        run = attempt(exact)
        near = like(shifted, 0.03, "a line 0.15 mm beside it", displacement=0.06)
        table.case(name, run, both(slides(), near))
        three = attempt(exact, ranks=3)
        table.case(name + ", 3 ranks", three, like(run, 1e-8, "1 rank"))


@scenario("path", quick=True)
def quick_ties(table):
    ties(table, list(TIES)[:2])


@scenario("path")
def all_ties(table):
    ties(table, list(TIES)[2:])


@scenario("path")
def surfaces(table):
    for name, entry in [("along the surface, in its plane", "0,0.0237,0.04"),
                        ("0.1 mm below the surface", "0,0.0237,0.0399"),
                        ("1e-9 m above the surface", "0,0.0237,0.040000001"),
                        ("1 mm above the surface", "0,0.0237,0.041"),
                        ("along the block's edge", "0,0.04,0.04"),
                        ("in the fixed surface", "0,0.0237,0")]:
        table.case(name, attempt(block(needle_entry=entry)), slides(), "either")


def quality(tet):
    """6 sqrt(2) V / l_rms^3: 1 for a regular tet."""
    volume = np.linalg.det(tet[1:] - tet[0]) / 6
    edges = [tet[a] - tet[b] for a in range(4) for b in range(a)]
    return 6 * np.sqrt(2) * volume / np.mean([e @ e for e in edges]) ** 1.5


def sliver_mesh(name, towards, wanted):
    """The small block with the node at (3, 2, 2) cm moved towards a place until the worst tet has
    the wanted quality. Five tets per cell: the node's tets fill an octahedron and stay positive."""
    with open(harness.small_block()) as stream:
        lines = stream.read().splitlines()
    first, number = lines.index("$Nodes") + 2, 3 + 7 * (2 + 5 * 2)
    count = int(lines[first - 1])
    x = np.array([[float(w) for w in line.split()[1:]] for line in lines[first:first + count]])
    tets = np.array([[int(w) - 1 for w in line.split()[-4:]] for line in lines
                     if len(line.split()) == 9 and line.split()[1] == "4"])
    mine = [tet for tet in tets if number in tet]
    home, low, high = x[number].copy(), 0.0, 1.0
    assert np.allclose(home, (0.03, 0.02, 0.02)) and len(mine) == 8
    while high - low > 1e-15:
        part = 0.5 * (low + high)
        x[number] = home + part * (np.array(towards) - home)
        if min(quality(x[tet]) for tet in mine) > wanted:
            low = part
        else:
            high = part
    x[number] = home + low * (np.array(towards) - home)
    lines[first + number] = f"{number + 1} " + " ".join(f"{c:.17g}" for c in x[number])
    path = os.path.join(harness.MESHES, name + ".msh")
    with open(path, "w") as stream:
        stream.write("\n".join(lines) + "\n")
    return path, x[number]


# Where the node goes: into the plane of three neighbours (a cap), onto an edge of two neighbours
# (a sliver), onto a neighbour (a spade).
SLIVERS = {"flat": (0.03 + 0.01 / 3, 0.02 + 0.01 / 3, 0.02 + 0.01 / 3),
           "on an edge": (0.03, 0.025, 0.025), "short edge": (0.04, 0.02, 0.02)}


def slivers(table, names):
    regular = attempt(block())
    for name in names:
        mesh, node = sliver_mesh("sliver_" + name.replace(" ", "_"), SLIVERS[name], 1e-4)
        table.case(f"quality 1e-4, {name}, path through it", attempt(block(mesh=mesh)),
                   both(slides(), like(regular, 0.15, "the regular mesh", displacement=None)))
        run = attempt(block(mesh=mesh, needle_entry=f"0,{node[1]:.17g},{node[2]:.17g}"))
        table.case(f"quality 1e-4, {name}, path through its moved node", run, slides())


@scenario("sliver", quick=True)
def quick_slivers(table):
    slivers(table, list(SLIVERS)[:1])


@scenario("sliver")
def more_slivers(table):
    slivers(table, list(SLIVERS)[1:])
    for wanted in (1e-6, 1e-8):
        mesh, _ = sliver_mesh(f"sliver_{wanted}", SLIVERS["flat"], wanted)
        table.case(f"quality {wanted:g}", attempt(block(mesh=mesh)), slides(), "either")


def scaled(s):
    """The block with every length times s: forces go with s², friction per length with s."""
    entry = ",".join(f"{s * c:.17g}" for c in (0, 0.0237, 0.0229))
    return block(mesh_scale=s, needle_entry=entry, needle_length=0.08 * s, needle_radius=5e-4 * s,
                 needle_velocity=0.02 * s, needle_depth=0.03 * s,
                 insertion_friction_static=20 * s, insertion_friction_dynamic=20 * s)


@scenario("scale")
def scales(table):
    reference = attempt(block())
    for s in (1e-3, 1e-2, 10.0, 1e3):
        def test(run, s=s):
            force = relative(run.final("base_force") / s**2, reference.final("base_force"))
            u = relative(run.field() / s, reference.field())
            return max(force, u) <= 1e-3, f"force/s² {force:.1e}, displacement/s {u:.1e} from s = 1"
        table.case(f"all lengths times {s:g}", attempt(scaled(s)), test)
    for s in (1e-3, 1e3):
        run = attempt(block(mesh_scale=s))
        table.case(f"mesh alone times {s:g}", run, slides(), "either")


@scenario("needle", quick=True)
def long_needle(table):
    def out(run):
        depth, points = run.final("depth"), run.final("points")
        tip = run.final("tip")[0]
        return tip > 0.06 and abs(depth - 0.06) <= 2e-3 and points <= 30, \
            f"tip at {1e3 * tip:.1f} mm, {1e3 * depth:.1f} mm of it in 60 mm of tissue"
    run = attempt(block(needle_length=0.2, needle_depth=0.1, time_end=5.2, tissue_young=50000))
    table.case("through the block and out at the far side", run, both(out, slides()))


@scenario("needle")
def short_needle(table):
    run = attempt(block(needle_length=0.02))
    table.case("base would enter the tissue", run, slides(), "rejected")
    run = attempt(block(needle_entry="0.03,0.0237,0.0229"))
    table.case("entry inside the tissue", run, slides(), "rejected")
