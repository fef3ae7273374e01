"""What people do to data and models: units, signs, exchanged channels and poses, conventions, effects left out.

Each hypothesis is a corrected campaign: a transformation of its readings, or a switch of the simulation under test.
"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np

from cdpr_struct.hypotheses.conventions import conventions
from cdpr_struct.hypotheses.correction import BEYOND_NOISE, Correction, several_tilted, with_states
from cdpr_struct.hypotheses.exchanged import exchanged_records
from cdpr_struct.measurement.campaign import Campaign, States

TENSION_UNITS = {"kgf": 9.80665, "lbf": 4.4482216, "kN": 1000.0, "daN": 10.0}
LENGTH_UNITS = {"mm": 1e-3, "ft": 0.3048}
PAIRS_OF_STATES = 2000  # static ones: all of 63


def corrections(campaign: Campaign) -> list[Correction]:
    """Every hypothesis about the handling of the data, with the number of its kind filled in."""
    tried = (_units, _signs, _senses, _swaps, _exchanged_poses, exchanged_records, conventions)
    families = [list(f(campaign)) for f in tried]
    return [replace(c, alternatives=len(family)) for family in families for c in family]


def shortcuts(campaign: Campaign) -> list[Correction]:
    """Effects that the simulation under test leaves out."""
    found = []
    if campaign.model == "spring":
        better = replace(campaign, model="dsm")
        found.append(Correction("cable_sag", "the simulation leaves out the weight of the cables", better))
    if campaign.model == "static" and campaign.robot_frequencies.hertz.size:
        better = replace(campaign, model="dsm")
        found.append(
            Correction("cable_dynamics", "the simulation leaves out the vibration of the cables themselves", better)
        )
    if campaign.assembly == "thesis" and campaign.robot_frequencies.hertz.size:
        better = replace(campaign, assembly="consistent")
        why = "the simulation leaves out the geometric stiffness of the rotating attachments"
        found.append(Correction("attachment_geometric_stiffness", why, better))
    return found


def _units(campaign: Campaign) -> Iterator[Correction]:
    states, m = campaign.states, campaign.states.tension.shape[1]
    whole = range(-1, m)
    for which in whole if np.isfinite(states.tension).any() else ():
        for unit, factor in TENSION_UNITS.items():
            ways = ((factor, f"are not in N but in {unit}"), (1.0 / factor, f"were converted from {unit}, though in N"))
            for size, wrong in ways:
                scale = np.ones(m)
                scale[slice(None) if which < 0 else which] = size
                who = "the tensions" if which < 0 else f"the tensions of cable {which + 1}"
                new = _with_scaled(campaign, "tension", scale)
                said, own = f"{who} {wrong}", np.concatenate([np.zeros(6, bool), scale != 1.0, np.zeros(m, bool)])
                yield _in_unit(said, new, size, own)
    for unit, factor in LENGTH_UNITS.items():
        for what in ("length", "position"):
            new = _with_scaled(campaign, what, factor)
            yield _in_unit(f"the {what}s are in {unit}", new, factor, _columns(what, m))
    yield from _angle_units(campaign)
    for factor, unit in ((0.45359237, "lb"), (1.0 / 9.80665, "N")) if np.any(states.payload) else ():
        new = with_states(campaign, payload=states.payload * factor)
        yield Correction("unit_error", f"the payloads are in {unit}", new, parameters={"factor": factor})
    for what in ("cable_frequencies", "robot_frequencies"):
        rows = getattr(campaign, what)
        if rows.hertz.size:
            turn = 0.5 / np.pi
            new = replace(campaign, **{what: replace(rows, hertz=rows.hertz * turn, sigma=rows.sigma * turn)})
            yield Correction(
                "unit_error", f"the {what.replace('_', ' ')} are in rad/s", new, parameters={"factor": turn}
            )


def _angle_units(campaign: Campaign) -> Iterator[Correction]:
    """Pose angles in another unit, if they are tilts then or now: few degrees that are filed in rad look like noise."""
    states = campaign.states
    turned = ((np.degrees(1.0), "are in rad"), (np.radians(1.0), "were converted from rad, though in deg"))
    for factor, wrong in turned:
        new = with_states(campaign, angles=states.angles * factor)
        if several_tilted(new.states if factor > 1.0 else states, BEYOND_NOISE):
            own = _columns("angles", states.tension.shape[1])
            yield _in_unit(f"the pose angles {wrong}", new, factor, own)


def _with_scaled(campaign: Campaign, what: str, factor: float | np.ndarray) -> Campaign:
    """Readings of a kind times a factor, and their rates."""
    new, frames = with_states(campaign, **{what: getattr(campaign.states, what) * factor}), campaign.frames
    return new if frames is None else replace(new, frames=frames.scaled(what, factor))


def _in_unit(said: str, new: Campaign, factor: float, columns: np.ndarray) -> Correction:
    """Readings of some columns (6 + 2 m) times a factor."""
    which = np.broadcast_to(columns, (len(new.states.names), len(columns)))
    return Correction("unit_error", said, new, stretched=(factor, which), parameters={"factor": factor})


def _columns(what: str, m: int) -> np.ndarray:
    """(6 + 2 m) bool, the readings of a kind."""
    places = {"position": slice(0, 3), "angles": slice(3, 6), "length": slice(6 + m, None)}
    found = np.zeros(6 + 2 * m, dtype=bool)
    found[places[what]] = True
    return found


def _signs(campaign: Campaign) -> Iterator[Correction]:
    states = campaign.states
    for who in range(-1, len(states.names)):
        rows = slice(None) if who < 0 else slice(who, who + 1)
        where = "" if who < 0 else f" of case {states.names[who]}"
        for what, names in (("position", "x y"), ("angles", "rx ry rz")):
            for axis, name in enumerate(names.split()):
                values = getattr(states, what).copy()
                if not np.any(np.abs(values[rows, axis]) > 1e-3):
                    continue
                values[rows, axis] *= -1.0
                new = with_states(campaign, **{what: values})
                if who < 0 and what == "position" and campaign.frames is not None:
                    new = replace(new, frames=campaign.frames.scaled(what, 1.0 - 2.0 * (np.arange(3) == axis)))
                yield Correction("sign_error", f"the sign of {name}{where} is wrong", new, parameters={"column": name})


def _senses(campaign: Campaign) -> Iterator[Correction]:
    """Encoders on swivels that count the other way round: all of them, or one that is mounted upside down."""
    swivel = campaign.states.swivel
    read = np.flatnonzero(np.isfinite(swivel).sum(axis=0) > 1).tolist()
    for which in ([read] if len(read) > 1 else []) + [[i] for i in read]:
        sense = np.ones(swivel.shape[1])
        sense[which] = -1.0
        of = f"the swivel angle of cable {which[0] + 1}" if len(which) == 1 else "the swivel angles"
        new = with_states(campaign, swivel=swivel * sense)
        yield Correction("sign_error", f"the sense of {of} is wrong", new, parameters={"column": "swivel"})


def _swaps(campaign: Campaign) -> Iterator[Correction]:
    states = campaign.states
    for what in ("tension", "length", "swivel"):
        values = getattr(states, what)
        if not np.isfinite(values).any():
            continue
        for i, j in combinations(range(values.shape[1]), 2):
            order = np.arange(values.shape[1])
            order[[i, j]] = j, i
            new = with_states(
                campaign, **{what: values[:, order], f"{what}_sigma": getattr(states, f"{what}_sigma")[:, order]}
            )
            if campaign.frames is not None:
                new = replace(new, frames=campaign.frames.in_order(what, order))
            says = f"the {what} channels of cables {i + 1} and {j + 1} are swapped"
            yield Correction("swapped_channels", says, new, parameters={"first": i + 1, "second": j + 1})


def _exchanged_poses(campaign: Campaign) -> Iterator[Correction]:
    states: States = campaign.states
    rows = np.flatnonzero(states.static)
    for step in (1, -1) if rows.size > 2 else ():
        order = np.arange(len(states.names))
        order[rows] = np.roll(rows, step)
        new = with_states(campaign, position=states.position[order], angles=states.angles[order])
        says = f"the poses of the static states are entered one row too {'early' if step > 0 else 'late'}"
        yield Correction("pose_mismatch", says, new, parameters={"rows": step})
    for i, j in list(combinations(rows.tolist(), 2))[:PAIRS_OF_STATES]:
        order = np.arange(len(states.names))
        order[[i, j]] = j, i
        new = with_states(campaign, position=states.position[order], angles=states.angles[order])
        says = f"the poses of cases {states.names[i]} and {states.names[j]} are swapped"
        yield Correction("pose_mismatch", says, new, parameters={"first": i + 1, "second": j + 1})
