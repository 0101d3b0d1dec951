"""What the step's linear algebra costs: factor, sweep, columns, assembly, whole steps on a gel bar.

Runs build/tests/compliance_bench and step_bench at several sizes, each figure a median, beside the
machine's own rates and the baseline of one MUMPS solve per column. Writes
results/compliance/{compliance,steps,busy}.csv and compliance.png.
"""
import argparse
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from common import ROOT, save, write_table


def figures(bench, *arguments):
    """Dofs and figures of one bench by name."""
    run = subprocess.run([f"build/tests/{bench}", *map(str, arguments)], cwd=ROOT, check=True,
                         capture_output=True, text=True)
    rows = [line.split(",") for line in run.stdout.splitlines()]
    return int(rows[0][0]), {name: float(value) for _, name, value, _ in rows}


def step_row(size, friction, with_columns):
    """Whole corotational steps, 5 degrees from the factor, against factoring in every step."""
    dofs, f = figures("step_bench", size, friction, int(with_columns))
    row = {"dofs": dofs, "friction_Nm": friction, "largest_turn_deg": f"{f['largest_turn']:.0f}",
           "rows": int(f["rows"]), "refactor_ms": f"{1e3 * f['refactor_step']:.4g}",
           "refactor_pinned_ms": f"{1e3 * f['refactor_pinned_step']:.4g}"}
    for lag in ("1e-3", "1e-4", "1e-6"):
        row[f"lag_{lag}_ms"] = f"{1e3 * f[f'lag_{lag}_step']:.3g}"
        row[f"lag_{lag}_passes"] = int(f[f"lag_{lag}_passes"])
        row[f"lag_{lag}_error"] = f"{f[f'lag_{lag}_error']:.1e}"
        row[f"lag_{lag}_speedup"] = f"{f['refactor_step'] / f[f'lag_{lag}_step']:.1f}"
    row["columns_ms"] = f"{1e3 * f['column_step']:.4g}" if with_columns else ""
    return row


def busy_row(size, others):
    """The same machine with other processes that only count beside."""
    beside = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(others)]
    try:
        _, f = figures("step_bench", size, 2.0, 0)
    finally:
        for process in beside:
            process.kill()
    return {"dofs": size, "busy_beside": others, "refactor_ms": f"{1e3 * f['refactor_step']:.4g}",
            "lag_1e-6_ms": f"{1e3 * f['lag_1e-6_step']:.3g}"}


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
        dofs, f = figures("compliance_bench", size, 5 if size < 100000 else 3)
        bound = f["assembly_bytes"] / f["triad_rate"]
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
            "twelve_speedup": f"{12 * f['mumps_column'] / f['twelve_columns']:.0f}",
            "assembly_ms": f"{1e3 * f['assembly_linear']:.3g}",
            "assembly_of_bound": f"{f['assembly_linear'] / bound:.2f}",
            "turned_assembly_ms": f"{1e3 * f['assembly_corotational']:.3g}",
            "turned_of_bound": f"{f['assembly_corotational'] / bound:.2f}",
            "p2_dofs": int(f["dofs_p2"]),
            "p2_assembly_ms": f"{1e3 * f['assembly_linear_p2']:.3g}",
            "p2_assembly_of_bound": f"{f['assembly_linear_p2'] / f['assembly_bytes_p2'] * f['triad_rate']:.2f}",
            "p2_turned_assembly_ms": f"{1e3 * f['assembly_corotational_p2']:.3g}",
            "p2_operator_ms": f"{1e3 * f['operator_p2']:.3g}",
            "memory_MB": f"{1e-6 * f['memory_peak']:.0f}",
            "memory_kB_per_dof": f"{1e-3 * f['memory_peak'] / dofs:.2f}",
            "estimate_error": f"{f['memory_estimate'] / f['memory_peak'] - 1:.3f}"})
    write_table(folder / "compliance.csv", rows)
    write_table(folder / "steps.csv", [step_row(size, friction, friction == 2.0 and size < 600000)
                                       for size in sizes for friction in (2.0, 10.0)])
    write_table(folder / "busy.csv", [busy_row(sizes[min(1, len(sizes) - 1)], others)
                                      for others in (0, 1, 2)])
    figure, axis = plt.subplots(figsize=(6, 4.2), constrained_layout=True)
    dofs = [row["dofs"] for row in rows]
    for key, label in (("columns_speedup", "all columns at once"), ("pinned_speedup", "corridor ordered last"),
                       ("twelve_speedup", "12 new columns")):
        axis.loglog(dofs, [float(row[key]) for row in rows], "o-", label=label)
    axis.set(xlabel="dofs", ylabel="times faster than one MUMPS solve per column",
             title="Isolated compliance, one core")
    axis.grid(alpha=0.3, which="both")
    axis.legend(frameon=False)
    save(figure, folder / "compliance.png")
    print(f"wrote {folder}/compliance.csv, steps.csv, busy.csv and compliance.png")


main()
