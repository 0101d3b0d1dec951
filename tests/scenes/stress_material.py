"""Stress scenarios of materials, laws and solvers: contrasts, limits, thresholds, extremes."""
import subprocess

import numpy as np

import harness
from stress_kit import DYNAMIC, attempt, block, both, like, relative, scenario, slides


def layers(soft_first, contrast, **changes):
    """Two halves along x of 5 kPa and contrast times that; the needle goes through both."""
    mesh = harness.structured(
        "layers", *"--nodes 7 5 5 --size 0.06 0.04 0.04 --split 5 --volumes a,b".split())
    young = (5000, 5000 * contrast) if soft_first else (5000 * contrast, 5000)
    return block(mesh=mesh, tissue_a_young=young[0], tissue_b_young=young[1], needle_depth=0.045,
                 time_end=2.35, **changes)


def stiffer(table, soft_first, name):
    reference = attempt(layers(soft_first, 1e5))
    table.case(f"Young's modulus 1 : 1e6, {name}", attempt(layers(soft_first, 1e6)),
               both(slides(), like(reference, 1e-3, "1 : 1e5")))


@scenario("contrast", quick=True)
def contrast(table):
    stiffer(table, True, "soft then stiff")


@scenario("contrast")
def more_contrast(table):
    stiffer(table, False, "stiff then soft")
    table.case("Young's modulus 1 : 1e6, 3 ranks", attempt(layers(True, 1e6), ranks=3),
               like(attempt(layers(True, 1e6)), 1e-6, "1 rank"))
    reference = attempt(layers(True, 1e5))
    table.case("Young's modulus 1 : 1e12", attempt(layers(True, 1e12)),
               both(slides(), like(reference, 1e-3, "1 : 1e5")), "either")
    frictions = {"insertion_a_friction_static": 1e-3, "insertion_a_friction_dynamic": 1e-3,
                 "insertion_b_friction_static": 1e3, "insertion_b_friction_dynamic": 1e3}

    def sum_of_layers(run):
        force, depth = run.final("shaft_friction"), run.final("depth")
        expected = 1e-3 * 0.03 + 1e3 * (depth - 0.03)
        return abs(force - expected) <= 1e-4 * expected, f"{force:.4f} N, Στ l = {expected:.4f} N"
    table.case("friction 1 : 1e6", attempt(layers(True, 1e3, **frictions)), sum_of_layers)


def soft(needle_young, model="beam"):
    """A needle of 1 mm radius in tissue of 500 Pa, with friction to match."""
    return block(tissue_young=500, insertion_friction_static=2, insertion_friction_dynamic=2,
                 needle_young=needle_young, needle_model=model, needle_radius=0.001)


@scenario("needle", quick=True)
def stiff_needle(table):
    rigid = attempt(soft(2e11, "rigid"))
    table.case("200 GPa in 500 Pa", attempt(soft(2e11)), both(slides(2), like(rigid, 0.02, "rigid")))
    table.case("200 GPa in 500 Pa, a single element", attempt({**soft(2e11), "needle_elements": 1}),
               both(slides(2), like(rigid, 0.02, "rigid")))


@scenario("needle")
def needles_of_all_kinds(table):
    reference = attempt(block(time_step=0.2))
    for young in (2e13, 2e15):
        table.case(f"{young:g} Pa in 500 Pa", attempt(soft(young)), slides(2), "either")
    table.case("500 elements", attempt(block(needle_elements=500, time_step=0.2), timeout=1200),
               both(slides(), like(reference, 0.02, "10 elements")))
    kinds = {f"radius {r:g} m": {"needle_radius": r} for r in (2e-4, 1e-4, 1e-6, 1e-9)}
    kinds["as soft as the tissue (5 kPa)"] = {"needle_young": 5e3}
    kinds["wall of 1e-9 m"] = {"needle_inner_radius": 0.0005 - 1e-9}
    for name, changes in kinds.items():
        table.case(name, attempt(block(**changes)), slides_or_buckles, "either")
        table.case(name + ", dynamic", attempt(block(**changes, **DYNAMIC)), slides_or_buckles, "either")
    heavy = block(needle_density=7.85e5, gravity="0,0,-9.81", tissue_young=50000)
    table.case("a hundred times as heavy as steel", attempt(heavy), slides())


