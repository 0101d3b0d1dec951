"""Least squares of the slip laws, with rank test and intervals."""
from dataclasses import dataclass, field

import numpy as np

import slip
from curves import DataError

# name: option of the program, unit
PARAMETERS = {
    "dynamic": ("insertion_friction_dynamic", "N/m"),
    "viscous": ("insertion_friction_viscous", "N s/m^2"),
    "cutting": ("insertion_cutting_force", "N"),
    "dynamic_withdraw": ("insertion_friction_dynamic_withdraw", "N/m"),
    "viscous_withdraw": ("insertion_friction_viscous_withdraw", "N s/m^2"),
    "puncture": ("insertion_puncture_force", "N"),
}
CONFIDENCE = 0.95
SPEED_RATIO = 1.2  # the largest speed over the smallest that separates dynamic from viscous
RANK = 0.02  # smallest singular value over the largest, columns scaled to length 1
SHARE = 0.3  # a parameter takes part in a weak direction with at least this component


@dataclass
class Estimate:
    value: float
    low: float = float("nan")
    high: float = float("nan")
    status: str = "fitted"  # or fixed, one run


@dataclass
class Quality:
    """How well a direction's samples are met, and how well they determine its parameters."""

    samples: int
    effective: float
    autocorrelation: float
    rms: float
    largest: float
    names: list
    singular_values: np.ndarray


@dataclass
class Calibration:
    estimates: dict
    quality: dict = field(default_factory=dict)  # by direction
    slips: dict = field(default_factory=dict)  # by direction: list of Slip
    punctures: list = field(default_factory=list)
    entries: list = field(default_factory=list)  # depth of each curve's entry


def student(dof):
    """Two-sided 95 % quantile of Student's t; with t = sqrt(dof) tan(a) the density is
    cos(a)^(dof - 1), which is integrated here."""
    dof = min(dof, 1e5)
    angle = np.linspace(0.0, np.pi / 2, 20001)
    density = np.cos(angle) ** (dof - 1.0)
    mass = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    return float(np.sqrt(dof) * np.tan(np.interp(CONFIDENCE * mass[-1], mass, angle)))


def lag_one(residual, lengths):
    """Autocorrelation of neighbours within runs; negative values are not made use of."""
    parts = np.split(residual, np.cumsum(lengths)[:-1])
    pairs = sum(float(p[1:] @ p[:-1]) for p in parts)
    total = float(residual @ residual)
    return min(max(pairs / total, 0.0), 0.999) if total > 0.0 else 0.0


def check_rank(direction, names, columns):
    """Singular values of the scaled columns; refuses parameters that cannot be told apart."""
    lengths = np.linalg.norm(columns, axis=0)
    _, singular, right = np.linalg.svd(columns / lengths, full_matrices=False)
    if singular[-1] < RANK * singular[0]:
        mixed = [n for n, part in zip(names, right[-1]) if abs(part) > SHARE]
        raise DataError(
            f"{direction}: {' and '.join(mixed)} cannot be told apart: the depths (and velocities) "
            f"vary too little, singular values {', '.join(f'{s:.2g}' for s in singular)}; "
            f"fix one, such as --{mixed[-1].replace('_', '-')} 0, or measure over more depths")
    return singular


def least_squares(direction, names, columns, force, lengths):
    """Estimates by name and the quality of the fit."""
    singular = check_rank(direction, names, columns)
    value, *_ = np.linalg.lstsq(columns, force, rcond=None)
    residual = force - columns @ value
    n, k = columns.shape
    rho = lag_one(residual, lengths)
    effective = n * (1.0 - rho) / (1.0 + rho)
    if effective - k < 1.0:
        raise DataError(f"{direction}: {n} samples count as {effective:.1f} independent ones "
                        f"(autocorrelation {rho:.2f}), too few for {k} parameters")
    variance = residual @ residual / n * effective / (effective - k)
    covariance = variance * n / effective * np.linalg.inv(columns.T @ columns)
    half = student(effective - k) * np.sqrt(np.diag(covariance))
    rms = float(np.sqrt(residual @ residual / n))
    quality = Quality(n, effective, rho, rms, float(np.abs(residual).max()), names, singular)
    estimates = {m: Estimate(float(v), float(v - h), float(v + h))
                 for m, v, h in zip(names, value, half)}
    return estimates, quality


