"""Adaptive meshes of any scene: runs until the estimated error is below a target, beside uniform ones.

usage: scripts/study adapt options/NAME.opts [--target 0.05] [--rounds 4] [--element p2]
           [--start 1] [--most 60000] [--limit SECONDS] [--quick] [options of the program]
Writes results/adapt/NAME/{adapt.csv,adapt.png}.
"""
import argparse
import re
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np

from common import ROOT, write_table
from remesh import Scene, make, split_arguments

NUMBER_LISTS = re.compile(r"S\w\(([^)]*)\)\{([^}]*)\}")


def arguments():
    own, options = split_arguments(sys.argv[1:])
    parser = argparse.ArgumentParser(prog="scripts/study adapt", allow_abbrev=False)
    parser.add_argument("file", nargs="?", default="options/phantom.opts")
    parser.add_argument("--target", type=float, default=0.05, help="error over the energy norm")
    parser.add_argument("--rounds", type=int, default=4, help="meshes by size field, at most")
    parser.add_argument("--element", default="p2", help="-tissue_element of the runs")
    parser.add_argument("--start", type=float, default=1.0,
                        help="edge length of the first mesh over the scene's own")
    parser.add_argument("--most", type=int, default=60000, help="nodes of a run, at most")
    parser.add_argument("--limit", type=float, help="seconds after which a run is given up")
    parser.add_argument("--quick", action="store_true", help="a coarse start, one round towards 2 %")
    given = parser.parse_args(own)
    if not 0.0 < given.target < 1.0 or given.rounds < 1:
        parser.error("a target between 0 and 1 and at least one round are needed")
    if given.quick:
        given.start, given.rounds, given.target = 1.5 * given.start, 1, min(given.target, 0.02)
    return given, options


def scaled_field(file, factor):
    """The size field, in the geometry's own unit as the program writes it, times `factor`; its smallest and
    largest size."""
    sizes = []

    def rewrite(found):
        size = [factor * float(n) for n in found[2].split(",")]
        sizes.extend(size)
        return "SS(" + found[1] + "){" + ",".join(f"{n:.9g}" for n in size) + "}"

    text = NUMBER_LISTS.sub(rewrite, file.read_text())
    copy = file.with_name(file.stem + "_scaled.pos")
    copy.write_text(text)
    return copy, min(sizes), max(sizes)


def order(element):
    """By how many powers of h the energy error of smooth stress falls."""
    return 2 if element.startswith("p2") else 1


def adapted_mesh(scene, file, path, factor):
    """The geometry meshed with a size field times `factor`; its path, or why there is none.

    A geometry sets limits and fields of its own, which overrule what gmsh's command line says
    (-bgm is still cut off by Mesh.CharacteristicLengthMin): so it is included and then overruled.
    """
    field, smallest, largest = scaled_field(file, factor)
    wrapper = path.with_suffix(".geo")
    wrapper.write_text(f'''Include "{scene.geometry}";
Merge "{field}";
Background Mesh View[0];
Mesh.CharacteristicLengthFromPoints = 0;
Mesh.CharacteristicLengthFromCurvature = 0;
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthMin = {smallest:.9g};
Mesh.CharacteristicLengthMax = {largest:.9g};
''')
    return make(["gmsh", "-3", str(wrapper), "-o", str(path), "-format", "msh41"], path)


def one_run(scene, given, mesh, folder, way, step, field=None):
    """A row of the table; its field 'failure' is empty when the run went well."""
    changes = {"mesh": mesh, "tissue_element": given.element, "error_estimate": "",
               "error_target": given.target, "output_fields": '""'}
    if field:
        changes["error_size_field"] = field
    seconds, failure = scene.run(folder, changes, given.limit)
    row = {"way": way, "round": step, "nodes": 0, "tets": 0, "error": np.nan,
           "target": given.target, "seconds": f"{seconds:.1f}", "failure": failure}
    if not failure:
        with h5py.File(folder / "run.h5") as r:
            row["nodes"], row["tets"] = len(r["mesh/coordinates"]), len(r["mesh/tets"])
            row["error"] = float(r["error_estimate/relative"][0])
        if row["error"] == 0.0:
            row["failure"] = failure = "no stress at the end of the run, no error to estimate"
    said = failure or f"{row['nodes']} nodes, error {100 * row['error']:.3g} %, {seconds:.1f} s"
    print(f"{way} {step}: {said}", flush=True)
    return row


