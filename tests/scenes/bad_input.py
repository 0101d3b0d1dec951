"""Bad input: one clear line, the right exit code, no hang, nothing else."""
import os
import stat

from harness import (FOLDER, check, error_lines, finish, options, refusal, run, small_block,
                     structured, written)

small = options("small_insertion.opts")
small.update({"-mesh": small_block(), "-output_dir": os.path.join(FOLDER, "bad"), "-time_end": "0.1"})


refuses = refusal(small)
tet = ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"a\"\n$EndPhysicalNames\n"
       "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
       "$Elements\n1\n77 4 2 1 1 CORNERS\n$EndElements\n")

refuses("missing mesh", 65, ["nowhere.msh"], {"-mesh": "nowhere.msh"}, ranks=(1, 3))
refuses("no mesh option", 64, ["-mesh"], {}, remove=["-mesh"])
refuses("empty mesh", 65, ["empty.msh", "empty"], {"-mesh": written("empty.msh", "")})
refuses("two meshes with one group", 65, ["beam", "group of", "another name"],
        {"-mesh": small_block() + "," + small_block()}, ranks=(1, 3))
refuses("second mesh missing", 65, ["nowhere.msh"], {"-mesh": small_block() + ",nowhere.msh"}, ranks=(1, 3))
refuses("broken mesh", 65, ["broken.msh"], {"-mesh": written("broken.msh", tet[:150])})
refuses("inverted tet", 65, ["77", "inverted"],
        {"-mesh": written("inverted.msh", tet.replace("CORNERS", "1 3 2 4"))})
nodes = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0),
         (0, 0, 0.5), (0, 0.5, 0.5), (0.5, 0, 0.5)]  # Gmsh's order


def quadratic_tet(face, moved=None):
    """A file with one tet of order 2, its middle 5 moved, and one triangle of the group "base"."""
    at = [moved if moved and i == 4 else x for i, x in enumerate(nodes)]
    return ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 2 \"base\"\n3 1 \"a\"\n"
            "$EndPhysicalNames\n$Nodes\n10\n"
            + "".join(f"{i + 1} {x} {y} {z}\n" for i, (x, y, z) in enumerate(at))
            + f"$EndNodes\n$Elements\n2\n7 {face}\n77 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n")


refuses("triangle of another order", 65, ["base", "7", "another order"],
        {"-mesh": written("orders.msh", quadratic_tet("2 2 2 2 1 3 2"))})
refuses("folded tet", 65, ["77", "folded", "-optimize_ho", "Mesh.HighOrderOptimize"],
        {"-mesh": written("folded.msh", quadratic_tet("9 2 2 2 1 3 2 7 6 5", (0.5, 0.6, 0.6)))})
refuses("mesh scale of zero", 64, ["-mesh_scale"], {"-mesh_scale": "0"})
refuses("unknown surface", 65, ["z9", "did you mean 'z"], {"-fix": "z9"})
for name, words in (("-fix", {"-fix": "beam"}), ("traction", {"-boundary_beam_traction": "1,0,0"}),
                    ("displacement", {"-boundary_beam_displacement": "1,0,0"})):
    refuses(name + " of a volume", 65, ["'beam' is a volume", "x0, x1, y0, y1, z0, z1"], words)
refuses("bad axes", 64, ["-fix", "z0:q"], {"-fix": "z0:q"})
refuses("unknown boundary surface", 65, ["bottom"], {"-boundary_bottom_traction": "1,0,0"})
refuses("unknown volume in an override", 64, ["-tissue_liver_young", "did you mean"],
        {"-tissue_liver_young": "100"})
refuses("override of no needle", 64, ["-needle_b_depth"], {"-needle_b_depth": "0.01"})
refuses("no supports in statics", 64, ["-fix"], {"-analysis": "static"}, remove=["-fix"])
refuses("no supports for an equilibrium", 64, ["-fix"], {"-time_initial": "equilibrium", "-fix": "z0:z"})
refuses("negative puncture force", 64, ["-insertion_puncture_force", "-1"],
        {"-insertion_puncture_force": "-1"})
refuses("puncture force of no surface", 64, ["-insertion_z9_puncture_force"],
        {"-insertion_z9_puncture_force": "1"})
refuses("bevel beyond a right angle", 64, ["-needle_bevel"], {"-needle_bevel": "2"})
refuses("negative modulus", 64, ["-tissue_young", "-5"], {"-tissue_young": "-5"})
refuses("Poisson's ratio of 0.5", 64, ["-tissue_poisson"], {"-tissue_poisson": "0.5"})
refuses("NaN", 64, ["-tissue_density", "nan"], {"-tissue_density": "nan"})
refuses("unknown element", 64, ["-tissue_element", "did you mean 'p2"], {"-tissue_element": "p2_ann"})
refuses("BDF2 in statics", 64, ["-time_scheme bdf2"], {"-time_scheme": "bdf2", "-analysis": "static"})
refuses("two tangents of linear tissue", 64, ["-tissue_tangent exact"],
        {"-tissue_tangent": "exact", "-tissue_model": "linear"})
