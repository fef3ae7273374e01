"""Several states measured in one go: tilts, poses, payloads, both sides, and payloads on clamped cables."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.planned_states import (
    ASIDE,
    LOADS,
    RAISED,
    TILT,
    Proposal,
    held_at,
    home_of,
    locked,
    new_states,
    rounded,
)
from cdpr_struct.diagnosis.world import World
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.side_by_side import side_by_side

MOST = 4  # states of a series
_PAYLOADS = (0.15, 0.3, 0.45)  # of the platform's mass

Place = tuple[np.ndarray, np.ndarray, float]
"""Position (3,) [m], angles (3,) [rad], payload [kg]."""


def series(campaign: Campaign) -> list[Proposal]:
    """All series of states that the robot can hold."""
    home = home_of(campaign)

    def made(make: Callable[[Campaign, int], Iterator[Proposal]]) -> list[Proposal]:
        return list(make(campaign, home))

    families = side_by_side(made, (_tilts, _poses, _payloads, _other_side, _clamped), (campaign,))
    return [proposal for family in families for proposal in family]


def _tilts(campaign: Campaign, home: int) -> Iterator[Proposal]:
    turns = np.concatenate([TILT * np.eye(3)[:2], -TILT * np.eye(3)[:2], TILT * np.eye(3)[2:], -TILT * np.eye(3)[2:]])
    states = campaign.states
    places = [(states.position[home], states.angles[home] + turn, 0.0) for turn in turns]
    yield from _static(campaign, "tilts", places, f"{{count}} poses tilted by {np.degrees(TILT):.0f} deg")


def _poses(campaign: Campaign, home: int) -> Iterator[Proposal]:
    states, anchors = campaign.states, campaign.robot.frame_anchors
    width = np.ptp(anchors, axis=0)
    above = float(abs(anchors[:, 2].mean() - states.position[home, 2]))
    size = np.array([ASIDE * width[0], ASIDE * width[1], RAISED * above])
    steps = size * np.array([[1, 1, 1], [-1, -1, 1], [1, -1, -1], [-1, 1, -1], [0, 0, 1], [0, 0, -1]])
    places = [(states.position[home] + step, states.angles[home], 0.0) for step in steps]
    words = f"{{count}} poses up to {np.linalg.norm(size):.1f} m from the middle"
    yield from _static(campaign, "poses", places, words)


def _payloads(campaign: Campaign, home: int) -> Iterator[Proposal]:
    states, loads = campaign.states, [rounded(share * campaign.robot.platform.mass) for share in _PAYLOADS]
    places = [(states.position[home], states.angles[home], load) for load in loads]
    shown = ", ".join(f"{load:g}" for load in loads)
    yield from _static(campaign, "payloads", places, f"a payload series of {shown} kg at one pose")


def _other_side(campaign: Campaign, home: int) -> Iterator[Proposal]:
    states = campaign.states
    known = np.flatnonzero(np.isfinite(states.approach).all(axis=1))[:MOST]
    places = [(states.position[i], states.angles[i], float(states.payload[i])) for i in known]
    kept = [n for n, place in enumerate(places) if held_at(campaign, *place) is not None]
    words = "{count} of the poses again, approached from the other side"
    for own in _static(campaign, "sides", [places[n] for n in kept], words):
        against = replace(own.campaign.states, approach=-states.approach[known[kept]])
        yield replace(own, campaign=replace(own.campaign, states=against))


def _static(campaign: Campaign, family: str, places: list[Place], words: str) -> Iterator[Proposal]:
    """Static states at the first places that the robot holds with all cables taut, two or more."""
    found: list[tuple[np.ndarray | float, ...]] = []
    for place in places:
        held = held_at(campaign, *place) if len(found) < MOST else None
        if held is not None:
            found.append((*place, held.tensions, held.lengths))
    if len(found) > 1:
        states = new_states(campaign, *(np.array(column) for column in zip(*found, strict=True)))
        yield Proposal(family, words.format(count=len(found)), campaign.with_states_only(states))


def _clamped(campaign: Campaign, home: int) -> Iterator[Proposal]:
    """Payloads on cables clamped at their exits with the platform empty.

    What lies behind a clamp keeps the stretch that it had when the clamp was set, and does not stretch any more.
    """
    states = campaign.states
    held = held_at(campaign, states.position[home], states.angles[home], LOADS[0])
    if held is not None:
        for own in locked(campaign, home):
            acts = {"dead_length": _kept_stretch(held.tensions)}
            words = "clamp the cables at their exits, then " + own.text.replace(
                "poses at locked lengths", "track poses"
            )
            yield replace(own, family="clamped", text=words.replace(", tracked", ""), acts=acts)


def _kept_stretch(tension: np.ndarray) -> Callable[[World, np.ndarray], World]:
    """Dead lengths (..., m) [m] as what they have let out at the tensions (m,) [N] of clamping."""

    def act(world: World, theta: np.ndarray) -> World:
        return world.plus(length_offset=theta * tension / world.axial_stiffness)

    return act
