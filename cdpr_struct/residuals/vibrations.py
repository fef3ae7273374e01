"""A campaign's frequencies: those of cables with their numbers, and lists of the robot's without any."""

from dataclasses import dataclass, fields, replace

import numpy as np

from cdpr_struct.association.association import Association
from cdpr_struct.association.detection import clutter, robot_detection
from cdpr_struct.association.doubles import detection_of_doubles
from cdpr_struct.association.modes import PredictedModes, robot_modes
from cdpr_struct.association.peak_noise import PeakNoise
from cdpr_struct.association.peaks import UNLABELLED, PeakList, PeakLists, padded
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import CrowdedModesError, UnstableEquilibriumError
from cdpr_struct.measurement.campaign import PLATFORM, Campaign
from cdpr_struct.observation.cable_modes import CableModes, CableRows, cable_modes_at, cable_rates
from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import rest
from cdpr_struct.observation.robot_modes import (
    BEYOND,
    VibratingModes,
    changes_of,
    frequencies_at,
    log_changes,
    modes_at,
    of_states_apart,
)
from cdpr_struct.observation.vibrating import of_states, vibrating
from cdpr_struct.residuals.modal_sizes import ModalSizes, measured_sizes
from cdpr_struct.residuals.modelled_sizes import ModelledSizes
from cdpr_struct.robot.parameters import PARAMETERS
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import VECTORS

_BODY = (
    "mass", "center_of_mass", "inertia", "internal_mass", "internal_frequency", "internal_direction", "swinging_mass",
    "swinging_frequency", "swinging_place",
)  # fmt: skip
_BELOW = 0.7  # of the lowest peak: where somebody who picked it began to look
_ABOVE = 1.02  # of the highest: the list ends there, and modes beyond were not looked for
_BELOW_LABELLED = 0.2  # of the lowest peak, where labels say which mode a peak is: it may be far off
_HALF = 0.5  # of the kinetic energy, from which a mode is the platform's, as `modes` says
_SURE = 1e-3  # of labelled peaks: how probable it is that one is no mode, beside one without a label
OF_CABLES = -3
"""Label of modes whose motion is that of cables, whichever; `PLATFORM` is that of modes with half of it or more."""


@dataclass(frozen=True, slots=True, eq=False)
class Vibrations:
    """Frequencies measured in F states.

    states (F,) : which of the campaign's, ascending
    rows : cable modes (r,), their states counted within F;  log_hertz (r,), sigma (r,) of ln f
    peaks : a list for each of F states, or None without any;  highest (F,) [rad/s];  sizes : modal constants of FRFs
    """

    states: np.ndarray
    rows: CableRows
    log_hertz: np.ndarray
    sigma: np.ndarray
    peaks: PeakLists | None
    highest: np.ndarray
    sizes: ModalSizes

    def richest(self, most: int) -> "Vibrations":
        """The states with most peaks, and these alone."""
        if self.peaks is None:
            return self
        return self.peaks_in(np.sort(np.argsort(-self.peaks.count, kind="stable")[:most]))

    def peaks_in(self, some: np.ndarray) -> "Vibrations":
        """The peaks in some of the F states, by number, and nothing else."""
        if self.peaks is None:
            return self
        none = CableRows(*(np.zeros(0, dtype=int),) * 4)
        some_of = {f.name: getattr(self.peaks, f.name)[some] for f in fields(self.peaks)}
        lists = some_of | {"state": np.arange(len(some))}
        blank = np.zeros(0)
        return Vibrations(
            self.states[some], none, blank, blank, PeakLists(**lists), self.highest[some], self.sizes.none
        )


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
        body, mode = (said[own] if said.size else np.full(own.size, UNLABELLED) for said in (robot.body, robot.mode))
        below = _BELOW if (body == UNLABELLED).all() else _BELOW_LABELLED
        band = (below * hertz.min(), _ABOVE * hertz.max()) if own.size else (1.0, 2.0)
        sigma = robot.sigma[own] / np.where(own.size, hertz, 1.0)
        lists.append(PeakList(hertz, sigma, band, k, 0, np.where(body >= 0, OF_CABLES, body), mode))
        highest[k] = 2.0 * np.pi * band[1]
    peaks = padded(lists) if robot.hertz.size else None
    return Vibrations(
        states, rows, np.log(cables.hertz), cables.sigma / cables.hertz, peaks, highest, measured_sizes(campaign)
    )


