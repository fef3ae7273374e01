"""What to say of tensions that are too low, and which lower bound would cure it."""

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.slack_cables import hangs_slack, slack_sentence
from cdpr_struct.statics.sufficient_bound import SufficientBound, sufficient_lower_bound

_MET = 1e-6  # relative distance to a limit that counts as lying on it


def bound_hint(
    robot: Robot,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    external_wrench: npt.ArrayLike | None = None,
    upper: float | None = None,
) -> str:
    """End of a message about a pose that is unstable, not held or not solved; "" if no lower bound cures it.

    position, rotation : (3,) [m], (3, 3);  external_wrench : (6,) [N, N m];  upper : [N], None: the robot's own
    """
    bound = sufficient_lower_bound(robot, position, rotation, external_wrench, upper)
    if bound is None:
        return ""
    return f" With {_option(bound)} (or force_min in the robot file) the pose is stable and every cable is taut."


def slack_warning(
    robot: Robot,
    position: npt.ArrayLike,
    rotation: npt.ArrayLike,
    states: CableStates,
    external_wrench: npt.ArrayLike | None = None,
    upper: float | None = None,
) -> str | None:
    """One sentence about the cables (m,) that hang slack at a pose that is held, and what would cure it; None if none.

    position, rotation : (3,) [m], (3, 3);  external_wrench : (6,) [N, N m];  upper : [N], None: the robot's own
    """
    sentence = slack_sentence(hangs_slack(states))
    if sentence is None:
        return None
    bound = sufficient_lower_bound(robot, position, rotation, external_wrench, upper)
    if bound is None:
        return f"{sentence}; no lower bound of force makes every cable taut here."
    return f"{sentence}; with {_option(bound)} every cable is taut."


def shared_cure(found: SufficientBound, poses: int) -> str:
    """End of a sentence about a number of `poses` with slack cables, some or all of which were tried."""
    some = f" {found.tried} tried" if found.tried < poses else ""
    if found.bound is None:
        return f"no lower bound of force makes every cable taut {f'at any of the{some}' if some else 'there'}"
    if found.works < found.tried:
        where = f"at {found.works} of the {found.tried} tried"
    else:
        where = f"at all{some}" if some else "there"
    return f"with {_option(found.bound)} every cable is taut {where}"


def outside_limits(robot: Robot, tensions: npt.ArrayLike) -> list[str]:
    """A sentence for each tension at the platform (m,) [N] that is outside the robot's force limits."""
    pull = np.asarray(tensions, dtype=float)
    found = []
    for i, (force, low, high) in enumerate(zip(pull, robot.force_min, robot.force_max, strict=True), start=1):
        if force < low * (1.0 - _MET):
            found.append(f"cable {i} pulls with {force:.3g} N, below its force_min of {low:g} N.")
        elif force > high * (1.0 + _MET):
            found.append(f"cable {i} pulls with {force:.4g} N, above its force_max of {high:g} N.")
    return found


def _option(bound: float) -> str:
    return f"--lower-bound {bound:g}"
