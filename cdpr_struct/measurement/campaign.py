"""What was measured on a robot: states, readings, how sure they are, and the simulation they are held against."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from cdpr_struct.measurement.frames import Frames
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.tolerances import Tolerances

if TYPE_CHECKING:
    from cdpr_struct.measurement.ambient_records import AmbientRecord
    from cdpr_struct.measurement.identified import Identified

SIGNALS = ("frf", "free_decay", "platform_motion")
"""Kinds of data whose frequencies are identified in records."""
AMBIENT = "ambient"
"""Kind of accelerations under unknown forces, whose frequencies count like a list's."""
NOT_SAID, PLATFORM = -1, -2
"""Labels of a peak of the robot: of nothing that is known, and of the platform."""
KINDS = ("static_state", "loaded_pose", "cable_frequency", "robot_frequency", *SIGNALS)
UNKNOWN_ZERO = 1.0
"""m, one sigma of a length's zero of which nothing is known."""
MODELS = ("static", "dsm", "exact", "spring")


@dataclass(frozen=True, slots=True)
class Sigmas:
    """Certificates of the sensors, one sigma; a frequency's is relative (3 per mille) unless given."""

    tension_N: float = 2.0
    position_m: float = 0.0005
    rotation_deg: float = 0.02
    length_m: float = 0.0005
    frequency_hz: float | None = None
    acceleration: float | None = None
    swivel_deg: float = 0.1

    def frequency(self, hertz: np.ndarray) -> np.ndarray:
        """Sigma of natural frequencies [Hz]."""
        return 0.003 * hertz if self.frequency_hz is None else np.full_like(hertz, self.frequency_hz)


@dataclass(frozen=True, slots=True)
class Sheet:
    """A data file of a campaign: its columns and sigmas.

    columns  : of the form with one row a cable, also where the file has one row a pose
    stated   : sigmas that the campaign file gives
    headings : where the file has one row a pose: of a column of the other form, the file's columns in short
    """

    kind: str
    file: str
    columns: tuple[str, ...]
    sigmas: Sigmas
    stated: frozenset[str]
    headings: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class States:
    """S states of the robot (cases) with m cables; nan where nothing was measured.

    names : S;  position (S, 3) [m];  angles (S, 3) rx, ry, rz [rad]
    sigma_position, sigma_rotation : (S,) [m], [rad]
    payload : (S,) point mass at the platform origin [kg]
    tension, tension_sigma : (S, m) at the platform [N]
    length, length_sigma : (S, m) unstrained, as the encoder says [m]
    lock    : (S,) states with the same number share one length reading; -1 without lengths
    loaded  : (S,) bool, the state is a row of a `loaded_pose` file
    static  : (S,) bool, the state is in a `static_state` file
    temperature : (S,) [K];  approach : (S, m) sign of the last motion;  time : (S,) [s]
    swivel, swivel_sigma : (S, m) of each cable's pulley about its swivel axis [rad]; nan unless given
    """

    names: tuple[str, ...]
    position: np.ndarray
    angles: np.ndarray
    sigma_position: np.ndarray
    sigma_rotation: np.ndarray
    payload: np.ndarray
    tension: np.ndarray
    tension_sigma: np.ndarray
    length: np.ndarray
    length_sigma: np.ndarray
    lock: np.ndarray
    loaded: np.ndarray
    static: np.ndarray
    temperature: np.ndarray
    approach: np.ndarray
    time: np.ndarray
    swivel: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    swivel_sigma: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))

    def __post_init__(self) -> None:
        for name in ("swivel", "swivel_sigma"):
            if getattr(self, name).shape != self.tension.shape:
                object.__setattr__(self, name, np.full_like(self.tension, np.nan))

    @property
    def has_tension(self) -> np.ndarray:
        """(S,) bool: the tensions of all cables were read."""
        return np.isfinite(self.tension).all(axis=1)

    @property
    def has_length(self) -> np.ndarray:
        """(S,) bool: the lengths of all cables were read."""
        return np.isfinite(self.length).all(axis=1)


