"""What could be measured next at the robot: one state, a series of states, loads at locked lengths, frequencies.

All states that are proposed form one campaign; a measurement is a choice of its states. Readings are those of the
robot as entered, sensors as good as the campaign's own, or as good ones usually are.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from cdpr_struct.dynamics.natural_frequencies import static_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign, RobotFrequencies, Sigmas, States
from cdpr_struct.planning.places import PAYLOADS, STEP_LOAD, Place, held, home_of, loaded, moved, tilted
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.forward_kinematics import forward

MOST = 4  # states of a series
CABLE_MODES = 4
_LOADS = (0.0, 0.15, 0.3)  # of the platform's mass, at locked lengths
_CORNERS = ((1, 1, 1), (-1, -1, 1), (1, -1, -1), (-1, 1, -1), (0, 0, 1), (0, 0, -1))
_AXES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
SERIES = ("tilts", "poses", "payloads", "sides", "clamped")


@dataclass(frozen=True, slots=True, eq=False)
class Measurement:
    """Something to measure.

    kind  : "check", "pose", "tilt", "payload", "approach", "encoders", "locked", "cable_frequencies",
            "robot_frequencies", or a series: "poses", "tilts", "payloads", "sides", "clamped"
    check : name of what is read beside the robot;  places : of the states, with their payloads
    sigma : of the readings that matter: of a check, of lengths [m], of a tracked position [m];  modes : of each cable
    """

    kind: str
    check: str = ""
    places: tuple[Place, ...] = ()
    sigma: float = np.nan
    modes: int = 0

    @property
    def family(self) -> tuple[str, str]:
        """Measurements of one family are done in the same way, elsewhere."""
        return self.kind, self.check


@dataclass(slots=True, eq=False)
class _States:
    """States to propose, and the measurements that are made of them; `choose` takes what the robot holds."""

    places: list[Place] = field(default_factory=list)
    approach: list[np.ndarray] = field(default_factory=list)
    read: list[str] = field(default_factory=list)
    wishes: list[tuple[str, list[int], int]] = field(default_factory=list)

    def wish(self, kind: str, places: Sequence[Place], approach: np.ndarray, one: bool, read: str = "") -> None:
        """One measurement of the places together, or each on its own."""
        index = list(range(len(self.places), len(self.places) + len(places)))
        self.places += places
        self.approach += [np.asarray(a) for a in np.broadcast_to(approach, (len(places), approach.shape[-1]))]
        self.read += [read] * len(places)
        self.wishes += [(kind, index, 2)] if one else [(kind, [i], 1) for i in index]


@dataclass(frozen=True, slots=True, eq=False)
class Proposed:
    """A campaign of all states that are proposed, and which of them each measurement consists of.

    clamped : tensions (m,) [N] at which cables were clamped, for the states of the measurement of that kind
    """

    campaign: Campaign
    measurements: tuple[tuple[Measurement, tuple[int, ...]], ...]
    clamped: np.ndarray


def proposed(campaign: Campaign) -> Proposed:
    """Everything that could be measured at the robot next."""
    home, wishes = home_of(campaign), _wishes(campaign)
    good, how = held(campaign, wishes.places)
    chosen = [(kind, [i for i in index if good[i]][:MOST], least) for kind, index, least in wishes.wishes]
    chosen = [(kind, index, least) for kind, index, least in chosen if len(index) >= least]
    kept = sorted({i for _, index, _ in chosen for i in index})
    states = _static(campaign, [wishes.places[i] for i in kept], how.tensions[kept], how.lengths[kept],
                     np.array([wishes.approach[i] for i in kept]), [wishes.read[i] == "length" for i in kept])  # fmt: skip
    found = [
        (_measurement(kind, [wishes.places[i] for i in index]), tuple(kept.index(i) for i in index))
        for kind, index, _ in chosen
    ]
    new, clamped = campaign.with_states_only(states), np.zeros(len(campaign.robot.cables))
    new = _with_frequencies(new, found)
    empty = next((i for i, p in enumerate(wishes.places) if good[i] and p.payload == 0.0 and p.position is home.position
                  and p.angles is home.angles), None)  # fmt: skip
    if empty is not None and len(campaign.robot.cables) >= 6:
        clamped = how.tensions[empty]
        for kind in ("locked", "clamped"):
            more, places = _locked(campaign, home, how.lengths[empty], int(new.states.lock.max()) + 1)
            index = tuple(range(len(new.states.names), len(new.states.names) + len(places)))
            new = replace(new, states=joined(new.states, more))
            found.append((_measurement(kind, places), index))
    return Proposed(new, tuple(found), clamped)


def _measurement(kind: str, places: Sequence[Place]) -> Measurement:
    usual = Sigmas()
    sigma = {"encoders": usual.length_m, "locked": usual.position_m, "clamped": usual.position_m}.get(kind, np.nan)
    return Measurement(kind, "", tuple(places), sigma, CABLE_MODES if kind == "cable_frequencies" else 0)


def _wishes(campaign: Campaign) -> _States:
    home, states, found = home_of(campaign), campaign.states, _States()
    known = np.isfinite(states.approach).all(axis=1)
    usual = np.ones(len(campaign.robot.cables)) if known.any() else np.full(len(campaign.robot.cables), np.nan)
    against = -states.approach[np.flatnonzero(known)[0]] if known.any() else -np.ones(len(campaign.robot.cables))
    found.wish("pose", moved(campaign, home, _AXES), usual, False)
    found.wish("tilt", tilted(home), usual, False)
    found.wish("payload", loaded(campaign, home, [STEP_LOAD]), usual, False)
    found.wish("approach", [home], against, False)
    if not states.has_length.any():
        found.wish("encoders", [home], usual, False, "length")
    found.wish("cable_frequencies", [home], usual, False)
    found.wish("robot_frequencies", [home], usual, False)
    found.wish("tilts", tilted(home), usual, True)
    found.wish("poses", moved(campaign, home, _CORNERS), usual, True)
    found.wish("payloads", loaded(campaign, home, PAYLOADS), usual, True)
    sides = np.flatnonzero(known & np.isfinite(states.position).all(axis=1) & np.isfinite(states.angles).all(axis=1))
    sides = sides[:MOST]
    again = [Place(states.position[i], states.angles[i], float(states.payload[i])) for i in sides]
    found.wish("sides", again, -states.approach[sides], True)
    return found


def _static(
    campaign: Campaign, places: Sequence[Place], tension: np.ndarray, length: np.ndarray, approach: np.ndarray,
    encoders: Sequence[bool],
) -> States:  # fmt: skip
    """Static states; sigmas are the medians of the campaign's own, else those of good sensors."""
    old, usual, (count, m) = campaign.states, Sigmas(), tension.shape
    with_length = np.array(encoders) | old.has_length.any()
    return States(
        names=tuple(f"proposed {i + 1}" for i in range(count)),
        position=np.array([p.position for p in places]), angles=np.array([p.angles for p in places]),
        sigma_position=np.full(count, np.median(old.sigma_position)),
        sigma_rotation=np.full(count, np.median(old.sigma_rotation)),
        payload=np.array([p.payload for p in places]), tension=tension,
        tension_sigma=np.full((count, m), _middle(old.tension_sigma, usual.tension_N)),
        length=np.where(with_length[:, None], length, np.nan),
        length_sigma=np.full((count, m), _middle(old.length_sigma, usual.length_m)),
        lock=np.where(with_length, np.arange(count), -1), loaded=np.zeros(count, dtype=bool),
        static=np.ones(count, dtype=bool), temperature=np.full(count, np.nan), approach=approach,
        time=np.full(count, np.nan),
    )  # fmt: skip


