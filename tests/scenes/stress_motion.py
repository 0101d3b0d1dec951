"""Stress scenarios of motion: steps, sideways, cycles, many needles, jumps, re-entry."""
import numpy as np

import harness
from stress_kit import (DYNAMIC, attempt, block, both, friction_error, like, relative, scenario,
                        slides, trajectory)


def slow(h, **changes):
    """Linear, dynamic: 10 mm in 1 s, half a second of rest; the inertia hardly counts."""
    mesh = harness.structured("coarse", *"--nodes 4 3 3 --size 0.06 0.04 0.04 --split 6".split())
    return block(mesh=mesh, tissue_model="linear", needle_model="rigid",
                 needle_velocity=0.01, needle_depth=0.01, time_end=1.5, time_step=h,
                 **DYNAMIC, **changes)


def steps(table, sizes):
    reference = attempt(slow(2e-3))
    for h in sizes:
        table.case(f"h = {h:g} s", attempt(slow(h), timeout=1200),
                   both(slides(), like(reference, 0.03, "h = 2e-3 s")))


@scenario("time step", quick=True)
def long_steps(table):
    steps(table, [1e-1, 1e-2])


@scenario("time step")
def short_steps(table):
    steps(table, [1e-3, 1e-4])
    reference = attempt(slow(2e-3))
    table.case("h = 1.5 s, one step for all", attempt(slow(1.5)),
               both(slides(), like(reference, 0.25, "h = 2e-3 s: the path is cut before the tissue "
                                   "follows", displacement=0.5)), "either")
    run = attempt(block(time_step=1e-9, time_end=2e-8, analysis="dynamic", tissue_rayleigh_stiffness=0))
    table.case("h = 1e-9 s, 20 steps", run,
               lambda run: (abs(run.final("depth") - 4e-10) < 1e-12,
                            f"depth {run.final('depth'):.3e} m"), "either")
    run = attempt(block(time_step=1.6))
    table.case("corotational beam, one step for all", run,
               both(slides(), like(attempt(block()), 0.25, "steps of 1 mm", displacement=0.5)), "either")


def sideways(name, way, pieces, **changes):
    """30 mm in, then the base goes sideways by `way` in 2 s."""
    length = changes.get("needle_length", 0.08)
    path = trajectory(name, [(0, -length, 0.0237, 0.0229), (1.5, 0.03 - length, 0.0237, 0.0229),
                             (3.5, 0.03 - length, 0.0237 + way, 0.0229)])
    return block(needle_trajectory=path, time_end=3.5, time_step=3.5 / pieces, **DYNAMIC, **changes)


# It would buckle under 0.28 N; the friction is 0.15 N.
THIN = {"needle_length": 0.3, "needle_radius": 0.0003, "needle_elements": 30,
        "insertion_friction_static": 5, "insertion_friction_dynamic": 5}


def deflected(run):
    """Still in the tissue, and the base is held against it."""
    force, depth = run.final("base_force")[1], run.final("depth")
    return force > 0 and depth > 0.005, f"sideways force {force:.3f} N at {1e3 * depth:.1f} mm"


@scenario("sideways", quick=True)
def rigid_sideways(table):
    run = attempt(sideways("rigid", 0.1, 70, needle_model="rigid"))
    table.case("rigid needle, base 10 cm sideways", run, slides(), "rejected")


@scenario("sideways")
def beam_sideways(table):
    half = attempt(sideways("beam", 0.1, 560, **THIN))
    run = attempt(sideways("beam", 0.1, 280, **THIN))
    table.case("thin beam (30 cm, 0.3 mm, τ = 5 N/m), base 10 cm sideways", run,
               both(slides(5), deflected, like(half, 0.05, "half the step")))


@scenario("sideways")
def more_sideways(table):
    for way in (0.01, -0.01):
        run = attempt(sideways(f"steel{way}", way, 70))
        half = attempt(sideways(f"steel{way}", way, 140))
        table.case(f"steel beam, base {1e3 * way:g} mm sideways", run,
                   both(slides(), like(half, 0.05, "half the step")), "either")
    def out(run):
        force, left = abs(run.final("base_force")).max(), abs(run.field()).max()
        return run.final("points") == 0 and force <= 1e-9 and left <= 1e-3, \
            f"bends, slides out and is free: force {force:.0e} N, {1e3 * left:.2f} mm of displacement"
    run = attempt(sideways("steel", 0.1, 280))
    table.case("steel beam, base 10 cm sideways", run, out)
    run = attempt({**sideways("static", 0.1, 70, **THIN), "analysis": "static"})
    table.case("thin beam, base 10 cm sideways, quasi-static", run, both(slides(5), deflected), "either")
    quarter = [(0, -0.08, 0.0237, 0.0229, 1, 0, 0), (1.5, -0.05, 0.0237, 0.0229, 1, 0, 0),
               (2.5, -0.05, 0.0237, 0.0229, 0, 1, 0)]
    run = attempt(block(needle_trajectory=trajectory("quarter", quarter), time_end=2.5))
    table.case("base turned by 90° while inserted", run, slides(), "either")
    roll = [(0, -0.08, 0.0237, 0.0229, 1, 0, 0, 0), (1.5, -0.05, 0.0237, 0.0229, 1, 0, 0, 0),
            (3.5, -0.05, 0.0237, 0.0229, 1, 0, 0, 62.83185307179586)]
    run = attempt(block(needle_trajectory=trajectory("roll", roll), time_end=3.5))
    table.case("ten turns about its axis", run, both(slides(), like(attempt(block()), 1e-3, "no turns")))


