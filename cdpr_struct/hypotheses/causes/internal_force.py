"""Internal force other than commanded: tensions sit elsewhere in the null space of the structure matrix."""

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Pattern
from cdpr_struct.robot.robot_arrays import RobotArrays

PRIOR = 15.0  # N, along each direction: what controllers and winches leave
_EVERYWHERE = 0.5  # probability that it is the same in all states


def _nothing(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return arrays


CAUSE = Cause(
    "internal_force",
    "internal force other than commanded",
    (),
    _nothing,
    seen_in=("NS",),
    sentence="the internal force differs from that of the simulation by {rms} {unit} on average",
    separated_by="reading the encoders; measuring the anchors",
)
REASON = "needs tensions of a redundant robot; beside encoder lengths it is tested on its own, not fitted"


def patterns(directions: int, states: int) -> tuple[Pattern, ...]:
    """One force everywhere, or one in each state; basic parameters are those of both, in this order."""
    same = tuple(Parameter(f"internal_force_{j + 1}", "N", PRIOR) for j in range(directions))
    own = tuple(
        Parameter(f"internal_force_{j + 1}_{i + 1}", "N", PRIOR) for i in range(states) for j in range(directions)
    )
    every = np.eye(len(same) + len(own))
    return (
        Pattern("the same everywhere", every[:, : len(same)], same, _EVERYWHERE),
        Pattern("each state its own", every[:, len(same) :], own, 1.0 - _EVERYWHERE),
    )


def columns(internal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """-dR (S, 6 + m, d) a newton of both patterns, from the change (S, m, q) of commanded lengths a newton."""
    s, m, q = internal.shape
    same = np.zeros((s, 6 + m, q))
    same[:, 6:] = -internal
    used = np.flatnonzero(np.abs(internal).any(axis=(1, 2)))
    own = np.zeros((s, 6 + m, len(used), q))
    own[used, 6:, np.arange(len(used))] = -internal[used]
    return same, own.reshape((s, 6 + m, -1))