def _middle(values: np.ndarray, default: float) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else default


def joined(first: States, second: States) -> States:
    """States of both, in this order."""
    columns = {name: (getattr(first, name), getattr(second, name)) for name in States.__slots__}
    return States(**{n: a + b if n == "names" else np.concatenate([a, b]) for n, (a, b) in columns.items()})


def _locked(campaign: Campaign, home: Place, length: np.ndarray, lock: int) -> tuple[States, list[Place]]:
    """Poses at locked lengths under payloads, tracked and read as well as good sensors can."""
    usual, places = Sigmas(), loaded(campaign, home, _LOADS)
    robot = RobotArrays.of(campaign.robot).with_point_masses(np.array([[p.payload] for p in places]), np.zeros(3))
    count, length = len(places), np.tile(length, (len(places), 1))
    hangs = forward(robot, length, home.position, rotation(*home.angles), campaign.cable_model)
    blank = np.full_like(length, np.nan)
    states = States(
        names=tuple(f"locked {lock}, {i + 1}" for i in range(count)), position=hangs.position,
        angles=np.array([_angles(turn) for turn in hangs.rotation]), sigma_position=np.full(count, usual.position_m),
        sigma_rotation=np.full(count, np.radians(usual.rotation_deg)), payload=np.array([p.payload for p in places]),
        tension=blank, tension_sigma=blank, length=length, length_sigma=np.full_like(length, usual.length_m),
        lock=np.full(count, lock), loaded=np.ones(count, dtype=bool), static=np.zeros(count, dtype=bool),
        temperature=np.full(count, np.nan), approach=blank, time=np.full(count, np.nan),
    )  # fmt: skip
    return states, places


def _angles(turn: np.ndarray) -> np.ndarray:
    """rx, ry, rz [rad] of R = Rz Ry Rx."""
    return np.array(
        [np.arctan2(turn[2, 1], turn[2, 2]), -np.arcsin(np.clip(turn[2, 0], -1.0, 1.0)),
         np.arctan2(turn[1, 0], turn[0, 0])]
    )  # fmt: skip


def _with_frequencies(campaign: Campaign, found: list[tuple[Measurement, tuple[int, ...]]]) -> Campaign:
    """Frequencies in their states: the first in-plane ones of every cable, six of the robot; sigmas relative."""
    robot, m, states = campaign.robot, len(campaign.robot.cables), campaign.states
    index = {measurement.kind: own[0] for measurement, own in found if own}
    cables, peaks = campaign.cable_frequencies, campaign.robot_frequencies
    if "cable_frequencies" in index:
        state = index["cable_frequencies"]
        cable, mode = (a.ravel() for a in np.meshgrid(np.arange(m), np.arange(1, CABLE_MODES + 1), indexing="ij"))
        chord = np.linalg.norm(robot.frame_anchors - states.position[state], axis=1)
        hertz = mode * (np.sqrt(states.tension[state] / robot.linear_density) / (2.0 * chord))[cable]
        plane, sigma = np.ones(cable.size, dtype=bool), Sigmas().frequency(hertz)
        cables = CableFrequencies(np.full(cable.size, state), cable, mode, plane, hertz, sigma)
    if "robot_frequencies" in index:
        state = index["robot_frequencies"]
        place, turn = states.position[state], rotation(*states.angles[state])
        _, how = held(campaign, [Place(place, states.angles[state], 0.0)])
        hertz = static_frequencies(OperatingPoint(robot, place, turn, how.cables.at(0)))
        if np.isfinite(hertz).all():
            peaks = RobotFrequencies(np.full(6, state), hertz, Sigmas().frequency(hertz))
    return replace(campaign, cable_frequencies=cables, robot_frequencies=peaks)
