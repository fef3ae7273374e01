"""Which neglected effects make a model deviate: found by leaving them out of the exact model as well."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from cdpr_struct.crosscheck.compared_modes import ComparedModes, modes_without
from cdpr_struct.crosscheck.mode_pairing import modal_assurance, pair_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint

SAG = "higher_order_sag"
_HALF = 0.5


@dataclass(frozen=True, slots=True)
class Cause:
    """An effect that a model neglects.

    effect : one of `neglected_effects`, or "higher_order_sag", which is what is left when all of these are left out
    error  : largest deviation of the failing modes from the exact model without this effect and those named before
             it; of the sag that without all effects [-]
    """

    effect: str
    error: float


@dataclass(frozen=True, slots=True, eq=False)
class _Trial:
    """Deviations of k modes of a model from the exact one without some effects."""

    point: OperatingPoint
    modes: ComparedModes
    failing: np.ndarray
    mass: np.ndarray
    stations: int

    def error(self, off: tuple[str, ...]) -> float:
        """Largest deviation of the failing modes."""
        hertz, count = self.modes.hertz, len(self.modes.hertz)
        other, shapes = modes_without(self.point, frozenset(off), count, float(hertz.max()), self.stations)
        assurance = modal_assurance(self.modes.shapes, shapes, self.mass)
        partner = pair_modes(assurance, hertz, other)
        return float(np.abs(hertz / other[partner] - 1.0)[self.failing].max())


def find_causes(
    point: OperatingPoint,
    modes: ComparedModes,
    effects: tuple[str, ...],
    failing: np.ndarray,
    tolerance: float,
    mass: np.ndarray,
    stations: int,
    small_sag: bool,
) -> tuple[Cause, ...]:
    """The fewest effects without which every failing mode meets the tolerance; none where no effect matters.

    Where the tolerance is not met without all of them, those that halve the deviation, and the sag.

    Parameters
    ----------
    modes : k modes of the model;  effects : that the model neglects;  failing : (k,) bool
    mass, stations : of the samples of shapes;  small_sag : whether the model assumes one
    """
    trial = _Trial(point, modes, failing, mass, stations)
    before = trial.error(())
    without = {off: trial.error(off) for n in range(1, len(effects) + 1) for off in combinations(effects, n)}
    everything = without.get(effects, before)
    wanted = tolerance if everything <= tolerance else max(_HALF * before, everything)
    enough = [off for off, error in without.items() if error <= wanted and error <= _HALF * before]
    chosen = min(enough, key=lambda off: (len(off), without[off])) if enough else ()
    named = _in_order(chosen, without)
    left = small_sag and (everything > tolerance or everything > _HALF * before)
    return (*named, Cause(SAG, everything)) if left else named


def _in_order(chosen: tuple[str, ...], without: dict[tuple[str, ...], float]) -> tuple[Cause, ...]:
    """The chosen effects, each time the one next that lowers the deviation most."""
    found: list[Cause] = []
    for _ in chosen:
        done = {cause.effect for cause in found}
        sets = [tuple(e for e in chosen if e in done or e == new) for new in chosen if new not in done]
        best = min(sets, key=lambda off: without[off])
        effect = next(e for e in best if e not in done)
        found.append(Cause(effect, without[best]))
    return tuple(found)