def slides_or_buckles(run):
    """No tip goes on while every point sticks, and the friction is never above its limit."""
    force, depth = abs(run.needle("shaft_friction")), run.needle("depth")
    slipped = run.needle("slipping").max() > 0
    within = (force - 20 * depth).max() <= 1e-9
    return within and (slipped or depth[-1] < 0.002), \
        f"{'slid' if slipped else 'stuck'} to {1e3 * depth[-1]:.1f} mm, {force[-1]:.1e} N"


@scenario("Poisson", quick=True)
def poisson(table):
    usual = None
    for nu in (0.45, 0.3, 0.49, 0.499, 0.4999):
        run = attempt(block(tissue_poisson=nu))
        usual = usual or run

        def test(run, nu=nu):
            warned = "linear tets lock" in run.stdout
            u = relative(run.field(), usual.field())
            return u <= 0.3 and warned == (nu > 0.45), \
                f"displacement {u:.2f} from ν = 0.45, {'warned of locking' if warned else 'no warning'}"
        table.case(f"ν = {nu}", run, both(slides(), test))
    table.case("ν = -0.99", attempt(block(tissue_poisson=-0.99)), slides(), "either")


def held(travel, **changes):
    """Rigid needle already 20 mm in, moved on by travel in 1 s through linear tissue."""
    return block(tissue_model="linear", needle_model="rigid", needle_inserted=0.02,
                 needle_depth=0.02 + travel, needle_velocity=travel, time_end=1, time_step=0.1,
                 insertion_friction_static=1e12, insertion_friction_dynamic=1e12, **changes)


@scenario("threshold", quick=True)
def friction(table):
    none = {"insertion_friction_static": 0, "insertion_friction_dynamic": 0}

    def exactly_none(run):
        force, push = abs(run.needle("shaft_friction")).max(), abs(run.needle("base_force")[:, 0]).max()
        return force == 0.0 and push <= 1e-9 and abs(run.final("depth") - 0.03) <= 1e-9, \
            f"shaft friction {force} N, axial base force {push:.0e} N"
    table.case("friction 0", attempt(block(**none)), exactly_none)
    half = attempt(held(0.0005))

    def sticks(run):
        slipping = run.needle("slipping").max()
        moved = run.field("coupling/position") - run.field("coupling/position", 0)
        follow = abs(moved - [0.001, 0, 0]).max()
        ratio = run.final("base_force")[0] / half.final("base_force")[0]
        return slipping == 0 and follow <= 1e-9 and abs(ratio - 2) <= 1e-9, \
            f"no slip, points follow the base to {follow:.0e} m, force {ratio:.9f} times half the way's"
    table.case("friction 1e12 N/m, all sticks", attempt(held(0.001)), sticks)
    run = attempt(block(insertion_friction_static=1e12, insertion_friction_dynamic=1e12))
    table.case("friction 1e12 N/m from outside", run, stays_outside, "either")
    run = attempt(block(insertion_friction_static=1e12, insertion_friction_dynamic=20))
    table.case("static limit 1e12, dynamic 20 N/m", run, slides(), "either")


def stays_outside(run):
    depth, travel = run.final("depth"), run.final("tip")[0]
    return depth <= 0.2 * travel, f"depth {1e3 * depth:.2f} mm of {1e3 * travel:.0f} mm of travel"


@scenario("threshold", quick=True)
def puncture(table):
    help_text = subprocess.run([harness.PROGRAM, "-help"], capture_output=True, text=True, check=True)
    for name in ("insertion_puncture_force", "insertion_cutting_force"):
        if "-" + name not in help_text.stdout:
            table.skip(name, f"this program has no option -{name}")
            continue
        zero = attempt(block(**{name: 0}))
        table.case(f"{name} 0", zero, both(slides(), like(attempt(block()), 1e-9, "without it")))
        run = attempt(block(tissue_young=1e6, needle_velocity=0.002, needle_depth=0.003,
                            **{name: 1e12}))
        table.case(f"{name} 1e12 N", run, stays_outside, "either")


@scenario("extremes", quick=True)
def gravity(table):
    straight = attempt(block(gravity="0,0,-0.1"))
    table.case("gravity 0.01 g", straight, slides())
    linear = block(tissue_model="linear", needles='""')
    one = attempt({**linear, "gravity": "0,0,-1"})

    def grows(run):
        error = relative(run.field() / 1e9, one.field())
        return error <= 1e-9, f"1e9 times the displacement of 1 m/s² to {error:.0e}"
    folded = attempt({**linear, "gravity": "0,0,-1e9", "tissue_allow_inversion": "true"})
    table.case("gravity 1e8 g, linear, no needle, folds allowed", folded, grows)
    table.case("gravity 1e8 g, linear, no needle", attempt({**linear, "gravity": "0,0,-1e9"}), grows, "rejected")
    run = attempt(block(gravity="0,0,-1e6", time_initial="equilibrium"))
    table.case("gravity 1e5 g", run, slides(), "rejected")


