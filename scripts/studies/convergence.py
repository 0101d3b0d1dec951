"""Convergence of any scene: its mesh made anew at several sizes, and what changes with it.

usage: scripts/study convergence options/NAME.opts [--elements p1,p2] [--levels 3] [--factor 1.6]
           [--start 1] [--probe x,y,z …] [--curved] [--limit SECONDS] [--quick]
           [options of the program, last]
Writes results/convergence/NAME/{levels.csv,orders.csv,convergence.png}.
"""
import argparse
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np

from common import ROOT, save
from quantities import measure
from remesh import Scene, split_arguments
from richardson import judge


def arguments():
    own, options = split_arguments(sys.argv[1:])
    parser = argparse.ArgumentParser(prog="scripts/study convergence", allow_abbrev=False)
    parser.add_argument("file", nargs="?", default="options/phantom.opts")
    parser.add_argument("--elements", default="p1,p2", help="-tissue_element of the runs")
    parser.add_argument("--levels", type=int, default=3)
    parser.add_argument("--factor", type=float, default=1.6, help="from one edge length to the next")
    parser.add_argument("--start", type=float, default=1.0,
                        help="coarsest edge length over the scene's own")
    parser.add_argument("--probe", action="append", default=[], metavar="x,y,z", help="[m]")
    parser.add_argument("--curved", action="store_true",
                        help="gmsh puts the middle nodes of p2 meshes on curved walls")
    parser.add_argument("--limit", type=float, help="seconds after which a run is given up")
    parser.add_argument("--quick", action="store_true", help="three coarse meshes close together")
    given = parser.parse_args(own)
    if given.levels < 2 or given.factor <= 1.0 or given.start <= 0.0:
        parser.error("at least two levels, a factor above 1 and a positive start are needed")
    if given.quick:
        given.start, given.factor, given.levels = 1.5 * given.start, 1.25, 3
    return given, options


def one_level(scene, element, level, scale, given, folder, probes):
    row = {"element": element, "level": level, "scale": scale, "seconds": 0.0, "failure": "",
           "nodes": 0, "tets": 0, "h": np.nan, "h_nodes": np.nan, "found": {}}
    curved = given.curved and element.startswith("p2")
    path, row["failure"] = scene.mesh(scale, 2 if curved else 1)
    if path:
        at = folder / f"{element}_{level}"
        row["seconds"], row["failure"] = scene.run(at, {
            "mesh": path, "tissue_element": element, "output_every": 1000000000,
            "output_fields": "displacement,stress,strain_energy"}, given.limit)
        if not row["failure"]:
            size, row["found"] = measure(at, probes)
            row |= size
    said = row["failure"] or f"{row['nodes']} nodes, {row['tets']} tets, {row['seconds']:.1f} s"
    print(f"{element} level {level} (edges x {scale:.4g}): {said}", flush=True)
    return row


def quantity_names(rows):
    """In the order of the runs, each once."""
    return list(dict.fromkeys(name for row in rows for name in row["found"]))


def judge_all(rows, elements):
    """One row per quantity and element."""
    verdicts = []
    for name in quantity_names(rows):
        for element in elements:
            mine = [r for r in rows if r["element"] == element]
            values = [r["found"].get(name, np.nan) for r in mine]
            verdict = judge(values, [r["h"] for r in mine])
            verdicts.append({"quantity": name, "element": element, "values": values,
                             "failed": sum(bool(r["failure"]) for r in mine)} | verdict)
    return verdicts


def cells(rows):
    """Levels as they go into the CSV."""
    names = quantity_names(rows)
    return [{"element": r["element"], "level": r["level"], "nodes": r["nodes"], "tets": r["tets"],
             "h_m": f"{r['h']:.6g}", "h_nodes_m": f"{r['h_nodes']:.6g}",
             "seconds": f"{r['seconds']:.1f}",
             **{name: f"{r['found'].get(name, np.nan):.10g}" for name in names},
             "failure": r["failure"]} for r in rows]


def verdict_cells(v):
    finite = [value for value in v["values"] if np.isfinite(value)]
    return {"quantity": v["quantity"], "element": v["element"],
            "finest": f"{finite[-1]:.6g}" if finite else "nan", "order": f"{v['order']:.2f}",
            "extrapolated": f"{v['limit']:.6g}", "GCI_percent": f"{100 * v['gci']:.3g}",
            "behaviour": v["behaviour"], "failed_runs": v["failed"]}


