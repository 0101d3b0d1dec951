"""A pulsing vessel beside a closed cyst: amplitude and phase of the cyst's pressure against the linear
2 x 2 compliance, p_cyst = -C_21/C_22 p_vessel.

Writes results/pulsing_study/{pulsing.csv,pulsing.png}.
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from common import begin, run, write_table

SCENE, PERIOD = "pulsing_vessel.opts", 0.8333


def swing(folder, changes):
    """Complex amplitude of the cyst's pressure over that of the vessel's, over the last period."""
    steps = round(PERIOD / changes["time_step"])
    with run(SCENE, folder / "run", changes | {"output_fields": "\"\""}) as r:
        t = r["history/time"][-steps:]
        series = {name: r[f"history/cavity/{name}/pressure"][-steps:] for name in ("vessel", "cyst")}
        worst = r["history/cavity/cyst/volume_error"][:].max()
    wave = np.exp(-2j * np.pi * t / changes.get("cavity_vessel_period", PERIOD))
    return (series["cyst"] * wave).sum() / (series["vessel"] * wave).sum(), worst, t, series


def main():
    quick, folder = begin("pulsing_study", "one step length")
    rows = []
    ratio = static_ratio(folder)
    figure, axis = plt.subplots(figsize=(6, 4), constrained_layout=True)
    for model in ("linear", "corotational"):
        for analysis in ("static", "dynamic"):
            for step in [PERIOD / 40] if quick else [PERIOD / 20, PERIOD / 40, PERIOD / 80]:
                changes = {"tissue_model": model, "cavity_model": "linear" if model == "linear" else "follower",
                           "analysis": analysis, "time_step": step, "time_end": 3 * PERIOD}
                answer, worst, t, series = swing(folder, changes)
                rows.append({"tissue": model, "analysis": analysis, "step_s": f"{step:.4f}",
                             "amplitude": f"{abs(answer):.5f}", "of_compliance": f"{abs(answer) / abs(ratio):.4f}",
                             "phase_deg": f"{np.degrees(np.angle(answer / ratio)):.2f}", "volume_error": f"{worst:.1e}"})
                if step == PERIOD / 40:
                    axis.plot(t - t[0], series["cyst"] - series["cyst"].mean(), label=f"{model}, {analysis}")
    write_table(folder / "pulsing.csv", rows)
    axis.set(xlabel="time [s]", ylabel="cyst's pressure, mean off [Pa]", title="Cyst beside a pulsing vessel")
    axis.grid(alpha=0.3)
    axis.legend(frameon=False, fontsize=8)
    figure.savefig(folder / "pulsing.png", dpi=130)
    print(f"-C_21/C_22 = {ratio:.6f}; wrote {folder}/pulsing.csv and pulsing.png")


def static_ratio(folder):
    """-C_21/C_22 from volumes at unit pressures in one cavity, both open."""
    volumes = {}
    for pressed in ("none", "vessel", "cyst"):
        changes = {"tissue_model": "linear", "cavity_model": "linear", "analysis": "static", "time_end": 0,
                   "cavity_cyst_law": "pressure", "cavity_cyst_pressure": 0.01 if pressed == "cyst" else 0,
                   "cavity_vessel_mean": 0.01 if pressed == "vessel" else 0, "cavity_vessel_amplitude": 0}
        with run(SCENE, folder / "run", changes) as r:
            volumes[pressed] = r["history/cavity/cyst/volume"][-1]
    return -(volumes["vessel"] - volumes["none"]) / (volumes["cyst"] - volumes["none"])


main()
