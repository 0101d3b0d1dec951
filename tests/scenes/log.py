"""What the log says: travel beside depth, the volume of curved meshes, what mends a folded one, and
the BLAS called slow only when it is."""
import math
import os
import re
import subprocess

from harness import FOLDER, check, error_lines, finish, options, run, small_block, written

small = {**options("small_insertion.opts"), "-mesh": small_block(),
         "-output_dir": os.path.join(FOLDER, "log")}

# The skin is pushed in: the needle travels, and its depth is 0.
lines = run({**small, "-insertion_puncture_force": "1000", "-time_end": "0.4"}).stdout.splitlines()
heads = next(line for line in lines if line.lstrip().startswith("step "))
check(heads.split()[1:7] == "time [s] travel [mm] depth [mm]".split(), f"travel stands beside depth {heads}")
last = [line.split() for line in lines if re.match(r" +\d+ +\d+\.\d+ ", line)][-1]
check(float(last[2]) == 8.0 and float(last[3]) == 0.0, f"8 mm of travel, no depth {last}")

# A thin shell whose curved edges fold its coarse tets, and the same with what the refusal names.
geometry = ('SetFactory("OpenCASCADE");\nSphere(1) = {0, 0, 0, 0.02};\nSphere(2) = {0, 0, 0, 0.0185};\n'
            "BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n"
            'Physical Volume("shell") = {3};\nPhysical Surface("all") = {Surface{:}};\n'
            "Mesh.MeshSizeMin = 0.014;\nMesh.MeshSizeMax = 0.014;\n")


def described(name, text, *arguments):
    """What the program says of a mesh of order 2."""
    path = os.path.join(FOLDER, name + ".msh")
    subprocess.run(["gmsh", "-3", "-order", "2", written(name + ".geo", text), *arguments, "-o", path,
                    "-format", "msh41"], check=True, capture_output=True)
    return run({"-mesh": path, "-fix": "all", "-analysis": "static", "-time_end": "0", "-check": ""},
               arguments=["-tissue_element", "p2"])


folded = described("folded", geometry)
check(folded.returncode == 65 and "folded by its curved edges" in folded.stderr, "a folded mesh is refused")
for name, text, arguments in (("option", geometry, ["-optimize_ho"]),
                              ("line", geometry + "Mesh.HighOrderOptimize = 2;\n", [])):
    for word in arguments or ["Mesh.HighOrderOptimize = 2;"]:
        check(word in error_lines(folded)[0], f"the refusal names {word}")
    mended = described(name, text, *arguments)
    check(mended.returncode == 0, f"which mends it {mended.stderr[-200:]}")
    volume = float(re.search(r"volume (\S+) m", mended.stdout).group(1))
    exact = 4 / 3 * math.pi * (0.02**3 - 0.0185**3)
    check(abs(volume / exact - 1) < 0.01, f"{name}: its volume is that of the shell, {volume:.4g} of {exact:.4g}")

# The reference BLAS is slow whoever looks; OpenBLAS is not on a machine with other things to do.
reference = "/usr/lib/x86_64-linux-gnu/blas"
plain = run({**small, "-check": ""})
check("dense products" in plain.stdout and "the BLAS is slow" not in plain.stdout, "no warning of OpenBLAS")
if os.path.exists(reference + "/libblas.so.3"):
    slow = run({**small, "-check": ""}, environment={**os.environ, "LD_LIBRARY_PATH": reference})
    check(f"warning: the BLAS is slow ({reference}" in slow.stdout, "the reference BLAS is called slow, by its file")
busy = [subprocess.Popen(["sh", "-c", "while :; do :; done"]) for _ in range(4 * os.cpu_count())]
try:
    said = run({**small, "-check": ""}).stdout
finally:
    for process in busy:
        process.kill()
check("dense products" in said and "the BLAS is slow" not in said, "nor of it on a busy machine")
finish()
