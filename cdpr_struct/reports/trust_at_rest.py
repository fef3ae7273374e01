"""What decides whether a robot at rest can be trusted: balance, stability, slack and sag, strain, force limits."""

import numpy as np

from cdpr_struct.dynamics.applied_moment import WORTH_SAYING, frequency_change, moment_sentence
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.reports.locked_rest import locked_checks
from cdpr_struct.reports.trust import Check, Trust
from cdpr_struct.robot.plausibility import BREAKING_STRAIN
from cdpr_struct.statics.bound_advice import outside_limits, slack_warning
from cdpr_struct.statics.held_stability import held_stability, unstable_sentence
from cdpr_struct.statics.locked_rest import LockedRest
from cdpr_struct.statics.lost_cables import lost
from cdpr_struct.statics.slack_cables import (
    DEEP,
    cables_named,
    hangs_slack,
    sag_over_chord,
    sag_sentence,
    slack_sentence,
)
from cdpr_struct.statics.strained_cables import strain_sentence, strains
from cdpr_struct.statics.unbalanced_wrench import MOST_UNBALANCED, unbalanced_share

ILL_CONDITIONED = 1e8  # largest stiffness over the least: of double precision's 16 digits 8 are left


def trust_at_rest(point: OperatingPoint, locked: LockedRest | None = None, *more: Check, moves: bool = True) -> Trust:
    """Whether a robot at rest can be trusted.

    Parameters
    ----------
    point  : without batch axes, of the robot as entered
    locked : how it was found, at locked lengths; None at a pose that is held: then a lower bound against slack is named
    more   : checks of the command's own, told last
    moves  : whether the command lets the robot vibrate
    """
    found = [*_balance(point), *_cables(point, locked is None)]
    if locked is not None:
        found += [_limits(point), *locked_checks(locked)]
    if moves and point.arrays.moment.any():
        what = "change of a frequency by the moment's part without potential"
        found.append(Check.of(what, frequency_change(point), WORTH_SAYING, moment_sentence(point)))
    return Trust((*found, *more))


def _balance(point: OperatingPoint) -> list[Check]:
    state = (point.arrays, point.position, point.rotation, point.cables)
    left, held = float(unbalanced_share(*state)), held_stability(*state)
    least, condition = float(held.least_stiffness), float(held.condition)
    least = max(least, 0.0) if held.stable else least  # of a neutral freedom rounding is left
    unbalanced = f"{left:.2g} of the load is left unbalanced: the search for the rest ended before it had converged."
    softest = (
        f"the stiffest motion is {condition:.2g} times stiffer than the softest: the pose is close to a singular "
        "one, and its softest motion rests on small differences of large numbers."
    )
    unsolved = (np.flatnonzero(lost(point.cables)) + 1).tolist()
    failed = f"the search for the state of {cables_named(unsolved)} had not converged." if unsolved else None
    return [
        Check.of("unsolved cables", len(unsolved), 0.0, failed),
        Check.of("unbalanced wrench", left, MOST_UNBALANCED, None if left <= MOST_UNBALANCED else unbalanced),
        Check.of("least stiffness", least, 0.0, unstable_sentence(held), "N/m", at_least=True),
        Check.of("condition", condition, ILL_CONDITIONED, None if condition <= ILL_CONDITIONED else softest),
    ]


def _cables(point: OperatingPoint, advised: bool) -> list[Check]:
    """Slack, sag and strain; advised : a lower bound may be named that would cure slack."""
    cables = point.cables
    slack = hangs_slack(cables)
    if advised:
        loose = slack_warning(point.entered, point.position, point.rotation, cables)
    else:
        said = slack_sentence(slack)
        loose = None if said is None else f"{said}."
    sag, deep = float(np.nan_to_num(sag_over_chord(cables)).max()), sag_sentence(cables)
    most = 100.0 * strains(cables).max()
    return [
        Check.of("slack cables", slack.sum(), 0.0, (loose, None if sag >= DEEP else deep)),
        Check.of("sag over chord", sag, DEEP, deep if sag >= DEEP else None),
        Check.of("strain", most, 100.0 * BREAKING_STRAIN, strain_sentence(cables), "%"),
    ]


def _limits(point: OperatingPoint) -> Check:
    outside = outside_limits(point.entered, point.cables.tension_at_platform)
    return Check.of("forces outside their limits", len(outside), 0.0, outside)