LINEAR = {"tissue_model": "linear", "needle_model": "rigid"}


def cycles(count, base=-0.08, out=0.005):
    rows = [(0, base, 0.0237, 0.0229)]
    for n in range(count):
        rows += [(4.0 * n + t, base + x, 0.0237, 0.0229)
                 for t, x in ((1.75, 0.03), (2, 0.03), (4, -out))]
    return rows


def no_drift(count):
    def test(run):
        t, depth = run.h["time"], run.needle("depth")
        force = run.needle("base_force")
        inside = [np.argmin(abs(t - 4.0 * n - 2)) for n in range(1, count)]
        outside = [np.argmin(abs(t - 4.0 * n - 4)) for n in range(count)]
        drift = max(relative(force[i], force[inside[0]]) for i in inside)
        deeper = abs(depth[inside] - depth[inside[0]]).max()
        left = abs(run.field()).max()
        good = drift <= 1e-6 and deeper <= 1e-8 and depth[outside].max() == 0 and left <= 1e-6
        return good, (f"cycles 2 to {count}: force {drift:.0e}, depth {deeper:.0e} m; at the end "
                      f"{left:.0e} m of displacement left")
    return test


@scenario("cycles", quick=True)
def few_cycles(table):
    path = trajectory("cycles3", cycles(3))
    run = attempt(block(needle_trajectory=path, time_end=12, time_step=0.125))
    table.case("3 times in and out", run, no_drift(3))


@scenario("cycles")
def ten_cycles(table):
    path = trajectory("cycles10", cycles(10))
    table.case("10 times in and out", attempt(block(needle_trajectory=path, time_end=40)), no_drift(10))
    run = attempt(block(needle_trajectory=path, time_end=40, needle_model="rigid"))
    table.case("10 times in and out, rigid", run, no_drift(10))
    run = attempt(block(needle_trajectory=path, time_end=40, time_step=0.25, **LINEAR), ranks=3)
    table.case("10 times in and out, linear, 3 ranks", run, no_drift(10))


def reentry(shift):
    """In, out, base moved up by shift outside the tissue, in again at the same speed."""
    y, z = 0.0237, 0.0229
    rows = [(0, -0.08, y, z), (1.5, -0.05, y, z), (3.5, -0.09, y, z), (4.5, -0.09, y, z + shift),
            (5, -0.08, y, z + shift), (6.5, -0.05, y, z + shift), (6.6, -0.05, y, z + shift)]
    return block(needle_trajectory=trajectory(f"again{shift}", rows), time_end=6.6)


def axially_like(fresh):
    """Nearer than 0.3 edges the old channel is taken: only the lateral force differs then."""
    def test(run):
        error = relative(run.final("shaft_friction"), fresh.final("shaft_friction"))
        side = abs(run.final("base_force")[1:] - fresh.final("base_force")[1:]).max()
        return error <= 0.05, (f"friction {error:.1e} (bound 0.05), lateral force {side:.1e} N from a "
                               "first insertion there")
    return test


@scenario("re-entry")
def again(table):
    for shift in (1e-6, 1e-4, 1e-3, 3e-3, 3.5e-3, 5e-3):
        fresh = attempt(block(needle_entry=f"0,0.0237,{0.0229 + shift}"))
        table.case(f"{1e3 * shift:g} mm beside the channel", attempt(reentry(shift)),
                   both(slides(), axially_like(fresh)))


