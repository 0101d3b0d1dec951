"""Cavities that cannot be: one clear line that names wall, option or file, and the right code."""
import itertools
import os

from harness import FOLDER, MESHES, check, completed, finish, histories, refusal, run, written

KUHN = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def block(name, holes, edit=lambda groups: None, n=4, filled=False):
    """n³ cells of 1 cm without the cells `holes`: volume "gel" (and "fluid" in the holes when filled);
    surfaces "bottom", "top", "skin" (all sides), "wall". `edit` may change the groups' triangles."""
    nodes = {p: i + 1 for i, p in enumerate(itertools.product(range(n + 1), repeat=3))}
    tets = {"gel": [], "fluid": []}
    for cell in itertools.product(range(n), repeat=3):
        if cell in holes and not filled:
            continue
        corner = [nodes[tuple(c + (k >> a & 1) for a, c in enumerate(cell))] for k in range(8)]
        tets["fluid" if cell in holes else "gel"] += [tuple(corner[k] for k in tet) for tet in KUHN]
    place = {i: p for p, i in nodes.items()}
    faces = {}
    for tet in tets["gel"]:
        for face in itertools.combinations(sorted(tet), 3):
            faces[face] = faces.get(face, 0) + 1
    outer = [f for f, count in faces.items() if count == 1]

    def on(face, axis, value):
        return all(place[i][axis] == value for i in face)

    skin = [f for f in outer if any(on(f, a, v) for a in range(3) for v in (0, n))]
    groups = {"bottom": [f for f in skin if on(f, 2, 0)], "top": [f for f in skin if on(f, 2, n)],
              "skin": list(skin), "wall": [f for f in outer if f not in set(skin)]}
    groups["inner"] = [next(f for f, count in faces.items() if count == 2)]
    edit(groups)
    used = sorted({i for group in tets.values() for tet in group for i in tet})
    volumes = [v for v in tets if tets[v]]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups) + len(volumes))]
    lines += [f'2 {k} "{g}"' for k, g in enumerate(groups, 1)]
    lines += [f'3 {k} "{v}"' for k, v in enumerate(volumes, 50)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(used))]
    lines += [f"{i} " + " ".join(f"{0.01 * c:.17g}" for c in place[i]) for i in used]
    elements = [f"2 2 {k} {k} {a} {b} {c}" for k, g in enumerate(groups, 1) for a, b, c in groups[g]]
    for k, v in enumerate(volumes, 50):
        for a, b, c, d in tets[v]:
            x, y, z, w = (place[i] for i in (a, b, c, d))
            u = [[q - p for p, q in zip(x, e)] for e in (y, z, w)]
            det = sum(u[0][i] * (u[1][(i + 1) % 3] * u[2][(i + 2) % 3] - u[1][(i + 2) % 3] * u[2][(i + 1) % 3])
                      for i in range(3))
            elements.append(f"4 2 {k} {k} {a} {b} " + (f"{c} {d}" if det > 0 else f"{d} {c}"))
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{k} {e}" for k, e in enumerate(elements, 1)] + ["$EndElements", ""]
    path = os.path.join(MESHES, name + ".msh")
    with open(path, "w") as out:
        out.write("\n".join(lines))
    return path


ONE = {(1, 1, 1), (2, 1, 1)}
good = {"-mesh": block("good", ONE), "-fix": "bottom", "-tissue_model": "linear", "-tissue_poisson": "0.4",
        "-analysis": "static", "-boundary_top_displacement": "0,0,-0.002", "-cavities": "hole",
        "-cavity_hole_surface": "wall", "-output_dir": os.path.join(FOLDER, "bad")}


refuses = refusal(good)
pressure = histories(completed(good))["cavity/hole/pressure"][-1]
check(pressure > 10.0, f"the good one runs: {pressure:.1f} Pa")
filled = {**good, "-mesh": block("filled", ONE, filled=True), "-cavity_hole_region": "fluid"}
del filled["-cavity_hole_surface"]
again = histories(completed(filled, 2))["cavity/hole/pressure"][-1]
check(abs(again - pressure) <= 1e-9 * pressure, "a volume taken out is the same hole")

