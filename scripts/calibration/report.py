"""What a calibration leaves: a table, fit.csv, an options file and a picture."""
import csv

import numpy as np

from fit import PARAMETERS

BLUE, ORANGE, GREEN, RED, PURPLE = "#1f5f8b", "#d9772b", "#3a7d44", "#a8323e", "#6f4a8e"
COLOURS = (BLUE, ORANGE, GREEN, RED, PURPLE)


def interval(estimate):
    if np.isnan(estimate.low):
        return "one run: no interval" if estimate.status == "one run" else "fixed"
    return f"{estimate.low:.5g} to {estimate.high:.5g}"


def print_table(result):
    print(f"{'parameter':<17} {'value':>10} {'unit':<9} 95 % interval")
    for name, (_, unit) in PARAMETERS.items():
        if name in result.estimates:
            estimate = result.estimates[name]
            print(f"{name:<17} {estimate.value:>10.5g} {unit:<9} {interval(estimate)}")
    for direction, quality in result.quality.items():
        if quality is None:
            continue
        singular = ", ".join(f"{s:.3g}" for s in quality.singular_values)
        print(f"{direction}: residual RMS {quality.rms:.3g} N (largest {quality.largest:.3g}), "
              f"{quality.samples} samples worth {quality.effective:.0f} independent ones "
              f"(autocorrelation {quality.autocorrelation:.2f}); rank {len(quality.names)} of "
              f"{len(quality.names)}, singular values {singular}")
    print(f"punctures found: {len(result.punctures)} in {len(result.entries)} runs")


def write_csv(path, result):
    """One row per parameter; the fit's quality is repeated for every parameter of a direction."""
    header = ["parameter", "option", "value", "unit", "low95", "high95", "status", "samples",
              "effective_samples", "autocorrelation", "residual_rms_N", "singular_values"]
    with open(path, "w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(header)
        for name, estimate in result.estimates.items():
            option, unit = PARAMETERS[name]
            row = [name, option, f"{estimate.value:.9g}", unit]
            row += ["" if np.isnan(x) else f"{x:.9g}" for x in (estimate.low, estimate.high)]
            row.append(estimate.status)
            for quality in result.quality.values():
                if quality and name in quality.names:
                    row += [quality.samples, f"{quality.effective:.1f}",
                            f"{quality.autocorrelation:.4f}", f"{quality.rms:.6g}",
                            " ".join(f"{s:.5g}" for s in quality.singular_values)]
            if name == "puncture":
                row.append(len(result.punctures))
            writer.writerow(row + [""] * (len(header) - len(row)))


def write_options(path, result, sources):
    """Options file that trocar takes after the one of a scene: the later file wins."""
    with open(path, "w") as stream:
        stream.write("# Fitted by scripts/calibrate to " + ", ".join(map(str, sources)) + "\n")
        for direction, quality in result.quality.items():
            if quality:
                stream.write(f"# {direction}: residual RMS {quality.rms:.3g} N over "
                             f"{quality.samples} samples\n")
        stream.write("# Static friction is not measured here; it is set to the dynamic one.\n")
        for name, (option, unit) in PARAMETERS.items():
            if name not in result.estimates:
                continue
            estimate = result.estimates[name]
            note = interval(estimate)
            stream.write(f"-{option} {estimate.value:.6g}  # {unit}, "
                         f"{note if np.isnan(estimate.low) else '95 %: ' + note}\n")
            if name.startswith("dynamic"):
                stream.write(f"-{option.replace('dynamic', 'static')} {estimate.value:.6g}\n")


def law(result, direction, path, speed):
    """Force of the fitted law at a path and speed."""
    value = {name: estimate.value for name, estimate in result.estimates.items()}
    if direction == "advance":
        return value["cutting"] + (value["dynamic"] + value["viscous"] * speed) * path
    return -(value["dynamic_withdraw"] + value["viscous_withdraw"] * speed) * path


def draw(path, curves, result):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(12, 4.8), constrained_layout=True,
                                gridspec_kw={"width_ratios": [3, 2]})
    for number, curve in enumerate(curves):
        depth = 1e3 * (curve.depth - result.entries[number])
        axes[0].plot(depth, curve.force, color="0.72", lw=0.9, zorder=1,
                     label=None if number else "measured, not fitted")
        draw_run(axes, number, COLOURS[number % len(COLOURS)], curve, result)
    for k, puncture in enumerate(result.punctures):
        at = 1e3 * (puncture.depth - result.entries[puncture.curve])
        axes[0].plot(at, puncture.force, "k^", ms=6, zorder=4, label=None if k else "puncture")
    for direction, quality in result.quality.items():
        for sign in (1, -1) if quality else ():
            axes[1].axhline(2 * sign * quality.rms, color="k", lw=0.9,
                            ls="--" if direction == "advance" else ":",
                            label=f"2 RMS, {direction}" if sign == 1 else None)
    axes[0].set(xlabel="path from the entry [mm]", ylabel="force on the needle [N]",
                title="Measured samples (dots) and the fitted law (lines)")
    axes[1].set(xlabel="path from the entry [mm]", ylabel="measured - fitted [N]",
                title="Residuals (dots: advance, crosses: withdrawal)")
    for ax in axes:
        ax.axhline(0.0, color="k", lw=0.5)
        ax.grid(alpha=0.3)
    axes[0].legend(frameon=False, fontsize=8)
    axes[1].legend(frameon=False, fontsize=8, loc="upper right", ncol=2)
    low, high = axes[1].get_ylim()
    axes[1].set_ylim(low, high + 0.25 * (high - low))  # room for the legend
    figure.savefig(path, dpi=130)
    plt.close(figure)


def draw_run(axes, number, colour, curve, result):
    """Fitted samples, law and residuals of one run."""
    label = curve.name
    for direction, slips in result.slips.items():
        for slip in (s for s in slips if s.curve == number and len(s.path)):
            fitted = law(result, direction, slip.path, slip.speed)
            axes[0].plot(1e3 * slip.path, slip.force, ".", color=colour, ms=4, alpha=0.5, zorder=2)
            axes[0].plot(1e3 * slip.path, fitted, color=colour, lw=1.1, zorder=3, label=label)
            axes[1].plot(1e3 * slip.path, slip.force - fitted, ls="", ms=3.5, alpha=0.7,
                         marker="." if direction == "advance" else "x", mew=0.8, color=colour)
            label = None
