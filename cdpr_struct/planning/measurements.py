"""What could be measured next at the robot: one state, a series of states, loads at locked lengths, frequencies.

All states that are proposed form one campaign; a measurement is a choice of its states. Readings are those of the
robot as entered, sensors as good as the campaign's own, or as good ones usually are.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from cdpr_struct.dynamics.natural_frequencies import static_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign, RobotFrequencies, Sigmas, States
from cdpr_struct.planning.places import (
    AXES,
    CORNERS,
    LOCKED,
    PAYLOADS,
    STEP_LOAD,
    Place,
    angles_of,
    held,
    home_of,
    loaded,
    moved,
    tilted,
)  # fmt: skip
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import InverseSolution
from cdpr_struct.statics.swivel_angle import swivel_angle, swivel_reference

MOST = 4  # states of a series
CABLE_MODES = 4  # in-plane modes of every cable
FREQUENCIES = ("cable_frequencies", "robot_frequencies")
SERIES = ("tilts", "poses", "payloads", "sides", "clamped")


@dataclass(frozen=True, slots=True, eq=False)
class Measurement:
    """Something to measure.

    kind  : "check", "pose", "tilt", "payload", "approach", "encoders", "locked", "cable_frequencies",
            "robot_frequencies", or a series: "poses", "tilts", "payloads", "sides", "clamped"
    check : name of what is read beside the robot, and one sigma of the reading
    places : poses and payloads of the states
    """

    kind: str
    places: tuple[Place, ...] = ()
    check: str = ""
    sigma: float = np.nan

    @property
    def family(self) -> tuple[str, str]:
        """Measurements of one family are done in the same way, elsewhere."""
        return self.kind, self.check


@dataclass(frozen=True, slots=True, eq=False)
class Proposed:
    """A campaign of all states that are proposed, and which of them each measurement consists of.

    clamped : tensions (m,) [N] at which cables are clamped in the measurement of that kind
    """

    campaign: Campaign
    measurements: tuple[tuple[Measurement, tuple[int, ...]], ...]
    clamped: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class _Wish:
    """Places to measure, approached (k, m) from a side, one by one or together."""

    kind: str
    places: Sequence[Place]
    approach: np.ndarray
    together: bool = False


def proposed(campaign: Campaign) -> Proposed:
    """Everything that could be measured at the robot next; home is the first state, if the robot holds it."""
    wishes, home = _wishes(campaign), home_of(campaign)
    places = [place for wish in wishes for place in wish.places]
    good, how = held(campaign, places)
    number, found, start = np.cumsum(good) - 1, [], 0
    for wish in wishes:
        index = [i for i in range(start, start + len(wish.places)) if good[i]]
        start += len(wish.places)
        for own in [index[:MOST]] if wish.together and len(index) > 1 else [[i] for i in index]:
            if not wish.together or len(own) > 1:
                found.append((Measurement(wish.kind, tuple(places[i] for i in own)), tuple(number[own].tolist())))
    kept = [place for place, there in zip(places, good, strict=True) if there]
    approach = np.concatenate([np.broadcast_to(w.approach, (len(w.places), how.tensions.shape[1])) for w in wishes])
    encoders = {i for what, own in found if what.kind == "encoders" for i in own}
    states = _static(
        campaign, kept, how.tensions[good], how.lengths[good], _swivels(campaign, how)[good], approach[good], encoders
    )
    new = campaign.with_states_only(states)
    if good[0]:
        new = _with_frequencies(new, found, how.cables.at(0))
        if campaign.robot.frame_anchors.shape[0] >= 6:
            new = _with_locked(new, found, home, how.lengths[0])
    found = [(what, own) for what, own in found if what.kind != "robot_frequencies" or new.robot_frequencies.hertz.size]
    return Proposed(new, tuple(found), how.tensions[0])


def _wishes(campaign: Campaign) -> list[_Wish]:
    states, home, m = campaign.states, home_of(campaign), len(campaign.robot.frame_anchors)
    known = np.isfinite(states.approach).all(axis=1)
    usual = np.full(m, 1.0 if known.any() else np.nan)
    against = -states.approach[np.flatnonzero(known)[0]] if known.any() else -np.ones(m)
    sides = np.flatnonzero(known & np.isfinite(np.hstack([states.position, states.angles])).all(axis=1))[:MOST]
    again = [Place(states.position[i], states.angles[i], float(states.payload[i])) for i in sides]
    return [
        *(_Wish(kind, [home], usual) for kind in FREQUENCIES),
        *([] if states.has_length.any() else [_Wish("encoders", [home], usual)]),
        _Wish("pose", moved(campaign, home, AXES), usual),
        _Wish("tilt", tilted(home), usual),
        _Wish("payload", loaded(campaign, home, [STEP_LOAD]), usual),
        _Wish("approach", [home], against),
        _Wish("tilts", tilted(home), usual, True),
        _Wish("poses", moved(campaign, home, CORNERS), usual, True),
        _Wish("payloads", loaded(campaign, home, PAYLOADS), usual, True),
        _Wish("sides", again, -states.approach[sides], True),
    ]


def _static(
    campaign: Campaign, places: Sequence[Place], tension: np.ndarray, length: np.ndarray, swivel: np.ndarray,
    approach: np.ndarray, encoders: set[int],
) -> States:  # fmt: skip
    """Static states; sigmas are the medians of the campaign's own, else those of good sensors."""
    old, usual, (count, m) = campaign.states, Sigmas(), tension.shape
    read = np.isin(np.arange(count), list(encoders)) | old.has_length.any()
    return States(
        names=tuple(f"proposed {i + 1}" for i in range(count)),
        position=np.array([p.position for p in places]).reshape((-1, 3)),
        angles=np.array([p.angles for p in places]).reshape((-1, 3)),
        sigma_position=np.full(count, np.median(old.sigma_position)),
        sigma_rotation=np.full(count, np.median(old.sigma_rotation)),
        payload=np.array([p.payload for p in places]), tension=tension,
        tension_sigma=np.full((count, m), _middle(old.tension_sigma, usual.tension_N)),
        length=np.where(read[:, None], length, np.nan),
        length_sigma=np.full((count, m), _middle(old.length_sigma, usual.length_m)),
        lock=np.where(read, np.arange(count), -1), loaded=np.zeros(count, dtype=bool),
        static=np.ones(count, dtype=bool), temperature=np.full(count, np.nan), approach=approach,
        time=np.full(count, np.nan), swivel=np.where(np.isfinite(old.swivel).any(axis=0), swivel, np.nan),
        swivel_sigma=np.full((count, m), np.radians(_middle(np.degrees(old.swivel_sigma), usual.swivel_deg))),
    )  # fmt: skip


