"""A campaign's frequencies: those of cables with their numbers, and lists of the robot's without any."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.association.association import Association
from cdpr_struct.association.detection import clutter, robot_detection
from cdpr_struct.association.doubles import detection_of_doubles
from cdpr_struct.association.modes import robot_modes
from cdpr_struct.association.peaks import PeakList, PeakLists, padded
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.observation.cable_modes import CableModes, CableRows, cable_modes_at, cable_rates
from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import rest
from cdpr_struct.observation.robot_modes import VibratingModes, modes_at, rates
from cdpr_struct.observation.vibrating import of_states, vibrating
from cdpr_struct.robot.robot_arrays import RobotArrays

_BELOW = 0.7  # of the lowest peak: where somebody who picked it began to look
_ABOVE = 1.02  # of the highest: the list ends there, and modes beyond were not looked for
_MOST_MODES = 60  # of a state, those of the largest share of the platform: the rest is hardly ever seen


@dataclass(frozen=True, slots=True, eq=False)
class Vibrations:
    """Frequencies measured in F states.

    states (F,) : which of the campaign's, ascending
    rows : cable modes (r,), their states counted within F;  log_hertz (r,), sigma (r,) of ln f
    peaks : a list for each of F states, or None without any;  highest (F,) [rad/s]
    """

    states: np.ndarray
    rows: CableRows
    log_hertz: np.ndarray
    sigma: np.ndarray
    peaks: PeakLists | None
    highest: np.ndarray


def vibrations(campaign: Campaign) -> Vibrations | None:
    """The frequencies of a campaign; None if it has none."""
    cables, robot = campaign.cable_frequencies, campaign.robot_frequencies
    states = np.unique(np.concatenate([cables.state, robot.state])).astype(int)
    if not states.size:
        return None
    rows = CableRows(np.searchsorted(states, cables.state), cables.cable, cables.mode, cables.in_plane)
    lists, highest = [], np.zeros(len(states))
    for k, state in enumerate(states):
        own = np.flatnonzero(robot.state == state)
        hertz = robot.hertz[own]
        band = (_BELOW * hertz.min(), _ABOVE * hertz.max()) if own.size else (1.0, 2.0)
        lists.append(PeakList(hertz, robot.sigma[own] / np.where(own.size, hertz, 1.0), band, k, 0))
        highest[k] = 2.0 * np.pi * band[1]
    peaks = padded(lists) if robot.hertz.size else None
    return Vibrations(states, rows, np.log(cables.hertz), cables.sigma / cables.hertz, peaks, highest)


@dataclass(frozen=True, slots=True, eq=False)
class Vibrating:
    """Frequencies that the model has in the states where some were measured, and how they change near a point."""

    states: int
    measured: Vibrations
    known: Circumstances
    cables: CableModes
    robot: VibratingModes | None

    @classmethod
    def about(
        cls, campaign: Campaign, known: Circumstances, measured: Vibrations, arrays: RobotArrays, readings: Readings
    ) -> "Vibrating":
        """At the robot and readings (S) of a point."""
        known, states = known.at(measured.states), len(campaign.states.names)
        point = _point(states, measured, known, arrays, readings)
        robot = None
        if measured.peaks is not None:
            massless = campaign.model == "static"
            robot = modes_at(point, measured.highest, campaign.assembly, "static" if massless else "exact")
        return cls(states, measured, known, cable_modes_at(point, measured.rows), robot)

    @property
    def log_hertz(self) -> np.ndarray:
        """(F, M) of the robot's modes."""
        return np.zeros((len(self.measured.states), 0)) if self.robot is None else self.robot.log_hertz

    def changes(self, arrays: RobotArrays, readings: Readings, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Changes of ln f, of cable modes (count, r) and the robot's (count, F, M), for nearby robots or readings."""
        point = _point(self.states, self.measured, self.known, arrays, readings)
        ones = np.ones(count)
        own = cable_rates(self.cables, point, ones)
        if self.robot is None:
            return own, np.zeros((count, len(self.measured.states), 0))
        return own, np.broadcast_to(rates(self.robot, point, ones), (count, *self.robot.log_hertz.shape))

    def association(self) -> Association | None:
        """The lists of peaks beside the modes at the point."""
        peaks, robot = self.measured.peaks, self.robot
        if peaks is None or robot is None:
            return None
        low, high = np.exp(peaks.band[:, :1]), np.exp(peaks.band[:, 1:])
        hertz = np.exp(robot.log_hertz)
        share = np.where(robot.mask & (hertz > low) & (hertz < high), robot_detection(robot.share), 0.0)
        detection = detection_of_doubles(robot.log_hertz, share)
        return Association(peaks, robot_modes(robot.log_hertz, detection), clutter(peaks))


def _point(
    states: int, measured: Vibrations, known: Circumstances, arrays: RobotArrays, readings: Readings
) -> OperatingPoint:
    """States where vibration was measured, (..., F)."""
    some = Readings(
        np.take(readings.position, measured.states, axis=-2), np.take(readings.rotation, measured.states, axis=-3),
        np.take(readings.tension, measured.states, axis=-2), np.take(readings.length, measured.states, axis=-2),
    )  # fmt: skip
    return vibrating(rest(of_states(arrays, measured.states, states), some, known), known)