# Geometry.
refuses("open wall", 65, ["wall", "hole of 3 edges around", "_cap"],
        {"-mesh": block("open", ONE, lambda g: g["wall"].pop())}, ranks=(1, 3))
refuses("wall that touches itself along a conduit", 65, ["wall", "touches itself"],
        {"-mesh": block("conduit", {(1, 1, 1), (2, 2, 1)})})
refuses("wall that touches itself at a node", 65, ["wall", "touches itself at node"],
        {"-mesh": block("node", {(1, 1, 1), (2, 2, 2)})})
refuses("wall inside out", 65, ["skin", "inside out"], {"-cavity_hole_surface": "skin"})
refuses("wall without volume", 65, ["bottom", "no volume"],
        {"-cavity_hole_surface": "bottom", "-cavity_hole_cap": ""})
refuses("wall inside the tissue", 65, ["inner", "both sides", "_region"], {"-cavity_hole_surface": "inner"})
refuses("unknown wall", 65, ["wal", "did you mean 'wall'"], {"-cavity_hole_surface": "wal"})
refuses("neither wall nor region", 64, ["-cavity_surface", "hole"], {}, remove=["-cavity_hole_surface"])
refuses("unknown region", 65, ["flud", "did you mean 'fluid'"],
        {"-mesh": filled["-mesh"], "-cavity_hole_region": "flud"}, remove=["-cavity_hole_surface"])
refuses("region that is all there is", 65, ["no tissue is left"], {"-cavity_hole_region": "gel"},
        remove=["-cavity_hole_surface"])
refuses("two laws on one wall", 64, ["share a wall"],
        {"-cavities": "hole,again", "-cavity_again_surface": "wall"})

# Laws.
table = {"-cavity_hole_law": "table"}
refuses("table without a file", 64, ["-cavity_table", "hole"], table)
refuses("rising table", 65, ["rising.csv", "cannot rise"],
        table | {"-cavity_hole_table": written("rising.csv", "pressure,volume\n0,1e-6\n100,2e-6\n")})
refuses("table not in order", 65, ["order.csv", "rise from row to row"],
        table | {"-cavity_hole_table": written("order.csv", "pressure,volume\n0,2e-6\n-5,3e-6\n")})
refuses("table with other columns", 65, ["columns must be pressure,volume"],
        table | {"-cavity_hole_table": written("columns.csv", "p,v\n0,2e-6\n5,1e-6\n")})
refuses("parameter of another law", 64, ["-cavity_bulk_modulus", "constant_volume"],
        {"-cavity_hole_bulk_modulus": "1e5"})
refuses("no bulk modulus", 64, ["-cavity_hole_bulk_modulus"],
        {"-cavity_hole_law": "bulk", "-cavity_hole_bulk_modulus": "0"})
refuses("two amounts of fluid", 64, ["-cavity_volume", "initial pressure"],
        {"-cavity_hole_volume": "1e-6", "-cavity_hole_initial_pressure": "10"})
refuses("unknown law", 64, ["-cavity_hole_law"], {"-cavity_hole_law": "syrup"})
refuses("override of no cavity", 64, ["-cavity_hale_law", "hole"], {"-cavity_hale_law": "gas"})

# Models and solvers.
refuses("frozen in turning tissue", 64, ["-cavity_model", "linear"],
        {"-tissue_model": "corotational", "-cavity_model": "frozen"})
refuses("linear beside turning tissue", 64, ["-cavity_model", "round its wall", "-tissue_gel_model linear"],
        {"-tissue_model": "linear", "-tissue_gel_model": "neo_hookean", "-cavity_model": "linear"})
refuses("linear in turning tissue", 64, ["-cavity_model"],
        {"-tissue_model": "corotational", "-cavity_model": "linear"})
