"""Measurements with the information that each would give, computed together."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from cdpr_struct.errors import ConvergenceError, UnstableEquilibriumError
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.planning.checks import CHECKS, check_rows
from cdpr_struct.planning.information import Numbers
from cdpr_struct.planning.measurements import FREQUENCIES, Measurement, Proposed, proposed
from cdpr_struct.planning.planned_rows import PlannedRows
from cdpr_struct.residuals.linearised import Term
from cdpr_struct.residuals.recorded import Recorded, recorded
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot_arrays import RobotArrays

_BEHIND_A_CLAMP = "dead_length"
Informed = tuple[Measurement, np.ndarray]


def checks(data: Recorded, numbers: Numbers, known: Callable[[str], bool] = lambda _: False) -> Iterator[Informed]:
    """Checks beside the robot, without those that read a cause of which `known` says so."""
    for check in CHECKS:
        rows = check_rows(data.arrays, data.campaign.tolerances, numbers, check)
        read = [n for n, own in numbers.place.items() if np.any(rows[:, numbers.tolerances :][:, own])]
        if not any(known(name) for name in read):
            yield Measurement("check", (), check.name, check.sigma), rows.T @ rows


def at_the_robot(data: Recorded, numbers: Numbers) -> Iterator[Informed]:
    """Measurements at the robot; frequencies only where it has any: neither unstable nor slack on a cause's pulleys."""
    found = proposed(placed(data))
    if not found.measurements:
        return
    found = replace(found, campaign=read_alike(data.campaign, found.campaign))
    rows = _rows(data, numbers, found)
    for measurement, states in found.measurements:
        if rows.local.vibrating is not None or measurement.kind not in FREQUENCIES:
            yield measurement, rows.information(states)


def placed(data: Recorded) -> Campaign:
    """The campaign; with the likeliest poses where no state has a measured one."""
    states = data.campaign.states
    if np.isfinite(np.hstack([states.position, states.angles])).all(axis=1).any():
        return data.campaign
    angles = angles_from_rotation(data.readings.rotation)
    return replace(data.campaign, states=replace(states, position=data.readings.position, angles=angles))


def read_alike(campaign: Campaign, new: Campaign) -> Campaign:
    """A new campaign without the numbers of a pose that this one never has: there is no sensor for them."""
    never = [~np.isfinite(own).any(axis=0) for own in (campaign.states.position, campaign.states.angles)]
    position, angles = np.where(never[0], np.nan, new.states.position), np.where(never[1], np.nan, new.states.angles)
    return replace(new, states=replace(new.states, position=position, angles=angles))


def _rows(data: Recorded, numbers: Numbers, found: Proposed) -> PlannedRows:
    new = at_the_center_of(data, found.campaign)
    instead = {}
    index = [np.array(states) for measurement, states in found.measurements if measurement.kind == "clamped"]
    if index and _BEHIND_A_CLAMP in numbers.causes:
        instead[_BEHIND_A_CLAMP] = (_kept_stretch(numbers.term(_BEHIND_A_CLAMP), found.clamped), index[0])
    try:
        return PlannedRows.of(new, numbers, instead)
    except (UnstableEquilibriumError, ConvergenceError):  # no modes there, or none with what a cause changes
        return PlannedRows.of(replace(new, vibrations=None), numbers, instead)


def at_the_center_of(data: Recorded, campaign: Campaign) -> Recorded:
    """Another campaign's readings; laws of the robot refer to the first one's mean pose and tension there, too."""
    new, mean = recorded(campaign), data.known.mean_tension
    unread = new.unread.copy()
    unread[:, 6 : 6 + data.cables] = mean
    return replace(new, known=replace(new.known, center=data.known.center, mean_tension=mean), unread=unread)


def _kept_stretch(term: Term, tension: np.ndarray) -> Term:
    """Dead lengths behind clamps: they have let out what they do at the tensions (m,) [N] of clamping, and no more."""

    def change(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
        return replace(arrays, length_offset=arrays.length_offset + theta * tension / arrays.axial_stiffness)

    return replace(term, change=change)