def _swivels(campaign: Campaign, how: InverseSolution) -> np.ndarray:
    """(S, m) swivel angles of the pulleys where cables are held [rad]."""
    axis = RobotArrays.of(campaign.robot).pulley_axis
    return swivel_angle(how.cables.force_at_frame, axis, swivel_reference(axis))


def _middle(values: np.ndarray, default: float) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else default


def _with_locked(
    campaign: Campaign, found: list[tuple[Measurement, tuple[int, ...]]], home: Place, length: np.ndarray
) -> Campaign:
    """Payloads at locked lengths, on free and on clamped cables, tracked and read as well as good sensors can."""
    usual, places = Sigmas(), loaded(campaign, home, LOCKED)
    payload = np.array([p.payload for p in places])
    robot = RobotArrays.of(campaign.robot).with_point_masses(payload[:, None], np.zeros(3))
    length = np.tile(length, (len(places), 1))
    hangs = forward(robot, length, home.position, rotation(*home.angles), campaign.cable_model)
    if not hangs.converged.all():
        return campaign
    count, blank = len(places), np.full_like(length, np.nan)
    for kind in ("locked", "clamped"):
        first, lock = len(campaign.states.names), int(campaign.states.lock.max()) + 1
        new = States(
            names=tuple(f"{kind} {i + 1}" for i in range(count)), position=hangs.position,
            angles=np.array([angles_of(turn) for turn in hangs.rotation]),
            sigma_position=np.full(count, usual.position_m),
            sigma_rotation=np.full(count, np.radians(usual.rotation_deg)), payload=payload,
            tension=blank, tension_sigma=blank, length=length,
            length_sigma=np.full_like(blank, usual.length_m), lock=np.full(count, lock),
            loaded=np.ones(count, dtype=bool), static=np.zeros(count, dtype=bool),
            temperature=np.full(count, np.nan), approach=blank, time=np.full(count, np.nan),
        )  # fmt: skip
        campaign = replace(campaign, states=joined(campaign.states, new))
        found.append((Measurement(kind, tuple(places)), tuple(range(first, first + count))))
    return campaign


def joined(first: States, second: States) -> States:
    """States of both, in this order."""
    arrays = [f.name for f in fields(States) if f.name != "names"]
    columns = {name: np.concatenate([getattr(first, name), getattr(second, name)]) for name in arrays}
    return States(first.names + second.names, **columns)


def _with_frequencies(
    campaign: Campaign, found: Sequence[tuple[Measurement, tuple[int, ...]]], home: CableStates
) -> Campaign:
    """Frequencies at home: the first in-plane ones of every cable, six of the robot."""
    robot, states = campaign.robot, campaign.states
    of_cables, of_robot = (next(own[0] for what, own in found if what.kind == kind) for kind in FREQUENCIES)
    grid = np.meshgrid(np.arange(len(home.chord)), np.arange(1, CABLE_MODES + 1), indexing="ij")
    cable, mode = (a.ravel() for a in grid)
    hertz = mode * (np.sqrt(home.tension / robot.linear_density) / (2.0 * home.chord))[cable]
    plane, sigma = np.ones(cable.size, dtype=bool), Sigmas().frequency(hertz)
    cables = CableFrequencies(np.full(cable.size, of_cables), cable, mode, plane, hertz, sigma)
    point = OperatingPoint(robot, states.position[of_robot], rotation(*states.angles[of_robot]), home)
    hertz = static_frequencies(point)
    if not np.isfinite(hertz).all():
        return replace(campaign, cable_frequencies=cables)
    peaks = RobotFrequencies(np.full(hertz.size, of_robot), hertz, Sigmas().frequency(hertz))
    return replace(campaign, cable_frequencies=cables, robot_frequencies=peaks)
