"""What decides whether natural frequencies can be trusted: their count, and how close they lie."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.reports.trust import Check

NEAR = 0.01
"""Relative distance of frequencies below which shapes mix: so little changes which is which."""
_MOST_GROUPS = 6


def mode_checks(hertz: Sequence[float] | np.ndarray, certified: bool, complete: bool = True) -> list[Check]:
    """Checks of natural frequencies (k,) [Hz], ascending.

    certified : a count proves that none below the last is missing;  complete : they reach the top of the band
    """
    missing = "the count of the frequencies could not be certified: some below the last may be missing."
    checks = [Check.of("uncertified counts", not certified, 0.0, None if certified else missing)]
    if not complete:
        last = f"more frequencies lie in the band than are listed; none above {hertz[-1]:.4g} Hz is."
        checks.append(Check.of("frequencies of the band left out", 1, 0.0, last))
    return [*checks, _near(np.asarray(hertz, dtype=float))]


def _near(hertz: np.ndarray) -> Check:
    """How many frequencies above zero lie near their neighbour; a note, since equal cables have equal frequencies."""
    close = np.diff(hertz) <= NEAR * hertz[1:]
    close &= hertz[:-1] > 0.0
    ends = np.flatnonzero(np.diff(np.concatenate([[0], close.astype(int), [0]])))
    groups = [(int(first) + 1, int(last) + 1) for first, last in ends.reshape(-1, 2)]
    said = None
    if groups:
        named = [f"{a} {'and' if b == a + 1 else 'to'} {b}" for a, b in groups[:_MOST_GROUPS]]
        more = f" and {len(groups) - _MOST_GROUPS} groups more" if len(groups) > _MOST_GROUPS else ""
        said = (
            f"Within {100.0 * NEAR:g} % of each other lie the frequencies of modes {', '.join(named)}{more}: there "
            "shapes mix, and small changes of the robot exchange them; compare such modes as a group."
        )
    count = sum(b - a + 1 for a, b in groups)
    return Check.of("frequencies near another", count, 0.0, said, note=True)
