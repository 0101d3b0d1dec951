"""Made-up force-depth curves with a known truth, for the tests and as an example of the format."""
import numpy as np

from curves import make_curve

SEED = 1
TRUTH = {"dynamic": 12.0, "viscous": 900.0, "cutting": 0.6, "puncture": 2.0,
         "dynamic_withdraw": 14.0, "viscous_withdraw": 1200.0}
VELOCITIES = (0.002, 0.005, 0.01)  # [m/s]
INDENTATION = 0.008  # [m] of travel until the puncture
PATH = 0.04  # [m] of travel after it
SPACING = 2e-4  # [m] of travel between samples
DROP = 0.001  # [m] over which the force falls after the puncture
REVERSAL = 0.0015  # [m] over which the force turns at the withdrawal
HOLD = 20  # samples
NOISE = 0.01  # [N], of samples
MEMORY = 0.6  # autocorrelation of neighbouring samples
SPREAD = 0.05  # [N], of the puncture force from run to run


def blend(travel, length):
    """Smoothly from 1 to 0 over a length."""
    return 0.5 * (1.0 + np.cos(np.pi * np.clip(travel / length, 0.0, 1.0)))


def clean_curve(velocity, peak):
    """Time, depth and force without noise."""
    count = round(INDENTATION / SPACING)
    before = SPACING * np.arange(count + 1)
    elastic = peak * (0.3 * before / INDENTATION + 0.7 * (before / INDENTATION) ** 2)
    path = SPACING * np.arange(1, round(PATH / SPACING) + 1)
    level = TRUTH["cutting"] + (TRUTH["dynamic"] + TRUTH["viscous"] * velocity) * path
    falling = blend(path, DROP)
    slip = falling * peak + (1.0 - falling) * level
    pause = np.arange(1, HOLD + 1) / HOLD
    relaxing = slip[-1] * (0.7 + 0.3 * np.exp(-4.0 * pause))
    back = PATH - path
    pull = -(TRUTH["dynamic_withdraw"] + TRUTH["viscous_withdraw"] * velocity) * back
    turning = blend(path, REVERSAL)
    leaving = turning * relaxing[-1] + (1.0 - turning) * pull
    depth = np.concatenate([before, INDENTATION + path, np.full(HOLD, INDENTATION + PATH),
                            INDENTATION + back])
    force = np.concatenate([elastic, slip, relaxing, leaving])
    return SPACING / velocity * np.arange(len(depth)), depth, force


def correlated(generator, count):
    """Noise whose neighbours are correlated, as those of a filtered load cell."""
    noise = generator.normal(0.0, NOISE, count)
    for k in range(1, count):
        noise[k] = MEMORY * noise[k - 1] + np.sqrt(1.0 - MEMORY**2) * noise[k]
    return noise


def synthetic_curves(seed=SEED):
    generator = np.random.default_rng(seed)
    curves = []
    for velocity in VELOCITIES:
        peak = TRUTH["puncture"] + generator.normal(0.0, SPREAD)
        time, depth, force = clean_curve(velocity, peak)
        force = force + correlated(generator, len(force))
        curves.append(make_curve(f"{1e3 * velocity:g}mm/s", np.round(time, 4), np.round(depth, 6),
                                 np.round(force, 4)))
    return curves


def note(seed):
    truth = ", ".join(f"{name} {value:g}" for name, value in TRUTH.items())
    return (f"Synthetic, not measured: scripts/calibrate --synthetic, seed {seed}. "
            f"Truth: {truth}.\n"
            f"Noise {NOISE} N with autocorrelation {MEMORY}; puncture force +-{SPREAD} N by run.")
