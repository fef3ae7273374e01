"""States that could be measured next, with the model's own noise-free readings, as small campaigns of their own."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.residuals import residuals
from cdpr_struct.diagnosis.setting import make_setting
from cdpr_struct.diagnosis.world import World
from cdpr_struct.dynamics.natural_frequencies import static_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign, RobotFrequencies, Sigmas, States
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse

ASIDE, RAISED = 0.15, 0.25  # of the frame's width, of the height below the frame anchors: steps to another pose
TILT = np.radians(10.0)
LOADS = (0.0, 0.15, 0.3)  # of the platform's mass, at locked lengths
STEP_LOAD = 0.25
CABLE_MODES = 4
_SHARE = 0.003  # relative sigma of a frequency
_LEAST = 0.02  # of the platform's weight: tension that every cable must have at a proposed pose


@dataclass(frozen=True, slots=True, eq=False)
class Proposal:
    """Something to measure: its family (of which the best is shown), words for a person, the states with readings.

    acts : what causes do there, if not what they do elsewhere
    """

    family: str
    text: str
    campaign: Campaign
    acts: Mapping[str, Callable[[World, np.ndarray], World]] = field(default_factory=dict)


def proposals(campaign: Campaign) -> list[Proposal]:
    """All states that the robot can hold among those that could be added to a campaign; new states only."""
    home = home_of(campaign)
    found = []
    for make in (_other_poses, _tilts, _payload, _encoders, locked, _cables, _robot, _other_side):
        found += list(make(campaign, home))
    return found


def of_lacking_kinds(campaign: Campaign) -> list[Proposal]:
    """Those of kinds of data that the campaign has nothing of."""
    kinds, home = campaign.kinds(), home_of(campaign)
    makers = {"loaded_pose": locked, "cable_frequency": _cables, "robot_frequency": _robot}
    lacking = [_encoders, *(make for kind, make in makers.items() if kind not in kinds)]
    return [proposal for make in lacking for proposal in make(campaign, home)]


def one_sided(campaign: Campaign) -> Campaign:
    """The campaign with every state approached from the same side where nobody said from which."""
    approach = campaign.states.approach
    if np.isfinite(approach).any():
        return campaign
    return replace(campaign, states=replace(campaign.states, approach=np.ones_like(approach)))


def home_of(campaign: Campaign) -> int:
    """The state nearest to the mean position."""
    position = campaign.states.position
    return int(np.linalg.norm(position - position.mean(axis=0), axis=1).argmin())


def _other_poses(campaign: Campaign, home: int) -> Iterator[Proposal]:
    states, anchors = campaign.states, campaign.robot.frame_anchors
    width = np.ptp(anchors, axis=0)
    above = float(abs(anchors[:, 2].mean() - states.position[home, 2]))
    steps = np.array([ASIDE * width[0], ASIDE * width[1], RAISED * above])
    for axis in range(3):
        for sign in (1.0, -1.0):
            place = states.position[home].copy()
            place[axis] += sign * steps[axis]
            yield from _static(campaign, "pose", place, states.angles[home], 0.0, "static state at {place}")


def _tilts(campaign: Campaign, home: int) -> Iterator[Proposal]:
    for axis, name in enumerate(("rx", "ry", "rz")):
        for sign in (1.0, -1.0):
            angles = campaign.states.angles[home].copy()
            angles[axis] += sign * TILT
            words = f"static state at {{place}}, {name} {sign * 10.0:+.0f} deg"
            yield from _static(campaign, "tilt", campaign.states.position[home], angles, 0.0, words)


def _payload(campaign: Campaign, home: int) -> Iterator[Proposal]:
    load = rounded(STEP_LOAD * campaign.robot.platform.mass)
    words = f"static state with a payload of {load:g} kg at {{place}}"
    states = campaign.states
    yield from _static(campaign, "payload", states.position[home], states.angles[home], load, words)


def _other_side(campaign: Campaign, home: int) -> Iterator[Proposal]:
    states = campaign.states
    words = "the state at {place} again, approached from the other side"
    for own in _static(campaign, "approach", states.position[home], states.angles[home], 0.0, words):
        against = np.where(np.isfinite(states.approach[home]), -states.approach[home], -1.0)[None]
        yield replace(own, campaign=replace(own.campaign, states=replace(own.campaign.states, approach=against)))


def _encoders(campaign: Campaign, home: int) -> Iterator[Proposal]:
    """Home once more with lengths, for a campaign without any."""
    states, usual = campaign.states, Sigmas()
    if states.has_length.any():
        return
    words = f"the state at {{place}} again with encoder lengths to {1e3 * usual.length_m:g} mm"
    for own in _static(campaign, "encoders", states.position[home], states.angles[home], 0.0, words):
        held = held_at(campaign, states.position[home], states.angles[home], 0.0)
        if held is not None:
            new = replace(own.campaign.states, length=held.lengths[None], lock=np.zeros(1, dtype=int))
            yield replace(own, campaign=replace(own.campaign, states=new))


def _static(
    campaign: Campaign, family: str, place: np.ndarray, angles: np.ndarray, load: float, words: str
) -> Iterator[Proposal]:
    """One state with the kinds of reading that the campaign has, if the robot holds it with all cables taut."""
    held = held_at(campaign, place, angles, load)
    if held is None:
        return
    states = new_states(campaign, place[None], angles[None], np.array([load]), held.tensions[None], held.lengths[None])
    where = f"({', '.join(f'{v:.2f}' for v in place)}) m"
    yield Proposal(family, words.format(place=where), campaign.with_states_only(states))


def held_at(campaign: Campaign, place: np.ndarray, angles: np.ndarray, load: float) -> InverseSolution | None:
    try:
        robot, turn = campaign.robot.with_load(load), rotation(*angles)
        held = inverse(robot, place, turn, campaign.cable_model, lower_bound=campaign.lower_bound)
    except CdprError:
        return None
    weight = campaign.robot.platform.mass * campaign.robot.gravity
    return held if float(held.tensions.min()) > _LEAST * weight else None


def new_states(
    campaign: Campaign, place: np.ndarray, angles: np.ndarray, load: np.ndarray, tension: np.ndarray, length: np.ndarray
) -> States:
    """S new static states; sigmas are the medians of the campaign's own, else those of good sensors."""
    old, usual, (count, m) = campaign.states, Sigmas(), tension.shape
    with_length = bool(old.has_length.any())
    blank = np.full((count, m), np.nan)
    approach = np.ones((count, m)) if np.isfinite(old.approach).any() else blank
    return States(
        names=tuple(f"proposed {i + 1}" for i in range(count)), position=place, angles=angles,
        sigma_position=np.full(count, np.median(old.sigma_position)),
        sigma_rotation=np.full(count, np.median(old.sigma_rotation)), payload=load, tension=tension,
        tension_sigma=np.full((count, m), _middle(old.tension_sigma, usual.tension_N)),
        length=length if with_length else blank,
        length_sigma=np.full((count, m), _middle(old.length_sigma, usual.length_m)),
        lock=np.arange(count) if with_length else np.full(count, -1), loaded=np.zeros(count, dtype=bool),
        static=np.ones(count, dtype=bool), temperature=np.full(count, np.nan), approach=approach,
        time=np.full(count, np.nan),
    )  # fmt: skip


