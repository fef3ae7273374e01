"""The printed validity limits of the closed-form DSM on trial (eqs 2.40-2.41, section 2.2.1)."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.crosscheck.limits_causes import MissingLimit, missing_limits, sample_groups
from cdpr_struct.crosscheck.limits_domain import FULL, SMALL, Domain, random_cables
from cdpr_struct.crosscheck.limits_errors import QUANTITIES
from cdpr_struct.crosscheck.limits_groups import CableGroups, inside_printed_limits
from cdpr_struct.crosscheck.limits_referee import RefereeVerdict, judge
from cdpr_struct.crosscheck.limits_reference import Effects
from cdpr_struct.crosscheck.limits_strictness import StrictLimit, needlessly_strict
from cdpr_struct.crosscheck.limits_sweep import Measured, Progress, chunk_count, sweep, take
from cdpr_struct.crosscheck.limits_veering import CASES, Veering, veering

SWITCHES = {
    "along_weight": Effects(along_weight=False),
    "axial_inertia": Effects(axial_inertia=False),
    "static_strain": Effects(static_strain=False),
    "all": Effects(False, False, False),
}
STRICT_QUANTITIES = ("in_plane_frequency", "mode_shape", "end_mass_frequency")


@dataclass(frozen=True, slots=True)
class Extent:
    """How much is computed: the grid, random cables for the check, cables before the referee, points of a curve."""

    domain: Domain
    random: int
    judged: int
    curve: int


FULL_EXTENT = Extent(FULL, 600, 8, 240)
SMALL_EXTENT = Extent(SMALL, 48, 3, 36)


@dataclass(frozen=True, slots=True, eq=False)
class HeldOut:
    """Random cables inside the printed limits: does what was read off the grid hold for them?

    before, after : largest error inside the printed limits, and inside the further ones as well
    bad, left     : shares of samples above the tolerance, before and after;  kept : share of samples kept
    """

    quantity: str
    cables: int
    before: float
    after: float
    bad: float
    left: float
    kept: float


@dataclass(frozen=True, slots=True, eq=False)
class LimitsTrial:
    """What the trial found; cables are numbered within `groups`.

    number   : (n,) flat index of each cable in the domain's grid;  volume : (n,)
    inside   : (n,) bool, admitted by every printed limit
    missing  : further limits that the print lacks;  strict : printed limits against what they refuse
    judged   : indices of the cables that the referee judged, with its verdicts
    """

    extent: Extent
    tolerance: float
    groups: CableGroups
    number: np.ndarray
    volume: np.ndarray
    measured: Measured
    inside: np.ndarray
    missing: list[MissingLimit]
    strict: list[StrictLimit]
    held_out: list[HeldOut]
    judged: np.ndarray
    verdicts: list[RefereeVerdict]
    curves: list[Veering]

    def error(self, quantity: str) -> np.ndarray:
        """(n,) worst error of the quantity at each cable [-]."""
        return self.measured[quantity].error.max(axis=1)

    def worst_inside(self, quantity: str) -> tuple[int, int]:
        """Cable and sample of the largest error inside the printed limits."""
        error = np.where(self.inside[:, None], self.measured[quantity].error, -np.inf)
        cable, sample = np.unravel_index(error.argmax(), error.shape)
        return int(cable), int(sample)

    @property
    def holds(self) -> bool:
        """The printed limits keep every error below the tolerance."""
        return not self.missing


def step_count(extent: Extent) -> int:
    """Calls of `progress` that a trial makes at most."""
    groups = extent.domain.cables()[0]
    admitted = int(inside_printed_limits(groups).sum())
    sweeps = chunk_count(len(groups)) + len(SWITCHES) * chunk_count(admitted) + chunk_count(extent.random)
    return sweeps + 1 + len(CASES)


def try_limits(
    extent: Extent, tolerance: float = 0.01, executor: Executor | None = None, progress: Progress = lambda _: None
) -> LimitsTrial:
    """Measure the closed form's error over the domain, and say which limits are missing and which too strict.

    tolerance : relative error, and 1 - MAC, that counts as a failure [-]
    executor  : shares out the sweeps;  progress : called with what is being computed
    """
    groups, number, volume = extent.domain.cables()
    measured = sweep(groups, None, executor, progress, "closed form against catenary")
    inside = inside_printed_limits(groups)
    missing = _missing(groups, volume, measured, inside, tolerance, executor, progress)
    strict = needlessly_strict(groups, volume, measured, STRICT_QUANTITIES, tolerance)
    held_out = _held_out(extent.random, missing, tolerance, executor, progress)
    judged = _to_be_judged(measured, inside, missing, extent.judged)
    progress("FEM referee")
    verdicts = judge(groups.take(judged))
    curves = []
    for case in CASES:
        progress("crossovers")
        curves.append(veering(*case, extent.curve))
    return LimitsTrial(
        extent, tolerance, groups, number, volume, measured, inside, missing, strict, held_out, judged, verdicts, curves
    )


def _missing(
    groups: CableGroups,
    volume: np.ndarray,
    measured: Measured,
    inside: np.ndarray,
    tolerance: float,
    executor: Executor | None,
    progress: Progress,
) -> list[MissingLimit]:
    """Causes by switching at the admitted cables with an error above the tolerance; limits over all admitted ones."""
    admitted = np.flatnonzero(inside)
    own = take(measured, admitted)
    failing = np.flatnonzero(np.any([s.error.max(axis=1) > tolerance for s in own.values()], axis=0))
    if not len(failing):
        return []
    switched = {}
    for name, effects in SWITCHES.items():
        found = sweep(groups.take(admitted[failing]), effects, executor, progress, f"without {name.replace('_', ' ')}")
        switched[name] = _spread_over(found, own, failing)
    limits = missing_limits(groups.take(admitted), volume[admitted], own, switched, tolerance)
    return [replace(limit, cable=int(admitted[limit.cable])) for limit in limits]


def _spread_over(found: Measured, own: Measured, failing: np.ndarray) -> Measured:
    """Errors at the failing cables put among those of all admitted ones."""
    full = take(own, np.arange(len(next(iter(own.values())).error)))
    for quantity, samples in found.items():
        full[quantity].error[failing] = samples.error
    return full


def _held_out(
    count: int, missing: Sequence[MissingLimit], tolerance: float, executor: Executor | None, progress: Progress
) -> list[HeldOut]:
    groups = random_cables(count)
    measured = sweep(groups, None, executor, progress, "random cables")
    found = []
    for quantity in QUANTITIES:
        samples = measured[quantity]
        values = sample_groups(groups, samples)
        kept = np.ones(samples.error.shape, dtype=bool)
        for limit in (m.limit for m in missing if m.quantity == quantity):
            kept &= values[limit.parameter] < limit.threshold
        bad = samples.error > tolerance
        found.append(
            HeldOut(
                quantity=quantity,
                cables=len(groups),
                before=float(samples.error.max()),
                after=float(samples.error[kept].max()) if kept.any() else float("nan"),
                bad=float(bad.mean()),
                left=float((bad & kept).sum() / max(kept.sum(), 1)),
                kept=float(kept.mean()),
            )
        )
    return found


def _to_be_judged(measured: Measured, inside: np.ndarray, missing: Sequence[MissingLimit], count: int) -> np.ndarray:
    """The worst admitted cable of each quantity, then those that carry the evidence, without repeats."""
    worst = [int(np.where(inside, samples.error.max(axis=1), -np.inf).argmax()) for samples in measured.values()]
    return np.array(list(dict.fromkeys([*worst, *(m.cable for m in missing)]))[:count])