for model, solver in (("linear", "exact"), ("linear", "proportional"), ("follower", "exact"),
                      ("follower", "proportional")):
    refuses(f"{model} with {solver}", 64, ["-cavity_solver", solver, model],
            {"-cavity_model": model, "-cavity_solver": solver})
refuses("gain without control", 64, ["-cavity_gain", "proportional"],
        {"-cavity_model": "frozen", "-cavity_hole_gain": "1e4"})
refuses("stale columns", 64, ["-compliance_reuse stale", "cavities"],
        {"-tissue_model": "corotational", "-compliance_reuse": "stale"})
refuses("gain that cannot converge", 70, ["not reached in 50 updates"],
        {"-cavity_model": "frozen", "-cavity_solver": "proportional", "-cavity_hole_gain": "1e9",
         "-cavity_max_updates": "50"}, ranks=(1, 3))
refuses("pressure beyond what the tissue holds", 70, ["limit point"],
        {"-cavity_hole_law": "pressure", "-cavity_hole_pressure": "1e5"}, ranks=(1, 2))

# Network and curve.
refuses("conduit of no cavity", 64, ["-conduits", "hale", "did you mean 'hole'"], {"-conduits": "leak:hale:outside"})
refuses("conduit without ends", 64, ["-conduits", "NAME:FROM:TO"], {"-conduits": "leak"})
refuses("conduit from a place to itself", 64, ["itself"], {"-conduits": "leak:hole:hole"})
refuses("conduit that does nothing", 64, ["-conduit_resistance", "leak"], {"-conduits": "leak:hole:outside"})
refuses("conduit of no needle", 64, ["-conduit_needle", "pin"],
        {"-conduits": "leak:hole:outside", "-conduit_leak_needle": "pin"})
refuses("hole without a needle", 64, ["-conduit_needle"],
        {"-conduits": "leak:hole:outside", "-conduit_leak_resistance": "1e9", "-conduit_leak_hole_radius": "1e-4"})


def apart(groups):
    """One wall for each of the holes."""
    groups["other"] = [f for f in groups["wall"] if min(f) > CORNERS // 2]
    groups["wall"] = [f for f in groups["wall"] if min(f) <= CORNERS // 2]


CORNERS = 6 ** 3
unlike = {"-mesh": block("unlike", {(1, 1, 1), (3, 3, 3)}, apart, n=5), "-cavities": "hole,second",
          "-cavity_second_surface": "other", "-conduits": "tube:hole:second", "-conduit_tube_resistance": "1e9",
          "-time_step": "0.1", "-time_end": "0.2", "-cavity_hole_law": "gas", "-cavity_hole_ambient_pressure": "1e5"}
refuses("conduit between gas and liquid", 64, ["-conduits", "tube", "unlike", "hole", "second"], unlike)
refuses("conduit between two gases", 64, ["-conduits", "tube", "unlike"],
        {**unlike, "-cavity_second_law": "gas", "-cavity_second_ambient_pressure": "9e4"})
process = run({**good, **unlike, "-cavity_second_law": "gas", "-cavity_second_ambient_pressure": "1e5",
               "-output_dir": os.path.join(FOLDER, "alike")}, 2)
check(process.returncode == 0, f"a conduit between like gases runs: {process.returncode} {process.stderr[-300:]}")
refuses("P-V curve without a cavity", 64, ["pv_curve"], {"-analysis": "pv_curve", "-cavities": '""'},
        remove=["-cavity_hole_surface"])
refuses("P-V curve on one side", 64, ["-pv_low"], {"-analysis": "pv_curve", "-pv_low": "1.1"})
refuses("P-V curve of no cavity", 64, ["-pv_cavity", "hale"], {"-analysis": "pv_curve", "-pv_cavity": "hale"})

# Prescribed fields.
refuses("field without a node", 65, ["field.csv", "missing"],
        {"-boundary_top_field": written("field.csv", "node,x,y,z\n1,0,0,0\n")},
        remove=["-boundary_top_displacement"])
refuses("field beside a displacement", 64, ["-boundary_top_field"],
        {"-boundary_top_field": os.path.join(FOLDER, "field.csv")})
finish()
