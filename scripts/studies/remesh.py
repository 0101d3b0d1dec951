"""Scenes made anew on other meshes: reading option files, meshing, runs that are allowed to fail."""
import os
import re
import subprocess
import sys
import time

import h5py
import numpy as np

from common import ROOT

MIDDLES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]  # edges of nodes 4 to 9, VTK's order



def split_arguments(words):
    """Arguments of a study, and behind them the options of the program as (name, value)."""
    first = next((k for k, w in enumerate(words) if re.match(r"-[A-Za-z]", w)), len(words))
    late = [w for w in words[first:] if w.startswith("--")]
    if late:
        sys.exit(f"{late[0]} is the study's: it goes before the program's own {words[first]}")
    return words[:first], read_options("\n".join(join_options(words[first:])))


def join_options(words):
    lines = []
    for word in words:
        if re.match(r"-[A-Za-z]", word):
            lines.append(word)
        elif lines:
            lines[-1] += " " + word
    return lines


def read_options(text):
    """Option file or its like as a dict; a flag has the value ''."""
    found = {}
    for line in text.splitlines():
        words = line.split("#")[0].split(None, 1)
        if words:
            found[words[0][1:]] = words[1].strip() if len(words) > 1 else ""
    return found


class Scene:
    """An option file with changes, and where its mesh comes from."""

    def __init__(self, file, changes):
        path = file if os.path.exists(file) else ROOT / file
        if not os.path.isfile(path):
            sys.exit(f"no option file '{file}'")
        self.file = os.path.abspath(path)
        self.name = os.path.splitext(os.path.basename(file))[0]
        self.changes = dict(changes)
        with open(path) as stream:
            options = read_options(stream.read()) | self.changes
        numbered = [name for name in options if re.fullmatch(r"boundary_.*field", name)]
        if numbered:
            sys.exit(f"-{numbered[0]} goes by node numbers: that scene cannot be meshed anew")
        self.scale = float(options.get("mesh_scale", 1.0))
        self.source = os.path.splitext(os.path.basename(options.get("mesh", "")))[0]
        self.geometry = ROOT / "meshes" / f"{self.source}.geo"
        self.structured = None
        if not self.geometry.exists():
            self.geometry, self.structured = None, structured_arguments(self.source)

    def mesh(self, scale, order=1):
        """Mesh whose edges are SCALE times those of the scene's own; its path, or why there is none."""
        curved = "_curved" if order == 2 and self.geometry else ""
        path = ROOT / "build/meshes/convergence" / f"{self.source}_{scale:.4g}{curved}.msh"
        path.parent.mkdir(parents=True, exist_ok=True)
        if self.geometry:
            words = ["gmsh", "-3", str(self.geometry), "-clscale", f"{scale:.6g}",
                     "-order", str(order), "-o", str(path), "-format", "msh41"]
        else:
            words = list(self.structured)
            at = words.index("--nodes") + 1
            for k in range(at, at + 3):
                words[k] = str(max(2, round((int(words[k]) - 1) / scale) + 1))
            words = [sys.executable, str(ROOT / "meshes/structured_beam"), *words, str(path)]
        return make(words, path)

    def run(self, folder, changes, limit=None):
        """One run with -quiet; its seconds and, when it failed, why ('' when it did not)."""
        words = ["-locking_gauge", "false"]  # a study of meshes shows it better, and times the run
        for name, value in (self.changes | changes).items():
            words += [f"-{name}", *([str(value)] if str(value) else [])]
        begin = time.monotonic()
        try:
            done = subprocess.run(
                ["build/trocar", "-options_file", self.file, "-output_dir", str(folder), "-quiet",
                 *words], cwd=ROOT, capture_output=True, text=True, timeout=limit)
        except subprocess.TimeoutExpired:
            return time.monotonic() - begin, f"stopped after {limit:g} s"
        seconds = time.monotonic() - begin
        if done.returncode == 0:
            return seconds, ""
        said = (done.stderr + done.stdout).strip().splitlines()
        return seconds, f"exit {done.returncode}: {said[-1] if said else 'nothing said'}"


def structured_arguments(name):
    for line in (ROOT / "meshes/structured.list").read_text().splitlines():
        words = line.split("#")[0].split()
        if words and words[0] == name:
            return words[1:]
    sys.exit(f"mesh '{name}' has neither meshes/{name}.geo nor a line in meshes/structured.list")


def make(words, path):
    """Runs a mesher; (path, '') or (None, why). An old mesh of that name is no result."""
    path.unlink(missing_ok=True)
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    if done.returncode == 0 and path.exists() and path.stat().st_size > 0:
        return path, ""
    errors = [line for line in (done.stdout + done.stderr).splitlines() if "rror" in line]
    said = errors[-1].strip() if errors else f"code {done.returncode}"
    return None, f"no mesh from {os.path.basename(words[0])}: {said}"


def derivatives(b):
    """Of the ten shape functions of a quadratic tet by its four barycentric coordinates."""
    d = np.zeros((10, 4))
    d[range(4), range(4)] = 4.0 * b - 1.0
    for k, (i, j) in enumerate(MIDDLES, 4):
        d[k, i], d[k, j] = 4.0 * b[j], 4.0 * b[i]
    return d


def volumes(x, tets):
    """Of all tets; curved ones by the five-point rule, which is exact for their Jacobian (cubic)."""
    if tets.shape[1] == 4:
        sides = x[tets[:, 1:]] - x[tets[:, :1]]
        return np.linalg.det(sides) / 6.0
    total = np.zeros(len(tets))
    for b, weight in [(np.full(4, 0.25), -0.8)] + [
            (np.where(np.arange(4) == k, 0.5, 1.0 / 6.0), 0.45) for k in range(4)]:
        by = np.einsum("ak,tac->tkc", derivatives(b), x[tets])
        total += weight / 6.0 * np.linalg.det(by[:, 1:] - by[:, :1])
    return total


def read_mesh(run):
    """Coordinates, tets and the tets' volumes of an open run.h5."""
    x, tets = run["mesh/coordinates"][:], run["mesh/tets"][:]
    return x, tets, volumes(x, tets)


def last_fields(folder):
    """The last field file of a run, open."""
    return h5py.File(sorted((folder / "fields").glob("step_*.h5"))[-1])