@dataclass(frozen=True, slots=True, eq=False)
class Vibrating:
    """Frequencies that the model has in the states where some were measured, and how they change near a point."""

    states: int
    measured: Vibrations
    known: Circumstances
    cables: CableModes
    robot: VibratingModes | None
    sizes: ModelledSizes | None

    @classmethod
    def about(
        cls, campaign: Campaign, known: Circumstances, measured: Vibrations, arrays: RobotArrays, readings: Readings
    ) -> "Vibrating":
        """At the robot and readings (S) of a point."""
        known, states = known.at(measured.states), len(campaign.states.names)
        point = _point(states, measured, known, arrays, readings)
        robot = None
        if measured.peaks is not None:
            try:
                robot = _modes(campaign, point, measured)
            except UnstableEquilibriumError:
                robot = _of_stable(campaign, known, measured, arrays, readings)
        sizes = None
        if robot is not None and len(measured.sizes):
            sizes = ModelledSizes.about(measured.sizes, measured.states, campaign.identified, robot)
        return cls(states, measured, known, cable_modes_at(point, measured.rows), robot, sizes)

    @property
    def log_hertz(self) -> np.ndarray:
        """(F, M) of the robot's modes."""
        return np.zeros((len(self.measured.states), 0)) if self.robot is None else self.robot.log_hertz

    def changes(self, arrays: RobotArrays, readings: Readings, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Changes of ln f, of cable modes (count, r) and the robot's (count, F, M), and of ln of modal constants
        (count, a) with the modes, for nearby robots or readings."""
        point = _point(self.states, self.measured, self.known, arrays, readings)
        own = cable_rates(self.cables, point, np.ones(count))
        if self.robot is None:
            return own, np.zeros((count, len(self.measured.states), 0)), np.zeros((count, len(self.measured.sizes)))
        change = self._changed(point, count)
        robot = log_changes(self.robot, change)
        sizes = np.zeros((count, len(self.measured.sizes)))
        if self.sizes is not None:
            sizes = np.einsum("ban,an->ba", change[:, self.sizes.row], self.sizes.gradient, optimize=True)
        return own, robot, sizes

    def turns(self, arrays: RobotArrays, readings: Readings, count: int) -> np.ndarray:
        """(count, a) by how much the modes of modal constants turn into others, for nearby robots or readings [rad]."""
        if self.robot is None or self.sizes is None:
            return np.zeros((count, len(self.measured.sizes)))
        change = self._changed(_point(self.states, self.measured, self.known, arrays, readings), count)
        turn = np.einsum("ban,anc->bac", change[:, self.sizes.row], self.sizes.turn, optimize=True)
        return np.asarray(np.linalg.norm(turn, axis=-1))

    def _changed(self, point: OperatingPoint, count: int) -> np.ndarray:
        """(count, F, n) changes of what the modes depend on."""
        assert self.robot is not None
        change = changes_of(self.robot, point)
        return np.broadcast_to(change, (count, *change.shape[-2:]))

    def log_sizes(self, arrays: RobotArrays) -> np.ndarray:
        """(B, a) ln of modal constants of the modes at the point, by the accelerometers of robots (B, 1)."""
        sizes = self.measured.sizes
        if self.sizes is None:
            return np.zeros((1, len(sizes)))
        gain = sizes.log_gain(arrays.accelerometer_gain)
        gain = gain[:, 0] if gain.ndim > 2 else gain.reshape((-1, len(sizes)))
        return np.asarray(gain + self.sizes.log)

    def association(self) -> Association | None:
        """The lists of peaks beside the modes at the point."""
        peaks, robot = self.measured.peaks, self.robot
        if peaks is None or robot is None:
            return None
        return _association(peaks, robot.log_hertz, np.where(robot.mask, robot.share, -1.0))


def _modes(campaign: Campaign, point: OperatingPoint, measured: Vibrations) -> VibratingModes:
    model: CableModel = "static" if campaign.model == "static" else "exact"
    return modes_at(point, measured.highest, _assembly(campaign), model)


def _of_stable(
    campaign: Campaign, known: Circumstances, measured: Vibrations, arrays: RobotArrays, readings: Readings
) -> VibratingModes:
    """State by state: an unstable one, as where a pose was filed wrongly, has no modes that a peak could belong to."""
    found: list[VibratingModes | None] = []
    for k in range(len(measured.states)):
        alone = measured.peaks_in(np.array([k]))
        point = _point(len(campaign.states.names), alone, known.at(np.array([k])), arrays, readings)
        try:
            found.append(_modes(campaign, point, alone))
        except UnstableEquilibriumError:
            found.append(None)
    return of_states_apart(found)


def _point(
    states: int, measured: Vibrations, known: Circumstances, arrays: RobotArrays, readings: Readings
) -> OperatingPoint:
    """States where vibration was measured, (..., F)."""
    some = Readings(
        np.take(readings.position, measured.states, axis=-2), np.take(readings.rotation, measured.states, axis=-3),
        np.take(readings.tension, measured.states, axis=-2), np.take(readings.length, measured.states, axis=-2),
    )  # fmt: skip
    return vibrating(rest(of_states(arrays, measured.states, states), some, known), known)


def log_likelihoods(
    campaign: Campaign, known: Circumstances, measured: Vibrations, arrays: RobotArrays, readings: Readings,
    variance: float, noise: PeakNoise,
) -> np.ndarray:  # fmt: skip
    """(A,) ln of the lists' density for robots (A, S or 1), peaks assigned anew; -inf where one is unstable or slack.

    variance : of ln f of every mode, by all that is not sure
    """
    states, peaks = len(campaign.states.names), measured.peaks
    if peaks is None:
        return np.zeros(arrays.batch_shape[:1])
    point = _whole(_point(states, measured, known.at(measured.states), arrays, readings))
    try:
        log_hertz, share = frequencies_at(point, float(measured.highest.max()) * BEYOND, _assembly(campaign))
    except (CrowdedModesError, UnstableEquilibriumError):
        return np.full(len(point.position), -np.inf)
    found = []
    for own, seen in zip(log_hertz, share, strict=True):
        lists = _association(peaks, np.where(np.isfinite(own), own, 0.0), np.where(np.isfinite(own), seen, -1.0))
        lists = lists.at(noise=noise, rule="poisson")
        spread = np.full(own.shape, variance)
        said = lists.expect(np.zeros(own.shape), spread, True)
        found.append(said.constant - 0.5 * float((said.precision * (said.value**2 + spread)).sum()))
    return np.array(found)


def _whole(point: OperatingPoint) -> OperatingPoint:
    """The same states with every field of pose and cables along all batch axes."""
    shape = np.broadcast_shapes(point.position.shape[:-1], point.cables.length.shape[:-1], point.arrays.batch_shape)
    cables = {f.name: getattr(point.cables, f.name) for f in fields(point.cables)}
    full = {n: np.broadcast_to(v, shape + v.shape[-(1 + (n in VECTORS)) :]) for n, v in cables.items()}
    body = {n: np.broadcast_to(getattr(point.arrays, n), shape + PARAMETERS[n].shape) for n in _BODY}
    arrays = replace(point.arrays, **body)
    place, turn = np.broadcast_to(point.position, (*shape, 3)), np.broadcast_to(point.rotation, (*shape, 3, 3))
    return OperatingPoint(arrays, place, turn, type(point.cables)(**full))


def _association(peaks: PeakLists, log_hertz: np.ndarray, share: np.ndarray) -> Association:
    """Lists beside modes (F, M); where there is no mode, its share is negative."""
    low, high = peaks.band[:, :1], peaks.band[:, 1:]
    visible = (share >= 0.0) & (log_hertz > low) & (log_hertz < high)
    detection = detection_of_doubles(log_hertz, np.where(visible, robot_detection(share), 0.0))
    found, labelled = clutter(peaks), peaks.cable != UNLABELLED
    if not labelled.any():
        return Association(peaks, robot_modes(log_hertz, detection), found)
    moves = share >= _HALF
    order = np.where(moves, np.cumsum(moves, axis=1), UNLABELLED)
    modes = PredictedModes(log_hertz, detection, np.where(moves, PLATFORM, OF_CABLES), order)
    return Association(peaks, modes, replace(found, density=np.where(labelled, _SURE, 1.0) * found.density))


def _assembly(campaign: Campaign) -> Assembly:
    return "thesis" if campaign.assembly == "thesis" else "consistent"