refuses("locking gauge without cavity", 64, ["-locking_gauge"], {"-locking_gauge": ""})
refuses("radius correction of the eta law", 64, ["-insertion_radius_correction", "-insertion_eta"],
        {"-insertion_radius_correction": "", "-insertion_eta": "0.5"})
refuses("sizes that cannot be written", 74, ["-error_size_field", "no_such_folder"],
        {"-error_estimate": "", "-error_target": "0.1", "-error_size_field": "no_such_folder/s.pos"})
refuses("sizes without a target", 64, ["-error_size_field", "-error_target"],
        {"-error_size_field": "sizes.pos"})
refuses("words for a number", 64, ["-time_step", "fast"], {"-time_step": "fast"})
refuses("stale without a factor of our own", 64, ["-compliance_reuse stale", "supernodal"],
        {"-compliance_reuse": "stale", "-compliance_provider": "ksp"})
refuses("stale error of what is exact", 64, ["-compliance_stale_error", "-compliance_reuse stale"],
        {"-compliance_stale_error": ""})
refuses("lag below round-off", 64, ["-compliance_lag", "1e-12"], {"-compliance_lag": "1e-15"})
refuses("negative lag", 64, ["-compliance_lag"], {"-compliance_lag": "-1"})
refuses("unknown choice", 64, ["-constraint_solver", "did you mean 'hybrid'"],
        {"-constraint_solver": "hybird"})
refuses("unknown option", 64, ["-needle_deph", "did you mean '-needle_depth'"], {"-needle_deph": "1"})
refuses("misspelt solver option", 64, ["-tissue_ksp_rtoll", "did you mean '-tissue_ksp_rtol'"],
        {"-tissue_ksp_rtoll": "1e-8", "-tissue_ksp_type": "cg", "-tissue_pc_type": "jacobi"})
refuses("unknown field", 64, ["-output_fields", "displacement"], {"-output_fields": "displacment"})
refuses("needle beside the mesh", 65, ["never meets"], {"-needle_entry": "0,0.5,0.5"})
refuses("needle pointing away", 65, ["start inside"], {"-needle_direction": "-1,0,0", "-needle_entry": "-0.01,0.02,0.02"})
refuses("inserted beside the mesh", 65, ["needle 'needle'"],
        {"-needle_inserted": "0.01", "-needle_entry": "0,0.5,0.5"})
refuses("base in the tissue", 65, ["base would enter"], {"-needle_depth": "0.2"})
refuses("direction of length 0", 64, ["-needle_direction"], {"-needle_direction": "0,0,0"})
refuses("needle name that is an option", 64, ["withdraw"], {"-needles": "withdraw"})
refuses("tube wider inside", 64, ["-needle_inner_radius"], {"-needle_inner_radius": "0.001"})
refuses("missing CSV", 65, ["no.csv"], {"-needle_trajectory": "no.csv"})
start = "0,-0.08,0.02,0.02\n"
refuses("NaN in a CSV", 65, ["nan.csv", "line 3"],
        {"-needle_trajectory": written("nan.csv", "time,x,y,z\n" + start + "1,nan,0.02,0.02\n")})
refuses("CSV that begins elsewhere", 65, ["begins"],
        {"-needle_trajectory": written("off.csv", "time,x,y,z\n0,-0.07,0.02,0.02\n")})
refuses("CSV base in the tissue", 65, ["base would enter"],
        {"-needle_trajectory": written("in.csv", "time,x,y,z\n" + start + "1,0.01,0.02,0.02\n")})
refuses("CSV base through the tissue", 65, ["base would enter"],
        {"-needle_trajectory": written("through.csv", "time,x,y,z\n" + start + "1,0.2,0.02,0.02\n")})
refuses("CSV that never comes near", 65, ["never meets"],
        {"-needle_trajectory": written("far.csv", "time,x,y,z\n0,4.92,5,5\n1,4.95,5,5\n"),
         "-needle_entry": "5,5,5"})
refuses("entry inside with a CSV", 65, ["start inside"],
        {"-needle_trajectory": written("deep.csv", "time,x,y,z\n0,-0.05,0.02,0.02\n"),
         "-needle_entry": "0.03,0.02,0.02"})
line = {"-insertion_placement": "line"}
refuses("merging along a line", 64, ["-insertion_merge", "line"], {**line, "-insertion_merge": "0.1"})
refuses("radius correction along a line", 64, ["-insertion_radius_correction", "line"],
        {**line, "-insertion_radius_correction": ""})
