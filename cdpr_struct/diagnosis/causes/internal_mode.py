"""A mode inside the platform, or of frame or mast: a peak that stays where it is while the robot's own modes move.

It is no parameter of a world: the model's platform is rigid. As an explanation it is a campaign without these peaks,
whose other peaks may be off by what such a mode does to them.
"""

from dataclasses import dataclass, replace
from math import hypot

import numpy as np

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.measurement.campaign import Campaign, RobotFrequencies, States

NAME, RIVALS = "flexible_platform", ("frame_compliance",)
POSES = 3  # at which its peak must be seen; at two with more evidence
NEXT_MEASUREMENT = (
    "shake with three or more accelerometers on the platform, far from each other, and one on the frame: readings "
    "that no rigid body can have are the platform's, a strong one on the frame is the frame's"
)
_APART = (0.05, np.radians(3.0))  # m, rad: nearer states are one pose
MOVING = (0.0, 0.1)  # of the platform's mass, what moves in the mode: too little to be felt, or an order of magnitude
_MOST_PUSHED = 0.05  # of f
_SURE = 0.95  # a disturbance of constant frequency, the mains or a fan, is no mode at all


@dataclass(frozen=True, slots=True, eq=False)
class Steady:
    """Peaks of one frequency: their numbers (n,) among the robot frequencies, where it is [Hz], one sigma at any pose.

    log_density : of the peaks' frequencies if they are of one mode of unknown frequency
    """

    rows: np.ndarray
    hertz: float
    sigma: float
    log_density: float


def needs(campaign: Campaign) -> str:
    """Why these data cannot show it, or ""."""
    if poses(campaign.states, campaign.robot_frequencies.state) < POSES - 1:
        return f"needs peaks (robot frequencies, FRFs or decays) at {POSES} poses or more"
    return ""


def poses(states: States, index: np.ndarray) -> int:
    """Number of clearly different poses among states of the given indices."""
    kept: list[int] = []
    for i in np.unique(index):
        shift = np.linalg.norm(states.position[kept] - states.position[i], axis=1)
        turn = np.abs(states.angles[kept] - states.angles[i]).max(axis=1, initial=0.0)
        if not ((shift < _APART[0]) & (turn < _APART[1])).any():
            kept.append(int(i))
    return len(kept)


def without(campaign: Campaign, steady: Steady, moving: float) -> Campaign:
    """The campaign without these peaks; the others get the doubt of what a mode of this moving mass does to them.

    A mass on a spring adds r^2 / (1 - r^2) of itself to a platform that vibrates at r times its frequency, so modes
    below are slower and those above faster, most those near it.
    """
    peaks = campaign.robot_frequencies
    kept = np.setdiff1d(np.arange(len(peaks.hertz)), steady.rows)
    square = (peaks.hertz[kept] / steady.hertz) ** 2
    pushed = 0.5 * moving * square / np.maximum(np.abs(1.0 - square), 1e-6)
    sigma = np.hypot(peaks.sigma[kept], np.minimum(pushed, _MOST_PUSHED) * peaks.hertz[kept])
    shape, origin = (rows[kept] if len(rows) == len(peaks.hertz) else rows for rows in (peaks.shape, peaks.origin))
    return replace(
        campaign, robot_frequencies=RobotFrequencies(peaks.state[kept], peaks.hertz[kept], sigma, shape, origin)
    )


def correction(campaign: Campaign, steady: Steady, moving: float) -> Correction:
    """The campaign without the peaks, and what to say of them; moving as in `without`."""
    peaks = campaign.robot_frequencies
    seen = [campaign.states.names[i] for i in peaks.state[steady.rows]]
    where = f"{len(seen)} of {len(np.unique(peaks.state))} measured cases"
    said = (
        f"a peak at {steady.hertz:.4g} Hz in {where} ({', '.join(seen)}) stays where it is and is no mode of platform "
        "and cables: the platform flexes, or frame or mast vibrates; these peaks are set aside, and the extended robot "
        "has no such mode"
    )
    spread = hypot(steady.sigma, float(np.mean(peaks.sigma[steady.rows])) / np.sqrt(len(seen)))
    return Correction(
        NAME, said, without(campaign, steady, moving), rivals=RIVALS, next_measurement=NEXT_MEASUREMENT, most=_SURE,
        place=f"the robot frequencies, near {steady.hertz:.4g} Hz in {where}",
        sizes={"frequency": {"value": steady.hertz, "sigma": spread, "unit": "Hz"}},
    )  # fmt: skip
