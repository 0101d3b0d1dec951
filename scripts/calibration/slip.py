"""Which samples of a curve slip: after the puncture and after each change of direction."""
from dataclasses import dataclass

import numpy as np

from curves import HALF_WINDOW, LEAST_SAMPLES, DataError

# At both ends of a stretch: the rate sees the neighbour up to HALF_WINDOW samples away, so the
# stretch reaches that far too long and its outer velocities are mixed that far inwards.
TRIM = 2 * HALF_WINDOW
HOLD = 0.05  # slower than this part of the fastest motion is no motion
DROP = 0.1  # a puncture is a fall by this part of the largest force ...
DROP_NOISE = 6.0  # ... and by this many standard deviations of the noise


@dataclass
class Slip:
    """Slipping samples of one curve and direction; path is counted from the entry."""

    curve: int
    index: np.ndarray
    path: np.ndarray
    speed: np.ndarray
    force: np.ndarray


@dataclass
class Puncture:
    curve: int
    index: int
    force: float
    depth: float


def smooth(values, width=5):
    kernel = np.ones(width)
    return np.convolve(values, kernel, "same") / np.convolve(np.ones(len(values)), kernel, "same")


def longest_stretch(mask):
    """First and one past the last index of the longest run of true values; (0, 0) without any."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    starts, ends = edges[::2], edges[1::2]
    if len(starts) == 0:
        return 0, 0
    best = int(np.argmax(ends - starts))
    return int(starts[best]), int(ends[best])


def noise_of(force):
    """Standard deviation of white noise from second differences: no trend enters it."""
    return 1.4826 * np.median(np.abs(np.diff(force, 2))) / np.sqrt(6.0)


def find_peak(force):
    """Index of the first maximum that is followed by a real fall, or None."""
    level = smooth(force)
    fall = np.maximum.accumulate(level) - level
    fallen = np.flatnonzero(fall > max(DROP * level.max(), DROP_NOISE * noise_of(force)))
    return int(np.argmax(force[:fallen[0] + 1])) if len(fallen) else None


def settled(depth, force, sign):
    """First index at which slip is full: twice the travel to the turning point of the force.

    sign 1: after a puncture the force falls to a minimum before friction makes it grow again.
    sign -1: at a withdrawal it swings to its most negative value before it decays.
    """
    travel = sign * (depth - depth[0])
    half = travel <= 0.5 * travel[-1]
    turn = int(np.argmin(np.where(half, smooth(force), np.inf)))
    return int(np.argmax(travel >= 2.0 * travel[turn]))


def advance(number, curve, entry):
    """Puncture (or None) and slipping samples of the advance; the path's entry."""
    first, last = longest_stretch(curve.rate > HOLD * np.abs(curve.rate).max())
    if last - first < LEAST_SAMPLES:
        raise DataError(f"{curve.file}: run '{curve.name}' has no advance of {LEAST_SAMPLES} "
                        "samples or more")
    stretch = np.arange(first, last)
    peak = find_peak(curve.force[stretch])
    puncture, start = None, TRIM
    if peak is not None:
        at = first + peak
        puncture = Puncture(number, at, float(curve.force[at]), float(curve.depth[at]))
        start = peak + settled(curve.depth[at:last], curve.force[at:last], 1)
    if entry is None:
        entry = puncture.depth if puncture else 0.0
    return puncture, select(number, curve, stretch[start:-TRIM], entry), entry


def withdrawal(number, curve, entry):
    """Slipping samples of the withdrawal, or None where there is none."""
    first, last = longest_stretch(curve.rate < -HOLD * np.abs(curve.rate).max())
    if last - first < LEAST_SAMPLES:
        return None
    stretch = np.arange(first, last)
    start = max(TRIM, settled(curve.depth[stretch], curve.force[stretch], -1))
    return select(number, curve, stretch[start:-TRIM], entry)


def select(number, curve, index, entry):
    index = index[curve.depth[index] > entry]
    return Slip(number, index, curve.depth[index] - entry, np.abs(curve.velocity[index]),
                curve.force[index])


def within(slip, depths):
    """The samples whose path lies between two depths."""
    keep = (slip.path >= depths[0]) & (slip.path <= depths[1])
    return Slip(slip.curve, slip.index[keep], slip.path[keep], slip.speed[keep], slip.force[keep])


def speeds(slips):
    """Smallest and largest speed: medians over eighths of a run, so that jitter does not count."""
    medians = [np.median(block) for slip in slips for block in np.array_split(slip.speed, 8)
               if len(block)]
    return min(medians), max(medians)
