"""The whole program on damaged meshes, option files and CSVs: program.py PROGRAM ROOT [RUNS] [SEED]. Every run ends
within 10 s with 0, 64, 65, 70 or 74 and, but for 0, with exactly one error line."""
import collections
import os
import random
import re
import subprocess
import sys
import tempfile

PROGRAM, ROOT = sys.argv[1:3]
RUNS = int(sys.argv[3]) if len(sys.argv) > 3 else 300
random.seed(int(sys.argv[4]) if len(sys.argv) > 4 else 1)
FOLDER = tempfile.mkdtemp(prefix="trocar_fuzz_")
ODD = ["0", "-1", "1", "2", "3", "7", "2147483648", "-2147483649", "1e9", "9223372036854775808", "1e308", "1e999",
       "1e-300", "nan", "inf", "x", "", "1,2", "\x1b[31m", "é"]


def small_mesh(binary):
    path = os.path.join(FOLDER, "good.msh")
    subprocess.run([sys.executable, os.path.join(ROOT, "meshes", "structured_beam"), "--nodes", "5", "3", "3",
                    "--size", "0.04", "0.02", "0.02", "--split", "6", path], check=True)
    if binary:
        other = os.path.join(FOLDER, "binary.msh")
        subprocess.run(["gmsh", path, "-save", "-bin", "-format", random.choice(["msh22", "msh41"]), "-o", other],
                       check=True, capture_output=True)
        path = other
    with open(path, "rb") as stream:
        return stream.read()


def damaged(data, binary):
    """Some changes as people, programs and disks make them."""
    for _ in range(random.randint(1, 3)):
        kind = random.randrange(6)
        if kind == 0 and binary:
            at = random.randrange(len(data))
            data = data[:at] + random.choice([b"\0" * 8, b"\xff" * 8, os.urandom(4)]) + data[at + 8:]
        elif kind < 3:
            words = list(re.finditer(rb"[^\s,=]+", data))
            word = random.choice(words)
            data = data[:word.start()] + random.choice(ODD).encode() + data[word.end():]
        else:
            lines = data.splitlines(keepends=True)
            i, j = random.randrange(len(lines)), random.randrange(len(lines))
            if kind == 3:
                del lines[i]
            elif kind == 4:
                lines.insert(i, lines[j])
            else:
                lines[i], lines[j] = lines[j], lines[i]
            data = b"".join(lines)
    return data


SCENE = """-mesh MESH
-tissue_element p1 -fix x0
-boundary_x1_displacement 0.001,0,0
-boundary_x1_curve RAMP
-gravity 0, 0, -9.81
-time_step 0.01
-time_end 0.03
-tissue_young 5e3
-tissue_model corotational
-needles a
-needle_a_entry 0,0.01,0.01
-needle_a_length 0.05
-needle_a_velocity 0.5
-needle_a_depth 0.01
-insertion_friction_static 5
-insertion_friction_dynamic 5
-output_every 2
"""
RAMP = b"time,factor\n0,0\n0.01,0.5\n0.03,1\n"
ends, problems = collections.Counter(), []
for number in range(RUNS):
    target = ("mesh", "options", "csv")[number % 3]
    binary = target == "mesh" and number % 2 == 0
    files = {"mesh": small_mesh(binary), "csv": RAMP}
    scene = SCENE.replace("MESH", os.path.join(FOLDER, "mesh")).replace("RAMP", os.path.join(FOLDER, "csv"))
    files["options"] = scene.encode()
    files[target] = damaged(files[target], binary)
    for name, data in files.items():
        with open(os.path.join(FOLDER, name), "wb") as stream:
            stream.write(data)
    words = [PROGRAM, "-options_file", os.path.join(FOLDER, "options"), "-output_dir", os.path.join(FOLDER, "out")]
    try:
        process = subprocess.run(words, capture_output=True, timeout=10, cwd=FOLDER)
    except subprocess.TimeoutExpired:
        problems.append((number, target, "hangs"))
        continue
    ends[target, process.returncode] += 1
    lines = process.stderr.splitlines()
    wanted = 0 if process.returncode == 0 else 1
    if process.returncode not in (0, 64, 65, 70, 74) or len(lines) != wanted:
        problems.append((number, target, process.returncode, process.stderr[-300:]))
        kept = os.path.join(FOLDER, f"problem_{number}")
        os.makedirs(kept)
        for name, data in files.items():
            with open(os.path.join(kept, name), "wb") as stream:
                stream.write(data)
for (target, code), count in sorted(ends.items()):
    print(f"{target}: {count} runs ended with {code}")
for problem in problems:
    print("FAILED", problem)
print(f"{RUNS} runs, {len(problems)} problems" + (f", kept in {FOLDER}" if problems else ""))
sys.exit(1 if problems else 0)
