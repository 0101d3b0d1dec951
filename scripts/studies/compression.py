"""The fluid paper's compression test: Young's modulus that plates read, slipping and bonded.

Writes results/compression/{compression.csv,compression.png}.
"""
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import ROOT, begin, run, write_table

AREA, HEIGHT, YOUNG = 0.04 * 0.04, 0.04, 15200.0


def main():
    quick, folder = begin("compression", "one mesh")
    rows = []
    figure, axis = plt.subplots(figsize=(5.5, 4.2), constrained_layout=True)
    for cells in [8] if quick else [4, 8, 16]:
        path = f"build/meshes/gelatin_{cells}.msh"
        nodes = [str(cells + 1)] * 3
        subprocess.run([sys.executable, "meshes/structured_beam", "--nodes", *nodes, "--size",
                        "0.04", "0.04", "0.04", "--split", "5", path], cwd=ROOT, check=True)
        for plates in ("slipping", "bonded"):
            for poisson in (0.3, 0.485):
                changes = {"mesh": path, "tissue_poisson": poisson}
                if plates == "bonded":
                    changes |= {"fix": "z0", "boundary_z1_displacement": "0,0,-0.006"}
                with run("compression_test.opts", folder / "run", changes) as r:
                    strain = 0.006 / HEIGHT * r["history/time"][:] / 5.0
                    stress = -r["history/boundary/z1/force"][:, 2] / AREA
                young = np.polyfit(strain, stress, 1)[0]
                rows.append({"cells": cells, "plates": plates, "poisson": poisson,
                             "E_read_Pa": f"{young:.6g}", "error": f"{young / YOUNG - 1:.2e}"})
                if cells == 8:
                    axis.plot(100 * strain, 1e-3 * stress, "o-", ms=3,
                              label=f"{plates}, ν = {poisson}: E = {1e-3 * young:.2f} kPa")
    write_table(folder / "compression.csv", rows)
    axis.set(xlabel="strain [%]", ylabel="stress [kPa]", title="Plate compression, E = 15.2 kPa")
    axis.grid(alpha=0.3)
    axis.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "compression.png", dpi=130)
    print(f"wrote {folder}/compression.csv and compression.png")


main()
