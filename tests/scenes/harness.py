"""What the end-to-end tests share: running the program and reading its results."""
import itertools
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np

PROGRAM, ROOT = sys.argv[1], sys.argv[2]
FOLDER = tempfile.mkdtemp(prefix="trocar_test_")
MESHES = os.path.join(FOLDER, "meshes")
os.makedirs(MESHES)
problems = []
run_numbers = itertools.count()
refusals = []  # (what, code, words, run under way) of refusal()
pool = ThreadPoolExecutor(4)  # mpirun waits a second for the other ranks of one that fails


def structured(name, *arguments):
    """Makes a structured mesh and gives its path."""
    path = os.path.join(MESHES, name + ".msh")
    if not os.path.exists(path):
        tool = os.path.join(ROOT, "meshes", "structured_beam")
        subprocess.run([sys.executable, tool, *arguments, path], check=True)
    return path


def small_block():
    return structured("small_block", *"--nodes 7 5 5 --size 0.06 0.04 0.04 --split 5".split())


def geometry(name):
    """Makes the mesh of meshes/NAME.geo and gives its path."""
    path = os.path.join(MESHES, name + ".msh")
    if not os.path.exists(path):
        subprocess.run(["gmsh", "-3", os.path.join(ROOT, "meshes", name + ".geo"), "-o", path, "-format",
                        "msh41"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return path


def options(file):
    """Options of a file in options/ as a dict."""
    found = {}
    with open(os.path.join(ROOT, "options", file)) as stream:
        for line in stream:
            words = line.split("#")[0].split(None, 1)
            if words:
                found[words[0]] = words[1].strip() if len(words) > 1 else ""
    return found


def run(settings, ranks=1, arguments=(), timeout=900, environment=None):
    """Runs the program; settings is a dict of options. Gives the completed process. Tets are linear
    unless the settings say otherwise: most tests are about other things and are quicker so."""
    words = [] if "-tissue_element" in [*settings, *arguments] else ["-tissue_element", "p1"]
    for name, value in settings.items():
        words += [name] + ([value] if value != "" else [])
    launcher = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
    return subprocess.run([*launcher, PROGRAM, *words, *arguments], cwd=ROOT, capture_output=True,
                          text=True, timeout=timeout, env=environment)


def completed(settings, ranks=1, **more):
    """Runs and demands success; gives the folder of the results."""
    folder = os.path.join(FOLDER, f"run_{next(run_numbers)}")
    process = run({**settings, "-output_dir": folder, "-quiet": ""}, ranks, **more)
    if process.returncode != 0:
        print(process.stdout[-2000:], process.stderr[-2000:])
        raise SystemExit(f"run failed with {process.returncode}")
    return folder


def written(name, text):
    """A file in the test's folder; gives its path."""
    path = os.path.join(FOLDER, name)
    with open(path, "w") as stream:
        stream.write(text)
    return path


def refusal(scene):
    """A check that changes of a scene are refused with a code and one line holding all words. Runs
    beside others; finish() waits for it and says what came of it."""
    def refuses(what, code, words, changes, remove=(), ranks=(2,)):
        settings = {key: value for key, value in {**scene, **changes}.items() if key not in remove}
        for n in ranks:
            if "-output_dir" not in changes and "-output_dir" not in remove:
                settings["-output_dir"] = os.path.join(FOLDER, f"refused_{len(refusals)}")
            process = pool.submit(run, dict(settings), n, environment=dict(os.environ))
            refusals.append((f"{what} on {n} ranks", code, words, process))
    return refuses


def check_refusals():
    for what, code, words, future in refusals:
        process = future.result()
        lines = error_lines(process)
        good = process.returncode == code and len(lines) == 1 and all(w in lines[0] for w in words)
        check(good, f"{what}: {process.returncode} {lines}")
    refusals.clear()


def histories(folder):
    """All histories but wall times, by name."""
    found = {}
    with h5py.File(os.path.join(folder, "run.h5")) as run_file:
        def keep(name, node):
            if isinstance(node, h5py.Dataset) and "seconds" not in name:
                found[name] = node[...]
        run_file["history"].visititems(keep)
    return found


def ledger(folder):
    with h5py.File(os.path.join(folder, "run.h5")) as run_file:
        return {name: int(value) for name, value in run_file["ledger"].attrs.items()}


def check(condition, what):
    print(("ok      " if condition else "FAILED  ") + what)
    if not condition:
        problems.append(what)


def error_lines(process):
    return [line for line in process.stderr.splitlines() if line.startswith("trocar: error: ")]


def finish():
    check_refusals()
    shutil.rmtree(FOLDER, ignore_errors=True)
    raise SystemExit(1 if problems else 0)
