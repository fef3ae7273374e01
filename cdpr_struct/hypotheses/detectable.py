"""How far a change must stand out of noise and tolerances to be found, if it alone were in question."""

from functools import cache

from scipy.special import chdtri, chndtrinc

FALSE_ALARMS, POWER = 1e-3, 0.8
"""Of a single test: p-value below which it speaks, and the probability that it finds a change of the smallest size."""
NAMED = 5.0
"""Log Bayes factor [nat] from which a cause is said to be there."""


@cache
def noncentrality(numbers: int) -> float:
    """Squared sigmas of a change of so many unknown numbers that a chi^2 test finds with `POWER`: 17.1 for one."""
    return float(chndtrinc(chdtri(numbers, FALSE_ALARMS), numbers, 1.0 - POWER))