refuses("grid of no line", 64, ["-insertion_line_kappa", "line"], {"-insertion_line_kappa": "1"})
refuses("ring of no line", 64, ["-insertion_line_ring", "line"], {"-insertion_line_ring": "1"})
refuses("crowded line", 64, ["-insertion_spacing", "1e5"], {**line, "-insertion_spacing": "1e-9"})
for fine in ({"-insertion_line_kappa": "0.2"}, {"-insertion_spacing": "1e-5"}):
    process = run({**small, **line, **fine, "-time_end": "0.1", "-output_dir": os.path.join(FOLDER, "fine")})
    check(process.returncode in (0, 70) and "alternate" in process.stdout + process.stderr, f"said of {fine}")
refuses("dashpots without time", 64, ["-insertion_friction_viscous"],
        {"-analysis": "static", "-time_end": "0", "-insertion_friction_viscous": "1"})
refuses("negative withdrawal friction", 64, ["_withdraw"], {"-insertion_friction_static_withdraw": "-0.5"})
refuses("CSV with time running back", 65, ["time does not increase"],
        {"-needle_trajectory": written("back.csv", "time,x,y,z\n" + start + start)})
refuses("curve without a load", 64, ["-boundary_z1_curve"], {"-boundary_z1_curve": "no.csv"})
refuses("folder that cannot be made", 74, ["/proc/none"], {"-output_dir": "/proc/none"})
refuses("file where the folder should be", 74, ["taken"],
        {"-output_dir": written("taken", "") + "/results"})
refuses("solver that cannot converge", 70, ["did not converge"],
        {"-tissue_ksp_type": "cg", "-tissue_pc_type": "none", "-tissue_ksp_max_it": "2",
         "-time_end": "0.5", "-gravity": "0,0,-9.81"}, ranks=(1, 3))
refuses("preconditioner alone as a solver", 64, ["preonly"],
        {"-tissue_ksp_type": "preonly", "-tissue_pc_type": "jacobi"})
refuses("constraint solver out of sweeps", 70, ["pgs did not converge"],
        {"-constraint_solver": "pgs", "-constraint_max_iterations": "1", "-needle_inserted": "0.03",
         "-gravity": "0,0,-9.81", "-insertion_placement": "spacing", "-insertion_spacing": "0.002"})
refuses("step too long to take", 70, ["inside out"],
        {"-tissue_model": "corotational", "-gravity": "0,0,-9e8", "-time_step": "10", "-time_end": "10"})

os.environ["PETSC_OPTIONS"] = "-options_file options/none.opts"
process = run(small)
del os.environ["PETSC_OPTIONS"]
check(process.returncode == 64 and len(error_lines(process)) == 1, "missing file in PETSC_OPTIONS")
process = run({"-options_file": "options/none.opts"})
check(process.returncode == 64 and len(error_lines(process)) == 1 and "none.opts" in process.stderr,
      f"missing options file: {process.returncode} {error_lines(process)}")

two = structured("two_parts", *"--nodes 5 3 3 --size 0.04 0.02 0.02 --split 6 --volumes a,b".split())
process = run({**small, "-mesh": two, "-tissue_a_young": "0"})
check(process.returncode == 64 and "-tissue_a_young" in process.stderr, "bad value in an override")

if os.geteuid() != 0:  # root writes everywhere
    closed = os.path.join(FOLDER, "closed")
    os.makedirs(closed)
    os.chmod(closed, stat.S_IRUSR | stat.S_IXUSR)
    refuses("folder without permission", 74, ["closed"], {"-output_dir": closed + "/x"})

# Contact.
touching = {"-obstacles": "floor", "-contact_pairs": "rest:z1:floor"}
refuses("pair of two words", 64, ["-contact_pairs", "NAME:SLAVE:MASTER"], {"-contact_pairs": "rest:z1"})
refuses("unknown slave", 65, ["zz1", "z1"], {**touching, "-contact_pairs": "rest:zz1:floor"}, ranks=(1, 3))
refuses("unknown master", 65, ["rest", "flour", "floor"], {**touching, "-contact_pairs": "rest:z1:flour,b:z0:floor"})
refuses("slave is master", 65, ["rest", "z1", "nodes in common"], {"-contact_pairs": "rest:z1:z1"})
refuses("obstacle of nobody", 64, ["-obstacles", "floor"], {"-obstacles": "floor"})
refuses("negative friction of contact", 64, ["-contact_friction"], {**touching, "-contact_friction": "-0.1"})
refuses("shear limit without friction", 64, ["-contact_shear_limit", "rest"], {**touching, "-contact_shear_limit": "10"})
refuses("sphere without radius", 64, ["-obstacle_floor_radius"], {**touching, "-obstacle_floor_shape": "sphere"})
refuses("plane with radius", 64, ["-obstacle_floor_radius"], {**touching, "-obstacle_floor_radius": "1"})
refuses("plane without normal", 64, ["-obstacle_floor_normal"], {**touching, "-obstacle_floor_normal": "0,0,0"})
refuses("friction of an unknown pair", 64, ["-contact_reft_friction"], {**touching, "-contact_reft_friction": "0.1"})
refuses("two pairs of one name", 64, ["rest"], {**touching, "-contact_pairs": "rest:z1:floor,rest:z0:floor"})
refuses("slave of two pairs", 65, ["again", "z1"], {**touching, "-contact_pairs": "rest:z1:floor,again:z1:floor"})
refuses("slave that is held", 65, ["rest", "z0"], {**touching, "-contact_pairs": "rest:z0:floor"}, ranks=(1, 3))
refuses("curve of an obstacle without its columns", 65, ["wall.csv", "time,x,y,z"],
        {**touching, "-obstacle_floor_curve": written("wall.csv", "time,x\n0,0\n")}, ranks=(1, 3))
