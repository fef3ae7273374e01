"""Which modes leave a peak in a list, and how many peaks belong to no mode.

The numbers below describe whoever picks the peaks: a sensor, its noise and a picking rule. They are measured once and
stated here only. So far they are the rates at which peaks were left out of simulated lists and added to them, with
which causes were found reliably; no recording with known modes stands behind them yet.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.association.peaks import KINDS, PeakLists

CABLE_DETECTION = 0.85
"""Probability [-] that a mode of a cable leaves a peak on that cable's sensor: 15 % were missing in simulated lists."""
ROBOT_DETECTION_HIGHEST = 0.9
"""Probability [-] for a mode that moves the platform strongly; simulated lists, as above."""
SHARE_INVISIBLE = 0.08
"""Share [-] of a mode's kinetic energy on the platform at which its peak begins to stand out; simulated lists."""
SHARE_RISE = 0.25
"""Further share [-] until the highest probability is reached; simulated lists."""
LEAST_RELATIVE_DETECTION = 0.05
"""Least probability, relative to the highest [-]: hardly any mode is invisible for certain."""
SPURIOUS_PER_LIST = {"robot": 1.0, "cable": 0.5}
"""Expected number of peaks per list that are no mode's: 8 % of ten to twelve and of six peaks in simulated lists."""


def robot_detection(share: np.ndarray) -> np.ndarray:
    """Probability [-] of a peak by the share [-] of a mode's kinetic energy that the sensor can see; any shape."""
    relative = np.clip((np.asarray(share) - SHARE_INVISIBLE) / SHARE_RISE, LEAST_RELATIVE_DETECTION, 1.0)
    return ROBOT_DETECTION_HIGHEST * relative


@dataclass(frozen=True, slots=True, eq=False)
class Clutter:
    """Spurious peaks as a Poisson process.

    density (L, J) : expected number per unit of ln f at each peak [-], positive
    expected (L,) : expected number in the whole list [-]
    """

    density: np.ndarray
    expected: np.ndarray

    def __post_init__(self) -> None:
        if not (self.density > 0.0).all():
            raise ValueError("Clutter.density must be positive: without it a single odd peak excludes every hypothesis")


def clutter(
    peaks: PeakLists,
    spurious: np.ndarray | None = None,
    lines: np.ndarray | None = None,
    line_count: float = 0.5,
    line_sd: float = 0.002,
) -> Clutter:
    """Spurious peaks spread evenly over the band in ln f, with more at steady lines.

    spurious : (L,) expected number per list; SPURIOUS_PER_LIST if not given
    lines : (n,) frequencies [Hz] of steady disturbances such as mains or a fan
    line_count : expected number of peaks at each line [-]; .5: a coin decides whether it is picked
    line_sd : their scatter in ln f [-]; .002: 0.1 Hz at 50 Hz, the tolerance of the mains
    """
    if spurious is None:
        spurious = np.array([SPURIOUS_PER_LIST[name] for name in KINDS])[peaks.kind]
    density = np.broadcast_to((spurious / peaks.bandwidth)[:, None], peaks.ln_frequency.shape).copy()
    expected = np.array(spurious, float)
    for line in np.log(lines) if lines is not None else ():
        inside = (line >= peaks.band[:, 0]) & (line <= peaks.band[:, 1])
        z = (peaks.ln_frequency - line) / line_sd
        bell = np.exp(-0.5 * z**2) / (line_sd * np.sqrt(2.0 * np.pi))
        density += line_count * inside[:, None] * bell
        expected += line_count * inside
    return Clutter(density, expected)