def _middle(values: np.ndarray, default: float) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else default


def locked(campaign: Campaign, home: int) -> Iterator[Proposal]:
    """Poses at locked lengths under three payloads, tracked and read as well as good sensors can."""
    states, robot, usual = campaign.states, campaign.robot, Sigmas()
    place, angles = states.position[home], states.angles[home]
    held = held_at(campaign, place, angles, 0.0)
    if held is None or len(robot.cables) < 6:
        return
    loads = np.array([rounded(share * robot.platform.mass) for share in LOADS])
    hangs = [
        forward(robot.with_load(float(w)), held.lengths, place, rotation(*angles), campaign.cable_model) for w in loads
    ]
    count, m = len(loads), len(robot.cables)
    length = np.tile(held.lengths, (count, 1))
    plain = new_states(campaign, place[None], angles[None], loads[:1], held.tensions[None], length[:1])
    new = replace(
        plain, names=tuple(f"proposed {i + 1}" for i in range(count)),
        position=np.array([h.position for h in hangs]), angles=np.array([_angles(h.rotation) for h in hangs]),
        sigma_position=np.full(count, usual.position_m), sigma_rotation=np.full(count, np.radians(usual.rotation_deg)),
        payload=loads, tension=np.full((count, m), np.nan), tension_sigma=np.full((count, m), np.nan), length=length,
        length_sigma=np.full((count, m), usual.length_m), lock=np.zeros(count, dtype=int),
        loaded=np.ones(count, dtype=bool), static=np.zeros(count, dtype=bool), temperature=np.full(count, np.nan),
        approach=np.full((count, m), np.nan), time=np.full(count, np.nan),
    )  # fmt: skip
    shown = ", ".join(f"{w:g}" for w in loads)
    text = f"poses at locked lengths with {shown} kg, tracked to {1e3 * usual.position_m:g} mm"
    yield Proposal("locked", text, campaign.with_states_only(new))