@dataclass(frozen=True, slots=True, eq=False)
class CableFrequencies:
    """Natural frequencies of single cables: state, cable (from 0), mode (from 1), in plane or not, [Hz], sigma [Hz]."""

    state: np.ndarray
    cable: np.ndarray
    mode: np.ndarray
    in_plane: np.ndarray
    hertz: np.ndarray
    sigma: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class RobotFrequencies:
    """Natural frequencies of the robot: state, [Hz], sigma [Hz].

    body : (r,) which body moves most: `PLATFORM`, the number of a cable from 0, or `NOT_SAID`; or (0,)
    mode : (r,) number of the mode among those of the platform from 1, or `NOT_SAID`; or (0,)
    shape : (r, 6) complex, motion of the platform that signals show in each mode, any scale [m, rad], nan where not
            seen; or (0, 6)
    origin : (r, 2) number of the record in `identified` and of its mode, -1 for peaks of a list; or (0, 2)
    """

    state: np.ndarray
    hertz: np.ndarray
    sigma: np.ndarray
    shape: np.ndarray = field(default_factory=lambda: np.zeros((0, 6), dtype=complex))
    origin: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), dtype=int))
    body: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=int))
    mode: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=int))

    def unlike(self, rows: np.ndarray, model: np.ndarray, radius: float) -> np.ndarray:
        """(r, k) 1 - modal assurance of rows against the model's platform shapes (k, 6); nan without a measured shape.

        radius : of the platform [m], weighs turns against shifts
        """
        result = np.full((len(rows), len(model)), np.nan)
        if len(self.shape) != len(self.hertz):
            return result
        weight = np.array([1.0] * 3 + [radius] * 3)
        for i, row in enumerate(rows):
            seen = np.isfinite(self.shape[row])
            own, other = (self.shape[row] * weight)[seen], (model * weight)[:, seen]
            size = np.vdot(own, own).real * (np.abs(other) ** 2).sum(axis=1)
            if seen.sum() > 1 and (size > 0.0).all():
                result[i] = 1.0 - np.abs(other.conj() @ own) ** 2 / size
        return result


@dataclass(frozen=True, slots=True, eq=False)
class Series:
    """Raw rows of a kind that holds signals: its case names and numeric columns, as read and checked."""

    kind: str
    file: str
    case: tuple[str, ...]
    columns: dict[str, np.ndarray]
    labels: dict[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class Campaign:
    """A measuring campaign and the simulation under test.

    model : static, dsm, exact or spring
    lower_bound : of the tensions that the simulation commands [N]; None: the robot's own limit
    stated : names of the tolerances that the file gives; the others are defaults
    checked : causes that a check beside the robot has bounded, with one sigma of what they may still be
    identified : modes found in the signals of `series`; those used are among `robot_frequencies`
    ambient : modes found in ambient records, all of them among `robot_frequencies`
    sheets : the data files, with the sigmas used
    memory : correlation of a sensor's noise in one state with that in the next, 0 for independent noise
    relative_lengths : each encoder counts from an unknown start, the same in all states
    notes : what was assumed where the data files say nothing, in sentences for a person
    loss : what mistakes of a diagnosis cost
    frames : what is known of states that stand for the frames of a motion, None where every frame is a state
    """

    source: str
    robot: Robot
    robot_name: str
    model: str
    tolerances: Tolerances
    stated: frozenset[str]
    states: States
    cable_frequencies: CableFrequencies
    robot_frequencies: RobotFrequencies
    series: tuple[Series, ...] = ()
    identified: tuple["Identified", ...] = ()
    assembly: str = "consistent"
    tension_distribution: str = "minimum_norm"
    lower_bound: float | None = None
    checked: Mapping[str, float] = field(default_factory=dict)
    memory: float = 0.0
    sheets: tuple[Sheet, ...] = ()
    notes: tuple[str, ...] = ()
    relative_lengths: bool = False
    loss: Loss = Loss()  # noqa: RUF009 - frozen
    frames: Frames | None = None
    ambient: tuple["AmbientRecord", ...] = ()

    @property
    def cable_model(self) -> str:
        """How the simulation under test sees cables at rest: "spring" or "sagging"."""
        return "spring" if self.model == "spring" else "sagging"

    def with_states_only(self, states: States) -> "Campaign":
        """The same campaign of these states, without frequencies and signals."""
        cables = CableFrequencies(*(np.zeros(0, dtype=t) for t in (int, int, int, bool, float, float)))
        return replace(self.without_robot_peaks(), states=states, cable_frequencies=cables, frames=None)

    def without_robot_peaks(self) -> "Campaign":
        """The campaign without frequencies of the robot, from lists and from signals."""
        peaks = RobotFrequencies(*(np.zeros(0, dtype=t) for t in (int, float, float)))
        return replace(self, robot_frequencies=peaks, series=(), identified=(), ambient=())

    def kinds(self) -> list[str]:
        """Kinds of data that the campaign holds, in the fixed order."""
        found = {s.kind for s in self.series}
        flags = {
            "static_state": self.states.static.any(),
            "loaded_pose": self.states.loaded.any(),
            "cable_frequency": self.cable_frequencies.hertz.size,
            "robot_frequency": self.robot_frequencies.hertz.size,
        }
        return [k for k in KINDS if k in found or flags.get(k)]
