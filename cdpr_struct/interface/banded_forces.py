"""Bands of cable forces along a motion."""

from typing import Any

import numpy as np

from cdpr_struct.bands.force_bands import ForceBands, UncertainForces
from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.interface.bands import AskedBand, band_head, spread_of
from cdpr_struct.reports.force_bands_told import force_band_checks, force_bands_told
from cdpr_struct.reports.trust import Trust


def with_force_bands(
    told: dict[str, Any], found: TrajectoryDistribution, asked: AskedBand | None
) -> tuple[dict[str, Any], ForceBands | None]:
    """The result of a distribution with the key `bands` and what is to be doubted; both as they are if none was asked.

    found : on sagging or spring cables
    """
    if asked is None:
        return told, None
    uncertain = UncertainForces(found, spread_of(found.robot))
    bands = uncertain.bands(asked.level)
    drawn = uncertain.drawn(asked.samples, asked.level) if asked.samples else None
    lower = np.broadcast_to(found.distribution.lower, found.distribution.tensions.shape)[bands.instant]
    key = force_bands_told(bands, found.trajectory.time[bands.instant], lower, drawn, asked.samples)
    trust = Trust((*told["trust"].checks, *force_band_checks(bands, drawn)))
    return told | {"bands": band_head(asked, found.robot) | key, "trust": trust}, bands