def _angles(turn: np.ndarray) -> np.ndarray:
    """rx, ry, rz [rad] of R = Rz Ry Rx."""
    return np.array(
        [np.arctan2(turn[2, 1], turn[2, 2]), -np.arcsin(np.clip(turn[2, 0], -1.0, 1.0)),
         np.arctan2(turn[1, 0], turn[0, 0])]
    )  # fmt: skip


def _cables(campaign: Campaign, home: int) -> Iterator[Proposal]:
    """The first in-plane frequencies of every cable at home."""
    states, m = campaign.states, len(campaign.robot.cables)
    words = f"frequencies 1 to {CABLE_MODES} of every cable at {{place}}"
    for own in _static(campaign, "cable frequencies", states.position[home], states.angles[home], 0.0, words):
        cable, mode = (a.ravel() for a in np.meshgrid(np.arange(m), np.arange(1, CABLE_MODES + 1), indexing="ij"))
        chord = np.linalg.norm(campaign.robot.frame_anchors - states.position[home], axis=1)
        first = np.sqrt(own.campaign.states.tension[0] / campaign.robot.linear_density) / (2.0 * chord)
        guess, none = mode * first[cable], np.zeros(cable.size, dtype=int)
        rows = CableFrequencies(none, cable, mode, np.ones(cable.size, dtype=bool), guess, _SHARE * guess)
        yield replace(own, campaign=_tuned(replace(own.campaign, cable_frequencies=rows)))


def _robot(campaign: Campaign, home: int) -> Iterator[Proposal]:
    """Six frequencies of the robot at home in which the platform moves."""
    states = campaign.states
    words = "robot frequencies at {place}"
    for own in _static(campaign, "robot frequencies", states.position[home], states.angles[home], 0.0, words):
        turn = rotation(*states.angles[home])
        held = inverse(campaign.robot, states.position[home], turn, lower_bound=campaign.lower_bound)
        hertz = static_frequencies(OperatingPoint(campaign.robot, states.position[home], turn, held.cables))
        if not np.isfinite(hertz).all():
            return
        rows = RobotFrequencies(np.zeros(6, dtype=int), hertz, _SHARE * hertz)
        try:
            yield replace(own, campaign=_tuned(replace(own.campaign, robot_frequencies=rows)))
        except InputError:  # fewer modes than six in which the platform moves
            return


def _tuned(campaign: Campaign) -> Campaign:
    """The campaign with its frequencies moved onto those of the model that they were paired with."""
    setting, _ = make_setting(campaign)
    r = residuals(setting, World.of(campaign.robot, len(campaign.states.names)), Readings.of(campaign.states))
    cable, robot = (np.exp(-r[setting.labels.block == block] / 100.0) for block in ("CF", "RF"))
    old, unlabelled = campaign.cable_frequencies, campaign.robot_frequencies
    return replace(
        campaign,
        cable_frequencies=replace(old, hertz=old.hertz * cable, sigma=old.sigma * cable),
        robot_frequencies=replace(unlabelled, hertz=unlabelled.hertz * robot, sigma=unlabelled.sigma * robot),
    )


def rounded(load: float) -> float:
    """A payload that a person would choose: two digits."""
    return float(f"{load:.2g}")
