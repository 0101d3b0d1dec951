"""What the step's linear algebra costs: factor, sweep and compliance columns on a gel bar.

Runs build/tests/compliance_bench at several sizes, each figure a median, beside the machine's own
rates, and the baseline of one MUMPS solve per column. Writes results/compliance/{compliance.csv,png}.
"""
import argparse
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from common import ROOT, write_table


def figures(dofs, repeats):
    """Figures of one size by name."""
    run = subprocess.run(["build/tests/compliance_bench", str(dofs), str(repeats)], cwd=ROOT,
                         check=True, capture_output=True, text=True)
    rows = [line.split(",") for line in run.stdout.splitlines()]
    return int(rows[0][0]), {name: float(value) for _, name, value, _ in rows}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true", help="4000 dofs only")
    parser.add_argument("--large", action="store_true", help="600000 dofs as well (8 GB, minutes)")
    args = parser.parse_args()
    folder = ROOT / "results/compliance"
    folder.mkdir(parents=True, exist_ok=True)
    sizes = [4000] if args.quick else [4000, 30000, 150000] + [600000] * args.large
    rows = []
    for size in sizes:
        dofs, f = figures(size, 5 if size < 100000 else 3)
        baseline = f["mumps_column"] * f["isolated_dofs"]
        rows.append({
            "dofs": dofs, "isolated": int(f["isolated_dofs"]),
            "dgemm_Gflops": f"{1e-9 * f['dgemm_rate']:.1f}",
            "read_GBs": f"{1e-9 * f['read_rate']:.1f}", "factor_MB": f"{1e-6 * f['factor_bytes']:.0f}",
            "first_operator_s": f"{f['first_operator']:.3g}", "sweep_ms": f"{1e3 * f['sweep']:.3g}",
            "sweep_of_read_rate": f"{2 * f['factor_bytes'] / f['sweep'] / f['read_rate']:.2f}",
            "step_over_sweep": f"{f['step_sweep'] / f['sweep']:.3f}",
            "columns_ms": f"{1e3 * f['columns_at_once']:.3g}",
            "columns_speedup": f"{baseline / f['columns_at_once']:.0f}",
            "pinned_ms": f"{1e3 * f['pinned_columns']:.3g}",
            "pinned_speedup": f"{baseline / f['pinned_columns']:.0f}",
            "twelve_ms": f"{1e3 * f['twelve_columns']:.3g}",
            "twelve_speedup": f"{12 * f['mumps_column'] / f['twelve_columns']:.0f}"})
    write_table(folder / "compliance.csv", rows)
    figure, axis = plt.subplots(figsize=(6, 4.2), constrained_layout=True)
    dofs = [row["dofs"] for row in rows]
    for key, label in (("columns_speedup", "all columns at once"), ("pinned_speedup", "pinned tube"),
                       ("twelve_speedup", "12 new columns")):
        axis.loglog(dofs, [float(row[key]) for row in rows], "o-", label=label)
    axis.set(xlabel="dofs", ylabel="times faster than one MUMPS solve per column",
             title="Isolated compliance, one core")
    axis.grid(alpha=0.3, which="both")
    axis.legend(frameon=False)
    figure.savefig(folder / "compliance.png", dpi=130)
    print(f"wrote {folder}/compliance.csv and compliance.png")


main()