def many(count, **changes):
    """count needles on a grid of the face x = 0."""
    places = [(0.0047 + 0.0073 * (n % 5), 0.0061 + 0.0081 * (n // 5)) for n in range(count)]
    entries = {f"needle_n{n}_entry": f"0,{y:.6f},{z:.6f}" for n, (y, z) in enumerate(places)}
    names = ",".join(f"n{n}" for n in range(count))
    return block(needles=names, tissue_young=50000, **entries, **changes)


def all_slide(count):
    def test(run):
        worst = max(friction_error(run, 20, f"n{n}") for n in range(count))
        total = sum(run.final("shaft_friction", f"n{n}") for n in range(count))
        return worst <= 1e-6, f"each friction = τ · depth to {worst:.0e}, sum {total:.3f} N"
    return test


@scenario("many needles", quick=True)
def twenty(table):
    run = attempt(many(20, time_step=0.1), timeout=1200)
    table.case("20 beams at once", run, all_slide(20))


@scenario("many needles")
def coincident(table):
    one = attempt(many(20, time_step=0.1), timeout=1200)

    def same(run):
        names = [f"n{n}" for n in range(20)]
        worst = max(relative(run.final("base_force", n), one.final("base_force", n)) for n in names)
        return worst <= 1e-6, f"forces {worst:.0e} from 1 rank"
    table.case("20 beams, 3 ranks", attempt(many(20, time_step=0.1), ranks=3, timeout=1200), same)
    run = attempt(many(20, time_step=0.1, needle_model="rigid"), timeout=1200)
    table.case("20 rigid needles", run, all_slide(20), "either")
    at = "0,0.0237,0.0229"
    for model in ("beam", "rigid"):
        run = attempt(block(needles="n0,n1", needle_n0_entry=at, needle_n1_entry=at, needle_model=model))
        table.case(f"two {model} needles in the same place", run, all_slide(2), "either")
    run = attempt(block(needles="n0,n1", needle_n0_entry=at, needle_n1_entry="0.0153,0.04,0.0229",
                        needle_n1_direction="0,-1,0", needle_n1_depth=0.03))
    table.case("two needles that cross", run, lambda run: (run.final("depth", "n1") > 0, "both go in"),
               "either")


@scenario("motion", quick=True)
def rest(table):
    def nothing(run):
        force, moved = abs(run.needle("base_force")).max(), abs(run.field()).max()
        return force <= 1e-12 and moved <= 1e-12, f"force {force:.0e} N, displacement {moved:.0e} m"
    table.case("velocity 0, outside", attempt(block(needle_velocity=0)), nothing)
    table.case("velocity 0, inserted", attempt(block(needle_velocity=0, needle_inserted=0.02)), nothing)


@scenario("motion")
def jumps(table):
    y, z = 0.0237, 0.0229
    reference = attempt(block())
    jump = trajectory("jump", [(0, -0.08, y, z), (0.049, -0.08, y, z), (0.05, -0.05, y, z),
                               (2, -0.05, y, z)])
    table.case("30 mm within one step", attempt(block(needle_trajectory=jump)), slides(), "either")
    shake = [(0, -0.08, y, z), (1.5, -0.05, y, z)]
    shake += [(1.5 + 0.1 * n, -0.05 + 0.002 * (-1) ** n, y, z) for n in range(1, 21)]
    run = attempt(block(needle_trajectory=trajectory("shake", shake), time_end=3.5))
    table.case("20 strokes of 4 mm", run, within_limit(20), "either")
    run = attempt(block(needle_velocity=1e-9))
    table.case("1 nm/s", run,
               lambda run: (run.final("depth") <= 2e-9, f"depth {run.final('depth'):.1e} m"))
    run = attempt(block(needle_velocity=1e3, **DYNAMIC))
    table.case("1 km/s, dynamic", run, slides(), "either")
    run = attempt(block(time_newton_max=30, **DYNAMIC))
    table.case("30 linearisations, dynamic", run, both(slides(), like(reference, 0.05, "quasi-static")))
    run = attempt(block(insertion_friction_viscous=1e9))
    table.case("viscous friction 1e9 N s/m²", run,
               lambda run: (run.final("depth") < 0.005, "hardly slips"), "either")
    run = attempt(block(insertion_friction_static=0, insertion_friction_dynamic=0,
                        insertion_friction_viscous=1e-12))
    table.case("viscous friction 1e-12 N s/m²", run,
               lambda run: (abs(run.final("shaft_friction")) <= 1e-14, "no force"))


@scenario("motion")
def swept(table):
    """A needle longer than the block, moved sideways so that its shaft cuts through the block."""
    def not_in_silence(run):
        force = abs(run.needle("base_force")).max()
        return force > 0, f"shaft through the block, largest force {force:.0e} N"
    rows = [(0, -0.05, -0.01, 0.0229), (1, -0.05, 0.02, 0.0229)]
    run = attempt(block(needle_model="rigid", needle_length=0.15, needle_entry="0.1,-0.01,0.0229",
                        needle_trajectory=trajectory("swept", rows), time_end=1))
    table.case("shaft swept into the block from the side", run, not_in_silence, "either")


def within_limit(limit):
    def test(run):
        excess = (abs(run.needle("shaft_friction")) - limit * run.needle("depth")).max()
        return excess <= 1e-9, f"|friction| <= τ · depth, excess {excess:.0e} N"
    return test
