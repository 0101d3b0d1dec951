"""Observed order, extrapolated value and grid convergence index (GCI) of three meshes.

Celik et al., J. Fluids Eng. 130 (2008) 078001: unequal refinement ratios, safety factor 1.25.
"""
import numpy as np

SAFETY = 1.25
TRUSTED = 4.0  # no quantity here converges faster: a higher order is two levels that agree by chance


def ratio_of_changes(p, r21, r32, sign):
    """(coarse change) / (fine change) of value = limit + C h^p; with sign -1 C changes its sign."""
    return r21**p * (r32**p - sign) / (r21**p - sign)


def observed_order(values, sizes):
    """Order p from coarse, middle and fine; nan when no order explains the changes."""
    f3, f2, f1 = values
    h3, h2, h1 = sizes
    coarse, fine = f3 - f2, f2 - f1
    if fine == 0 or coarse == 0:
        return np.nan
    ratio, sign = coarse / fine, np.sign(coarse / fine)
    r21, r32 = h2 / h1, h3 / h2
    low, high = 1e-6, 40.0
    if not ratio_of_changes(low, r21, r32, sign) < abs(ratio) < ratio_of_changes(high, r21, r32, sign):
        return np.nan
    for _ in range(100):  # the ratio grows with p
        middle = 0.5 * (low + high)
        below = ratio_of_changes(middle, r21, r32, sign) < abs(ratio)
        low, high = (middle, high) if below else (low, middle)
    return 0.5 * (low + high)


def judge(values, sizes):
    """Behaviour, order, extrapolated value and relative GCI of the last three levels."""
    values, sizes = np.asarray(values, float), np.asarray(sizes, float)
    keep = np.isfinite(values)
    values, sizes = values[keep][-3:], sizes[keep][-3:]
    nothing = {"order": np.nan, "limit": np.nan, "gci": np.nan}
    if len(values) < 3:
        return {"behaviour": "too few levels"} | nothing
    coarse, fine = values[0] - values[1], values[1] - values[2]
    # Differences at round-off, or of a solver's tolerance, carry no order.
    if max(abs(coarse), abs(fine)) <= 1e-9 * np.abs(values).max():
        return {"behaviour": "the same on all"} | nothing
    order = observed_order(values, sizes)
    kind = "monotone" if coarse * fine > 0 else "oscillating"
    if np.isnan(order):
        return {"behaviour": f"{kind}, diverging"} | nothing
    used = min(order, TRUSTED)
    growth = (sizes[1] / sizes[2]) ** used
    # The error changes its sign from level to level where the values oscillate.
    limit = values[2] - fine / (np.sign(coarse * fine) * growth - 1.0)
    gci = SAFETY * abs(fine) / (growth - 1.0) / abs(values[2]) if values[2] else np.nan
    if order > TRUSTED:
        kind += ", order by chance"
    return {"behaviour": kind, "order": order, "limit": limit, "gci": gci}