def fit_direction(direction, slips, columns_of, fixed):
    """Fits one direction: columns_of gives the law's columns by parameter for all samples."""
    slips = [s for s in slips if len(s.path)]
    if not slips:
        raise DataError(f"{direction}: no slipping samples inside the tissue")
    path, speed, force = (np.concatenate([getattr(s, what) for s in slips])
                          for what in ("path", "speed", "force"))
    columns = columns_of(path, speed)
    free = [name for name in columns if name not in fixed]
    low, high = slip.speeds(slips)
    pair = [name for name in free if not name.startswith("cutting")]
    if len(pair) == 2 and high < SPEED_RATIO * low:
        raise DataError(
            f"{direction}: {pair[0]} and {pair[1]} friction need at least two clearly different "
            f"velocities, found {1e3 * low:.3g} to {1e3 * high:.3g} mm/s; "
            f"add runs or fix one, such as --{pair[1].replace('_', '-')} 0")
    estimates = {name: Estimate(fixed[name], status="fixed") for name in columns if name in fixed}
    if not free:
        return estimates, None
    rest = force - sum((fixed[name] * columns[name] for name in columns if name in fixed),
                       np.zeros_like(force))
    fitted, quality = least_squares(direction, free, np.column_stack([columns[n] for n in free]),
                                    rest, [len(s.path) for s in slips])
    return {**estimates, **fitted}, quality


def puncture_force(punctures):
    """Mean of the runs' peaks; the interval is that of the mean over runs."""
    peaks = np.array([p.force for p in punctures])
    if len(peaks) == 1:
        return Estimate(float(peaks[0]), status="one run")
    half = student(len(peaks) - 1) * peaks.std(ddof=1) / np.sqrt(len(peaks))
    return Estimate(float(peaks.mean()), float(peaks.mean() - half), float(peaks.mean() + half))


def refuse_negative(estimates):
    """The program takes no negative value; clipping one would hide that the law does not fit."""
    for name, estimate in estimates.items():
        if estimate.value >= 0.0:
            continue
        reason = ("the law does not fit, look at the zero and the sign of the force"
                  if not estimate.high >= 0.0 else "it cannot be told from 0")
        interval = (f" (95 %: {estimate.low:.4g} to {estimate.high:.4g})"
                    if estimate.low == estimate.low else "")
        hint = f", or fix it with --{name.replace('_', '-')} 0" if name != "puncture" else ""
        raise DataError(f"the fitted {name} is negative, {estimate.value:.4g}{interval}: "
                        f"{reason}{hint}")


def calibrate(curves, fixed=None, entry=None, depths=(0.0, np.inf), withdraw=True):
    """Fits everything the curves hold. fixed: values by parameter. Raises DataError."""
    fixed = fixed or {}
    result = Calibration({})
    forward, backward = [], []
    for number, curve in enumerate(curves):
        puncture, slipping, entered = slip.advance(number, curve, entry)
        result.punctures += [puncture] if puncture else []
        result.entries.append(entered)
        forward.append(slip.within(slipping, depths))
        leaving = slip.withdrawal(number, curve, entered) if withdraw else None
        backward += [slip.within(leaving, depths)] if leaving else []
    result.slips["advance"] = forward
    result.estimates, result.quality["advance"] = fit_direction(
        "advance", forward,
        lambda z, v: {"dynamic": z, "viscous": v * z, "cutting": np.ones_like(z)}, fixed)
    if backward:
        result.slips["withdrawal"] = backward
        more, result.quality["withdrawal"] = fit_direction(
            "withdrawal", backward,
            lambda z, v: {"dynamic_withdraw": -z, "viscous_withdraw": -v * z}, fixed)
        result.estimates.update(more)
    if result.punctures:
        result.estimates["puncture"] = puncture_force(result.punctures)
    refuse_negative(result.estimates)
    return result
