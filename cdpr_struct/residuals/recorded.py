"""A campaign's static readings, ready to be judged: filled where nothing was read, with how far each may be off."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.motion import runs
from cdpr_struct.observation.readings import Readings
from cdpr_struct.residuals.commanded_lengths import SIGMA, Commanded, commanded
from cdpr_struct.residuals.filled import encoder_zeros, filled
from cdpr_struct.residuals.resting_poses import Spread, at_lengths, fitted_poses
from cdpr_struct.residuals.swivels import Swivels, swivels
from cdpr_struct.residuals.vibrations import Vibrations, vibrations
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.energy_descent import arm_scale

POSITION, ROTATION, TENSION, LENGTH, CABLE_FREQUENCY, MODAL_SIZE, SWIVEL = range(7)
"""Kinds of sensors: what shares a size of its noise."""
_UNREAD_LENGTH = 1.0  # m, one sigma of a length that nobody read: nothing is known of it
_UNREAD_POSE = (1.0, 0.5)  # m, rad, of a pose that nobody read
_FEWEST = 10  # readings that show a step of rounding: once in 2^10 times are all even multiples of half of it


@dataclass(frozen=True, slots=True, eq=False)
class Recorded:
    """Static readings of S states of a robot with m cables, as entered.

    arrays : the robot;  readings : filled;  known : circumstances;  radius : of the platform [m]
    sigma (S, 6 + 2 m) : stated, of position and rotation [m, rad], tensions [N], lengths [m]
    read (S, 6 + 2 m) : bool, whether the reading exists;  unread (S, 6 + 2 m) : one sigma of it if not
    blocks : states that share a reading of lengths, in order of the campaign
    vibrations : frequencies, None without any;  sent : commands that stand in for encoders
    swivels : angles of pulleys about their swivel axes
    """

    campaign: Campaign
    arrays: RobotArrays
    readings: Readings
    known: Circumstances
    radius: float
    sigma: np.ndarray
    read: np.ndarray
    unread: np.ndarray
    blocks: tuple[np.ndarray, ...]
    vibrations: Vibrations | None
    sent: Commanded
    swivels: Swivels

    @property
    def cables(self) -> int:
        """m."""
        return self.arrays.cable_count

    @property
    def states(self) -> int:
        """S."""
        return len(self.campaign.states.names)

    @property
    def held(self) -> np.ndarray:
        """(6,) bool, freedoms of the platform that a guide holds."""
        return self.campaign.robot.held_freedoms


def recorded(campaign: Campaign) -> Recorded:
    """The static readings of a campaign.

    Raises
    ------
    InputError : a campaign without states, or a state that cannot be imagined: neither held nor at rest.
    """
    if not len(campaign.states.names):
        raise InputError(campaign.source, "measurement", "no states", "static states, loaded poses or frequencies")
    angles = np.nan_to_num(campaign.states.angles)
    turn = np.array([rotation_from_angles(*own) for own in angles]).reshape((-1, 3, 3))
    position, read_pose = _places(campaign)
    known = Circumstances.of(campaign, turn, position)
    arrays = RobotArrays.of(campaign.robot)
    begun = Readings(position, turn, campaign.states.tension, campaign.states.length)
    if campaign.relative_lengths:
        begun = replace(begun, length=begun.length - encoder_zeros(campaign, arrays, known, begun))
        campaign = replace(campaign, states=replace(campaign.states, length=begun.length))
    states = campaign.states
    position, turn = at_lengths(arrays, known, begun, read_pose)
    known = Circumstances.of(campaign, turn, position)
    sent = commanded(campaign, position, turn)
    lengths = np.where(np.isfinite(states.length), states.length, sent.lengths)
    readings = filled(campaign, arrays, known, Readings(position, turn, states.tension, lengths))
    m = arrays.cable_count
    read = np.concatenate([read_pose, np.isfinite(states.tension), np.isfinite(lengths)], axis=1)
    mean = np.broadcast_to(known.mean_tension * _shared(states.time)[:, None], (len(states.names), m))
    pose = np.repeat(np.stack([states.sigma_position, states.sigma_rotation], axis=1), 3, axis=1)
    tension = np.where(np.isfinite(states.tension_sigma), _rounded(states.tension, states.tension_sigma), 1.0)
    length = np.where(np.isfinite(states.length_sigma), states.length_sigma, 1e-3)
    length = np.where(np.isfinite(states.length), length, np.where(np.isfinite(lengths), SIGMA, length))
    parts = [np.repeat([_UNREAD_POSE], len(mean), axis=0).repeat(3, axis=1), mean, np.full_like(mean, _UNREAD_LENGTH)]
    sigma, unread = np.concatenate([pose, tension, length], axis=1), np.concatenate(parts, axis=1)
    if not _redundant(campaign, read):
        expected = "more readings than tensions in some state, such as lengths beside tensions, or measured poses"
        raise InputError(campaign.source, "readings", "no state where one could contradict another", expected)
    radius = arm_scale(arrays)
    readings = fitted_poses(arrays, known, readings, Spread(sigma, read, unread), radius)
    turned = swivels(campaign, arrays, known, readings)
    blocks = _blocks(states.lock)
    return Recorded(
        campaign, arrays, readings, known, radius, sigma, read, unread, blocks, vibrations(campaign), sent, turned
    )


def _shared(time: np.ndarray) -> np.ndarray:
    """(S,) factor on one sigma of a tension that nobody read: internal forces are off alike in all frames of a motion.

    A common error d of n frames costs n d^2 / (2 s^2) where each has one sigma s of its own, so s grows by sqrt(n).
    """
    factor = np.ones(len(time))
    for run in runs(time):
        factor[run] = np.sqrt(len(run))
    return factor


def _redundant(campaign: Campaign, read: np.ndarray) -> bool:
    """Whether anything can be contradicted: as many numbers as there are cables say where and how the robot rests.

    read (S, 6 + 2 m) : which readings exist; what is read of a freedom that a guide holds contradicts nothing
    """
    m, read = (read.shape[1] - 6) // 2, read.copy()
    read[:, :6] &= ~campaign.robot.held_freedoms
    if campaign.cable_frequencies.hertz.size or campaign.robot_frequencies.hertz.size or campaign.series:
        return True
    turned = np.isfinite(campaign.states.swivel)
    turned &= (turned.sum(axis=0) > 1) | ("swivel_deg" in campaign.stated)  # the first tells its zero
    count = [
        read[own, : 6 + m].sum() + read[own[0], 6 + m :].sum() + turned[own].sum()
        for own in _blocks(campaign.states.lock)
    ]
    return max(count) > m


def _places(campaign: Campaign) -> tuple[np.ndarray, np.ndarray]:
    """Positions (S, 3), the middle of the others where none was read, and which of (S, 6) pose readings exist."""
    states = campaign.states
    read = np.isfinite(np.concatenate([states.position, states.angles], axis=1))
    middle = _usual_place(campaign.robot)
    for axis in np.flatnonzero(read[:, :3].any(axis=0)):
        middle[axis] = np.nanmean(states.position[:, axis])
    return np.where(np.isfinite(states.position), states.position, middle), read


def _usual_place(robot: Robot) -> np.ndarray:
    """(3,) home, or below the frame anchors by half of their distance from their middle [m]."""
    if robot.home is not None:
        return np.array(robot.home.position, dtype=float)
    middle = robot.frame_anchors.mean(axis=0)
    reach = np.linalg.norm(robot.frame_anchors - middle, axis=1).mean()
    return np.asarray(middle - [0.0, 0.0, 0.5 * reach])


def _rounded(tension: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    """Sigma (S, m) with the variance of rounding, where all tensions are multiples of one step."""
    found = tension[np.isfinite(tension)]
    step = _step(found)
    return np.sqrt(sigma**2 + step**2 / 12.0)


def _step(values: np.ndarray) -> float:
    """The largest step of 1, 2 or 5 times a power of ten of which all values are multiples; 0 if there is none."""
    if values.size < _FEWEST:
        return 0.0
    for step in (50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01):
        if np.abs(values / step - np.round(values / step)).max() < 1e-6 * np.abs(values / step).max():
            return step
    return 0.0


def _blocks(lock: np.ndarray) -> tuple[np.ndarray, ...]:
    """States of one lock together, each other state alone."""
    own = np.where(lock >= 0, lock, lock.max(initial=-1) + 1 + np.arange(len(lock)))
    _, first = np.unique(own, return_index=True)
    return tuple(np.flatnonzero(own == own[i]) for i in np.sort(first))
