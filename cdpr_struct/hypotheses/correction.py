"""A campaign corrected in one way, for what people may have done to its data or to the simulation."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cdpr_struct.hypotheses.hypothesis import PRICE
from cdpr_struct.measurement.campaign import Campaign, States

_TILTED = 0.05  # of the largest angle
BEYOND_NOISE = 5.0  # sigmas of an angle: one of a million such readings of a level platform is larger


@dataclass(frozen=True, slots=True, eq=False)
class Correction:
    """A corrected campaign: what was wrong with the recorded one, in words, and how many alternatives its kind has.

    stretched : the factor in another unit, and which readings (S, 6 + 2 m) had it; None where no density changes
    """

    cause: str
    sentence: str
    campaign: Campaign
    alternatives: int = 1
    stretched: tuple[float, np.ndarray] | None = None
    parameters: dict[str, Any] = field(default_factory=dict)

    @property
    def log_prior(self) -> float:
        """ln of its probability against that of data as they are."""
        return -PRICE - math.log(self.alternatives)

    def log_stretch(self, felt: np.ndarray) -> float:
        """ln of by how much all readings together were stretched, which is part of their density.

        felt (S, 6 + 2 m) : readings that the model holds against others: the rest has a density in no unit
        """
        return 0.0 if self.stretched is None else math.log(self.stretched[0]) * int((felt & self.stretched[1]).sum())


def with_states(campaign: Campaign, **changes: Any) -> Campaign:
    """The campaign with other readings in its states."""
    return replace(campaign, states=replace(campaign.states, **changes))


def several_tilted(states: States, sigmas: float = 0.0) -> bool:
    """Whether more than one orientation is of the largest's order: a single one may be any slip of the pen.

    sigmas : of its reading that an orientation must exceed; those of a level platform are noise in any convention
    """
    size = np.abs(states.angles).max(axis=1, initial=0.0)
    size = np.where(size > sigmas * states.sigma_rotation, size, 0.0)
    tilted = states.angles[(size > 0.0) & (size > _TILTED * size.max(initial=0.0))]
    return len(np.unique(tilted, axis=0)) > 1
