"""Force-depth curves: reading CSV files strictly, writing them, taking them from a run."""
import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

REQUIRED = ("time", "depth", "force")
OPTIONAL = ("velocity", "run")
HALF_WINDOW = 4  # samples each side for a velocity from depths
LEAST_SAMPLES = 6 * HALF_WINDOW  # of a run, and of its advance


class DataError(Exception):
    """Data that cannot be used; the message is one line for the user."""


@dataclass
class Curve:
    """One insertion, SI: depth grows on the advance, force > 0 resists it."""

    name: str
    time: np.ndarray
    depth: np.ndarray
    force: np.ndarray
    velocity: np.ndarray  # as measured, or from the depths
    rate: np.ndarray  # from the depths: tells advance, hold and withdrawal apart
    file: str = ""


def slope(time, depth):
    """Velocity from depths over a few samples: single differences would be mostly noise."""
    at = np.arange(len(time))
    first = np.maximum(at - HALF_WINDOW, 0)
    last = np.minimum(at + HALF_WINDOW, len(time) - 1)
    return (depth[last] - depth[first]) / (time[last] - time[first])


def make_curve(name, time, depth, force, velocity=None, file=""):
    rate = slope(time, depth)
    return Curve(name, time, depth, force, rate if velocity is None else velocity, rate, file)


def check_header(file, header):
    for column in REQUIRED:
        if column not in header:
            raise DataError(f"{file} line 1: no column '{column}' (the header must be "
                            "time,depth,force[,velocity][,run])")
    for column in header:
        if column not in REQUIRED + OPTIONAL:
            raise DataError(f"{file} line 1: unknown column '{column}' (known: "
                            f"{', '.join(REQUIRED + OPTIONAL)})")
        if header.count(column) > 1:
            raise DataError(f"{file} line 1: column '{column}' twice")


def number(cell, where):
    try:
        value = float(cell)
    except ValueError:
        raise DataError(f"{where}: '{cell}' is not a number") from None
    if not math.isfinite(value):
        raise DataError(f"{where}: '{cell}' is not finite")
    return value


def read_rows(file):
    """Header and rows as (line number, cells); lines that begin with # are left out."""
    try:
        text = Path(file).read_text()
    except (OSError, UnicodeDecodeError) as failure:
        raise DataError(f"{file}: cannot be read ({type(failure).__name__})") from None
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1)
             if line.strip() and not line.startswith("#")]
    rows = [(k, [cell.strip() for cell in next(csv.reader([line]))]) for k, line in lines]
    if not rows:
        raise DataError(f"{file}: empty (a header line and rows are needed)")
    check_header(file, rows[0][1])
    if len(rows) == 1:
        raise DataError(f"{file}: no rows below the header")
    return rows[0][1], rows[1:]


def check_curve(curve, lines):
    """Refuses a run that is too short, jumps back in time or has its velocity's sign wrong."""
    file = curve.file
    back = np.flatnonzero(np.diff(curve.time) <= 0)
    if len(back):
        raise DataError(f"{file} line {lines[back[0] + 1]}, column time: time does not increase "
                        f"within run '{curve.name}'")
    if len(curve.time) < LEAST_SAMPLES:
        raise DataError(f"{file}: run '{curve.name}' has {len(curve.time)} rows, at least "
                        f"{LEAST_SAMPLES} are needed")
    fast = np.abs(curve.rate) > 0.2 * np.abs(curve.rate).max()
    wrong = np.flatnonzero(fast & (curve.velocity * curve.rate < 0))
    if len(wrong) > 0.1 * fast.sum():
        raise DataError(f"{file} line {lines[wrong[0]]}, column velocity: its sign contradicts the "
                        "depth (positive inwards, negative on withdrawal)")


def read_curves(file, name_files):
    """All runs of a CSV file. name_files: put the file's name before that of the run."""
    header, rows = read_rows(file)
    stem = Path(file).stem
    runs = {}
    for line, cells in rows:
        if len(cells) != len(header):
            raise DataError(f"{file} line {line}: {len(cells)} columns, the header has "
                            f"{len(header)}")
        row = dict(zip(header, cells))
        label = row.pop("run", stem)
        values = {c: number(cell, f"{file} line {line}, column {c}") for c, cell in row.items()}
        runs.setdefault(label, []).append((line, values))
    curves = []
    for label, entries in runs.items():
        lines = [line for line, _ in entries]
        column = {c: np.array([values[c] for _, values in entries]) for c in entries[0][1]}
        name = f"{stem}:{label}" if name_files and label != stem else label
        with np.errstate(divide="ignore", invalid="ignore"):  # equal times are refused below
            curve = make_curve(name, column["time"], column["depth"], column["force"],
                               column.get("velocity"), file)
        check_curve(curve, lines)
        curves.append(curve)
    return curves


def write_curves(file, curves, note=""):
    """CSV of curves without velocity: readers take it from the depths."""
    with open(file, "w") as stream:
        stream.write("".join(f"# {line}\n" for line in note.splitlines()))
        stream.write("time,depth,force,run\n")
        for curve in curves:
            for t, z, f in zip(curve.time, curve.depth, curve.force):
                stream.write(f"{t:.7g},{z:.7g},{f:.6g},{curve.name}\n")


def from_run(file, needle=""):
    """Curve of a run.h5: inserted path and the holder's force along the needle's direction."""
    import h5py  # only this needs it

    try:
        with h5py.File(file) as run:
            histories = run["history/needle"]
            needle = needle or next(iter(histories))
            if needle not in histories:
                raise DataError(f"{file}: no needle '{needle}' (there is: {', '.join(histories)})")
            names = [n.decode() for n in run["provenance/options/name"][:]]
            at = names.index(f"needle_{needle}_direction")
            text = run["provenance/options/value"][at].decode()
            direction = np.array([float(word) for word in text.split(",")])
            one = histories[needle]
            force = one["base_force"][:] @ (direction / np.linalg.norm(direction))
            return make_curve(Path(file).resolve().parent.name, run["history/time"][:],
                              one["depth"][:], force)
    except (OSError, KeyError, StopIteration, ValueError):
        raise DataError(f"{file}: not a run.h5 with a needle's history") from None