refuses("obstacle named like a surface", 64, ["z0", "surface"], {"-obstacles": "z0", "-contact_pairs": "rest:z1:z0"})
refuses("curve of an obstacle with columns exchanged", 65, ["swapped.csv", "time,x,y,z"],
        {**touching, "-obstacle_floor_curve": written("swapped.csv", "time,z,y,x\n0,0,0,0\n")})
refuses("obstacle deep in the tissue", 65, ["rest", "overlap by 0.01", "search"],
        {**touching, "-obstacle_floor_normal": "0,0,-1", "-obstacle_floor_origin": "0,0,0.03",
         "-contact_search": "0.004"}, ranks=(1, 3))
def stl(name, faces):
    """A text STL file of a tet's faces, each three of its corners."""
    x = ["0 0 -0.2", "0.1 0 -0.2", "0 0.1 -0.2", "0 0 -0.1"]
    return written(name, "solid a\n" + "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x[k]}\n" for k in face) + "endloop\nendfacet\n"
        for face in faces) + "endsolid a\n")


closed = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
rigid = {**touching, "-obstacle_floor_shape": "surface"}
refuses("rigid surface without a file", 64, ["-obstacle_floor_file", "STL"], rigid)
refuses("file of a plane", 64, ["-obstacle_floor_file", "surface"], {**touching, "-obstacle_floor_file": stl("plane.stl", closed)})
refuses("radius of a rigid surface", 64, ["-obstacle_floor_radius"],
        {**rigid, "-obstacle_floor_file": stl("closed.stl", closed), "-obstacle_floor_radius": "1"})
refuses("open rigid surface", 65, ["open.stl", "open at", "closed"], {**rigid, "-obstacle_floor_file": stl("open.stl", closed[:3])}, ranks=(1, 3))
refuses("rigid surface inside out", 65, ["inside.stl", "inside out"],
        {**rigid, "-obstacle_floor_file": stl("inside.stl", [face[::-1] for face in closed])}, ranks=(1, 3))
refuses("rigid surface with a turned triangle", 65, ["turned.stl", "turned against"],
        {**rigid, "-obstacle_floor_file": stl("turned.stl", closed[:3] + [closed[3][::-1]])})
refuses("no STL", 65, ["no.stl", "no STL file"], {**rigid, "-obstacle_floor_file": written("no.stl", "hello\n")})
refuses("STL cut off", 65, ["cut.stl", "endsolid"], {**rigid, "-obstacle_floor_file": written("cut.stl", "solid a\nfacet normal 0 0 1\n")})
refuses("STL vertex of two numbers", 65, ["two.stl", "line 3", "vertex"],
        {**rigid, "-obstacle_floor_file": written("two.stl", "solid a\nfacet normal 0 0 1\nvertex 0 1\nendsolid\n")})
refuses("fields of no contact", 64, ["-output_fields", "contact"], {"-output_fields": "contact"})
refuses("friction of no contact", 64, ["-contact_friction"], {"-contact_friction": "0.3"})
refuses("few linearisations and contact", 64, ["-time_newton_max", "-contact_pairs"], {**touching, "-time_newton_max": "2"})
refuses("stale contact", 64, ["stale", "-contact_pairs"], {**touching, "-compliance_reuse": "stale", "-tissue_model": "corotational"})
refuses("eta and contact", 64, ["-insertion_eta", "-contact_pairs"], {**touching, "-insertion_eta": "0.5"},
        remove=["-insertion_friction_static", "-insertion_friction_dynamic"])

unwritten = os.path.join(FOLDER, "unwritten")
process = run({**small, "-check": "", "-output_dir": unwritten})
check(process.returncode == 0 and not os.path.exists(unwritten),
      "-check stops after set-up and writes nothing")
finish()
