"""Where a printed limit refuses cables for which the closed form is good, and what it stands in for."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.crosscheck.limits_causes import Candidate, candidates, static_groups
from cdpr_struct.crosscheck.limits_groups import CableGroups, broken_limits
from cdpr_struct.crosscheck.limits_sweep import Measured

COMPANIONS = {"crossover_distance": {"lambda2"}, "sag_ratio": {"epsilon"}}  # limits that are then broken as well


@dataclass(frozen=True, slots=True, eq=False)
class StrictLimit:
    """What one printed limit refuses although all others (but its companions) hold.

    quantity : what the error is measured in
    refused  : number of cables
    good     : share of their volume in which the error stays below the tolerance; nan if none is refused
    instead  : the limit that would refuse only what has to be refused; None if nothing has
    example  : index of the good cable farthest beyond the limit, -1 if there is none;  error : its error
    """

    parameter: str
    quantity: str
    refused: int
    good: float
    instead: Candidate | None
    example: int
    error: float


def needlessly_strict(
    groups: CableGroups, volume: np.ndarray, measured: Measured, quantities: tuple[str, ...], tolerance: float
) -> list[StrictLimit]:
    """Every printed limit and quantity, over all cables of the domain."""
    broken = broken_limits(groups)
    found = []
    for parameter in broken:
        alone = broken[parameter].copy()
        for other in broken.keys() - COMPANIONS.get(parameter, set()) - {parameter}:
            alone &= ~broken[other]
        for quantity in quantities:
            error = measured[quantity].error.max(axis=1)
            found.append(_strict(parameter, quantity, groups, volume, alone, error, tolerance))
    return found


def _strict(
    parameter: str,
    quantity: str,
    groups: CableGroups,
    volume: np.ndarray,
    alone: np.ndarray,
    error: np.ndarray,
    tolerance: float,
) -> StrictLimit:
    good, bad = alone & (error <= tolerance), alone & (error > tolerance)
    values = {name: value[:, None] for name, value in static_groups(groups).items()}
    limits = candidates(values, bad[:, None], good[:, None], volume) if bad.any() else []
    beyond = values[{"crossover_distance": "lambda2", "sag_ratio": "epsilon"}.get(parameter, parameter)][:, 0]
    kept = np.flatnonzero(good)
    example = int(kept[beyond[kept].argmax()]) if len(kept) else -1
    refused = float(volume[alone].sum())
    return StrictLimit(
        parameter=parameter,
        quantity=quantity,
        refused=int(alone.sum()),
        good=float(volume[good].sum()) / refused if refused > 0.0 else float("nan"),
        instead=limits[0] if limits else None,
        example=example,
        error=float(error[example]) if example >= 0 else float("nan"),
    )