def adapt(scene, given, folder):
    """Runs until the target is met, the mesh cannot be made, or it grows too large.

    Gmsh's edges and sizes that change fast leave a mesh short of what its sizes were for: the next
    ones are for less, from round to round until the target is met.
    """
    path, failure = scene.mesh(given.start)
    rows, asked = [], 1.0  # asked: error that sizes are for, over the target
    for step in range(given.rounds + 1):
        if failure:
            print(f"round {step}: {failure}; stopped here")
            break
        field = folder / f"sizes_{step}.pos"
        rows.append(one_run(scene, given, path, folder / f"adapted_{step}", "adapted", step, field))
        if rows[-1]["failure"] or rows[-1]["error"] <= given.target or step == given.rounds:
            break
        if step > 0:
            asked *= (given.target / rows[-1]["error"]) ** 0.5
        factor = asked ** (1.0 / order(given.element))
        path, failure = adapted_mesh(scene, field, folder / f"mesh_{step + 1}.msh", factor)
        if path and not failure:
            expected = rows[-1]["nodes"] / rows[-1]["tets"] * count_tets(path)
            if expected > given.most:
                failure = f"the next mesh would have about {expected:.0f} nodes (--most {given.most})"
    return rows


def count_tets(path):
    """Tets of a mesh in Gmsh 4.1 text: blocks of elements of type 4, or 11 with middles."""
    lines = iter(path.read_text().splitlines())
    while next(lines) != "$Elements":
        pass
    blocks, tets = int(next(lines).split()[0]), 0
    for _ in range(blocks):
        _, _, kind, count = (int(n) for n in next(lines).split())
        tets += count if kind in (4, 11) else 0
        for _ in range(count):
            next(lines)
    return tets


def uniform(scene, given, folder, adapted):
    """Uniform meshes with about the nodes of the adapted ones; the first mesh is both."""
    first = adapted[0]
    rows = [first | {"way": "uniform"}]
    power = 3.0  # nodes go with edge length to this power; coarse meshes with less
    for k, row in enumerate((r for r in adapted[1:] if not r["failure"]), 1):
        scale = (first["nodes"] / row["nodes"]) ** (1.0 / power)
        path, failure = scene.mesh(given.start * scale)
        if failure:
            print(f"uniform {k}: {failure}")
            continue
        rows.append(one_run(scene, given, path, folder / f"uniform_{k}", "uniform", k))
        if rows[-1]["nodes"] and abs(np.log(scale)) > 0.1:
            power = np.log(first["nodes"] / rows[-1]["nodes"]) / np.log(scale)
    return rows


def draw(path, scene, given, adapted, even):
    figure, axis = plt.subplots(figsize=(5.8, 4.4), constrained_layout=True)
    even = sorted(even, key=lambda r: r["nodes"])  # the adapted ones as one came from the other
    for rows, style, label in ((even, "s--", "uniform"), (adapted, "o-", "adapted")):
        good = [r for r in rows if not r["failure"]]
        axis.loglog([r["nodes"] for r in good], [100 * r["error"] for r in good], style, ms=5,
                    label=label)
    power = order(given.element)
    ends = np.array([min(r["nodes"] for r in adapted + even if not r["failure"]),
                     max(r["nodes"] for r in adapted + even if not r["failure"])])
    axis.loglog(ends, 100 * adapted[0]["error"] * (ends / adapted[0]["nodes"]) ** (-power / 3),
                color="#6b6b6b", lw=0.9, ls="--", label=f"slope −{power}/3 (smooth stress)")
    axis.axhline(100 * given.target, color="#6b6b6b", lw=0.9, ls=":", label="target")
    axis.set(xlabel="nodes", ylabel="estimated error of the energy norm [%]",
             title=f"{scene.name}, {given.element}")
    for one in (axis.xaxis, axis.yaxis):
        one.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
        one.set_minor_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axis.tick_params(which="both", labelsize=8)
    axis.xaxis.set_minor_locator(matplotlib.ticker.LogLocator(subs=(2, 3, 5, 7)))
    axis.grid(alpha=0.3, which="both")
    axis.legend(frameon=False)
    figure.savefig(path, dpi=130)


def main():
    given, options = arguments()
    scene = Scene(given.file, options)
    if not scene.geometry:
        sys.exit(f"mesh '{scene.source}' is structured: it cannot follow a size field")
    folder = ROOT / "results/adapt" / scene.name
    folder.mkdir(parents=True, exist_ok=True)
    adapted = adapt(scene, given, folder)
    if not adapted or adapted[0]["failure"]:
        sys.exit("the first run failed: nothing to adapt to")
    even = uniform(scene, given, folder, adapted)
    rows = [{**r, "error": f"{r['error']:.4g}"} for r in adapted + even[1:]]
    write_table(folder / "adapt.csv", rows)
    draw(folder / "adapt.png", scene, given, adapted, even)
    met = any(r["error"] <= given.target for r in adapted)
    print(f"the target of {100 * given.target:g} % was {'' if met else 'not '}met; "
          f"wrote {folder}/adapt.csv and adapt.png")


main()