def write_csv(path, rows):
    with open(path, "w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def show(rows, verdicts):
    """One block per quantity: its values from coarse to fine, and the verdict."""
    for r in rows:
        print(f"{r['element']} level {r['level']}: h {1e3 * r['h']:.4g} mm, by nodes "
              f"{1e3 * r['h_nodes']:.4g} mm{', ' + r['failure'] if r['failure'] else ''}")
    for name in quantity_names(rows):
        print(f"\n{name}")
        for v in (v for v in verdicts if v["quantity"] == name):
            print(f"  {v['element']:<8}" + " ".join(f"{value:>12.6g}" for value in v["values"])
                  + f" | order {v['order']:.2f}, limit {v['limit']:.6g}, "
                  f"GCI {100 * v['gci']:.2g} %, {v['behaviour']}")


def reference(verdicts, name):
    """The verdict of the element that is surest of the limit; None when none knows it to 10 %.

    A GCI from values that oscillate or an order by chance counts three times.
    """
    sure = [v for v in verdicts if v["quantity"] == name and v["gci"] <= 0.1]
    return min(sure, key=lambda v: v["gci"] * (1 if v["behaviour"] == "monotone" else 3),
               default=None)


def draw(path, scene, rows, verdicts, elements):
    names = [n for n in quantity_names(rows) if reference(verdicts, n)]
    if not names:
        print("\nno quantity has a limit to 10 %: no picture")
        return False
    across = min(3, len(names))
    down = -(-len(names) // across)
    figure, axes = plt.subplots(down, across, figsize=(4.2 * across, 3.6 * down),
                                constrained_layout=True, squeeze=False)
    for axis in axes.flat[len(names):]:
        axis.set_visible(False)
    for name, axis in zip(names, axes.flat):
        sure = reference(verdicts, name)
        for k, element in enumerate(elements):
            mine = [r for r in rows if r["element"] == element and name in r["found"]]
            verdict = next(v for v in verdicts if (v["quantity"], v["element"]) == (name, element))
            order = f", order {verdict['order']:.1f}" if np.isfinite(verdict["order"]) else ""
            error = [abs(r["found"][name] - sure["limit"]) for r in mine]
            axis.loglog([1e3 * r["h_nodes"] for r in mine], error, "o-", ms=4, color=f"C{k}",
                        label=element + order)
        slopes(axis)
        words, unit = name.split(" [")
        axis.set(xlabel="h = (volume / nodes)$^{1/3}$ [mm]", ylabel=f"difference [{unit}")
        axis.set_title(f"{words}: limit {sure['limit']:.4g} by {sure['element']}", fontsize=9)
        axis.grid(alpha=0.3, which="both")
        axis.legend(frameon=False, fontsize=8)
    figure.suptitle(f"{scene.name}: |value − extrapolated value|, dotted: slopes 1 and 2")
    save(figure, path)
    return True


def slopes(axis):
    """Dotted lines of slope 1 and 2 through the middle of what is drawn."""
    lines = axis.get_lines()
    x = np.concatenate([line.get_xdata() for line in lines])
    y = np.concatenate([line.get_ydata() for line in lines])
    y = y[y > 0]
    if not len(y):
        return
    ends, at = np.array([x.min(), x.max()]), np.sqrt(x.min() * x.max())
    level = np.exp(np.log(y).mean())
    for slope in (1, 2):
        axis.plot(ends, level * (ends / at) ** slope, ":", lw=0.9, color="#6b6b6b")
        axis.annotate(str(slope), (ends[1], level * (ends[1] / at) ** slope), fontsize=8,
                      color="#6b6b6b", xytext=(2, 0), textcoords="offset points", va="center")
    axis.xaxis.set_minor_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axis.xaxis.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axis.tick_params(axis="x", which="both", labelsize=7)


def main():
    given, options = arguments()
    scene = Scene(given.file, options)
    folder = ROOT / "results/convergence" / scene.name
    folder.mkdir(parents=True, exist_ok=True)
    probes = [np.array([float(n) for n in text.split(",")]) for text in given.probe]
    elements = given.elements.split(",")
    rows = [one_level(scene, element, level, given.start / given.factor**level, given, folder, probes)
            for element in elements for level in range(given.levels)]
    for k, place in enumerate(probes, 1):
        print(f"probe {k}: {', '.join(f'{c:.6g}' for c in place)} m")
    if not quantity_names(rows):
        sys.exit("no run succeeded")
    verdicts = judge_all(rows, elements)
    show(rows, verdicts)
    write_csv(folder / "levels.csv", cells(rows))
    write_csv(folder / "orders.csv", [verdict_cells(v) for v in verdicts])
    drawn = draw(folder / "convergence.png", scene, rows, verdicts, elements)
    failed = sum(bool(r["failure"]) for r in rows)
    print(f"\nwrote {folder}/levels.csv, orders.csv{' and convergence.png' if drawn else ''}"
          + (f"; {failed} of {len(rows)} runs failed" if failed else ""))


main()