@scenario("extremes")
def young(table):
    reference = attempt(block())
    for factor in (2e-7, 2e8):
        run = attempt(block(tissue_young=5000 * factor, needle_young=2e11 * factor,
                            insertion_friction_static=20 * factor,
                            insertion_friction_dynamic=20 * factor))
        table.case(f"E = {5000 * factor:g} Pa and all forces with it", run,
                   both(slides(20 * factor), scales_with(reference, factor)))
    hard = attempt(block(tissue_young=1e12))
    table.case("E = 1e12 Pa, friction 20 N/m", hard, both(slides(), undisturbed))
    run = attempt(block(tissue_young=1e-3))
    table.case("E = 1e-3 Pa, friction 20 N/m", run, stays_outside, "either")
    table.case("density 1e-9 kg/m³, dynamic",
               attempt(block(tissue_density=1e-9, analysis="dynamic")),
               both(slides(), like(reference, 0.02, "quasi-static")))
    run = attempt(block(tissue_density=1e9, analysis="dynamic"))
    table.case("density 1e9 kg/m³, dynamic", run, both(slides(), undisturbed))


def scales_with(reference, factor):
    def test(run):
        force = relative(run.final("base_force") / factor, reference.final("base_force"))
        u = relative(run.field(), reference.field())
        return max(force, u) <= 1e-6, f"force/E {force:.1e}, displacement {u:.1e} from 5 kPa"
    return test


def undisturbed(run):
    gone = abs(run.final("depth") - 0.03)
    return gone <= 1e-5, f"tissue stays: depth 30 mm to {gone:.0e} m"


def mildly_hard(**changes):
    """Stick and slip at once on the way back, raw crossings: nearly redundant rows."""
    return block(needle_model="rigid", insertion_merge=0, needle_withdraw_velocity=0.002,
                 time_step=0.025, time_end=2.2, **changes)


def each_solver(table, name, settings, reference):
    for solver in ("active_set", "interior_point", "pgs", "hybrid"):
        run = attempt({**settings, "constraint_solver": solver, "constraint_max_iterations": 20000})
        table.case(f"{solver}, {name}", run, like(reference, 1e-5, "auto"), "either")


@scenario("solver", quick=True)
def solvers(table):
    settings = block(needle_withdraw_velocity=0.01, time_end=2.4)
    reference = attempt(settings)
    table.case("auto, merged crossings, beam", reference, stick_slip)
    each_solver(table, "merged crossings, beam", settings, reference)


@scenario("solver")
def hard_for_solvers(table):
    reference = attempt(mildly_hard())
    table.case("auto, raw crossings, rigid", reference, stick_slip)
    each_solver(table, "raw crossings, rigid", mildly_hard(), reference)
    settings = {**mildly_hard(), **DYNAMIC}
    reference = attempt(settings)
    table.case("auto, raw crossings, rigid, dynamic", reference, stick_slip)
    each_solver(table, "raw crossings, rigid, dynamic", settings, reference)


def stick_slip(run):
    slipping, points = run.needle("slipping"), run.needle("points")
    mixed = int(((slipping > 0) & (slipping < points)).sum())
    return mixed > 0, f"{mixed} steps with stuck and slipping points, {points.max():.0f} points"


@scenario("solver")
def tolerances(table):
    regular = attempt(block())
    for tolerance in (1e-12, 1e-18):
        table.case(f"tolerance {tolerance:g} m", attempt(block(constraint_tolerance=tolerance)),
                   like(regular, 1e-6, "1e-9 m"), "either")
    run = attempt(block(compliance_provider="ksp", tissue_ksp_type="cg", tissue_pc_type="jacobi",
                        tissue_ksp_rtol="1e-3"))
    table.case("linear solver stopped at 1e-3", run, like(regular, 1e-3, "direct solver"), "either")
    run = attempt(block(insertion_merge=0.99))
    table.case("merge 0.99", run, both(slides(), like(regular, 0.05, "0.3", displacement=None)))
    run = attempt(block(insertion_merge=0))
    table.case("merge 0", run, both(slides(), like(regular, 0.05, "0.3", displacement=None)), "either")
    run = attempt(block(insertion_eta=0.999999))
    table.case("eta 0.999999", run, lambda run: (np.isfinite(run.final("depth")), "finite"), "either")
