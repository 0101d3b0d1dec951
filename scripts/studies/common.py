"""What studies share: running the program, reading results, writing tables."""
import argparse
import csv
import subprocess
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parents[2]


def begin(name, quick):
    """Reads --quick (what it does, in words) and makes results/NAME; gives both."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help=quick)
    folder = ROOT / "results" / name
    folder.mkdir(parents=True, exist_ok=True)
    return parser.parse_args().quick, folder


def run(options_file, folder, changes, ranks=1):
    """One run of an option file with changes; gives the open run.h5. Stops on failure."""
    words = []
    for name, value in changes.items():
        words += [f"-{name}", str(value)]
    launcher = ["mpirun", "-q", "-n", str(ranks)] if ranks > 1 else []
    subprocess.run(
        [*launcher, "build/trocar", "-options_file", f"options/{options_file}",
         "-output_dir", str(folder), "-quiet", *words], cwd=ROOT, check=True)
    return h5py.File(folder / "run.h5")


def write_table(path, rows):
    """CSV with a header line; rows are dicts with the same keys."""
    with open(path, "w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    for row in [rows[0].keys()] + [r.values() for r in rows]:
        print("  ".join(f"{str(cell):>16.16}" for cell in row))


def mesh(geometry, name, **numbers):
    """A mesh of meshes/GEOMETRY.geo with other numbers, below build/meshes; gives its path."""
    path = f"build/meshes/{name}.msh"
    words = [word for key, value in numbers.items() for word in ("-setnumber", key, str(value))]
    subprocess.run(["gmsh", "-3", f"meshes/{geometry}.geo", *words, "-o", path, "-format", "msh41"],
                   cwd=ROOT, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return path


def last_field(folder):
    """Displacement of the last field file of a run."""
    with h5py.File(sorted((folder / "fields").glob("step_*.h5"))[-1]) as step:
        return step["displacement"][:]


def save(figure, path, dpi=130):
    """Writes a picture. Logarithmic axes show a decade at least: on less their labels run into each other."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            low, high = axis.get_view_interval()
            if axis.get_scale() != "log" or high > 10.5 * low:
                continue
            middle, half = (low * high) ** 0.5, 10.5 ** 0.5
            set_limits = axes.set_xlim if axis is axes.xaxis else axes.set_ylim
            set_limits(middle / half, middle * half)
    figure.savefig(path, dpi=dpi)
