"""Sets of campaigns along a motion: sensors that read late, clocks that run apart, alone and beside another effect."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from cdpr_struct.fem_reference import FemError
from tests.blind.case_drawing import Case, RejectedDrawError
from tests.blind.clock_sizes import Seen
from tests.blind.deviations import Deviations, drawn_tolerances
from tests.blind.entered_robot import EnteredRobot, entered_robot
from tests.blind.measuring_plan import angles_deg
from tests.blind.motion import MARGIN, STEP, Motion, commanded, drawn_curve, moved, planned
from tests.blind.observation import SlackStateError
from tests.blind.sensors import POSE

ROBOTS = ("thesis-3-1", "cogiro", "thesis-5", "four-cables")
ATTEMPTS = 400  # most draws are too slow or too fast for a delay that occurs
FRAMES = 144
LONG = 240  # frames where clocks run apart
MULTIPLE = 4.0  # of what can be detected
SPEEDS = (0.05, 0.8)  # m/s, the largest of a motion
DELAYS = (0.005, 0.08)  # s, of hidden ones
RATES = (1e-4, 5e-3)  # of hidden drifts
START = 0.03  # s rms, by which clocks differ that were never set alike
SMALLEST = {"position_m": 0.0005, "length_m": 0.0003, "tension_N": 1.0}
LARGEST = {"position_m": 0.003, "length_m": 0.0015, "tension_N": 4.0}
LEVER = 0.5  # m, over which a tracker's markers tell its turn
SEPARABLE = 3.0  # sigmas that what else may be wrong with the same cables leaves of a second effect
WIDE = 0.01  # m: one sigma of what else may be wrong
SECOND = ("frame_anchor_position", "unstrained_length_offset", "axial_stiffness")
PLAUSIBLE = {"frame_anchor_position": 0.05, "unstrained_length_offset": 0.05, "axial_stiffness": 0.5}
UNITS = {"frame_anchor_position": "m", "unstrained_length_offset": "m", "axial_stiffness": "ln ratio"}
DELAY, DRIFT = "sensor_delay", "clock_drift"
WAYS = ("alike", "lengths", "tensions", "one", "each")
SHARES = (("null", 4), *((way, 3) for way in WAYS), ("drift", 2), ("drift from a start", 2), ("pair", 7))


@dataclass(frozen=True)
class MovingKind:
    """What a case is to hold.

    way : null; alike, of the poses against all else; lengths, tensions: of those alone; one, each: of the encoder of
    one cable, of each; drift: set alike at the start; "drift from a start": never set alike
    second : another effect beside;  tensions : whether they are read
    """

    way: str
    second: str = ""
    tensions: bool = True


def moving_kinds(total: int, base: int) -> list[MovingKind]:
    """Kinds of all cases in the order in which they are numbered, which tells nothing about them."""
    rng = np.random.default_rng([base, 0])
    whole = sum(share for _, share in SHARES)
    names = [name for name, share in SHARES for _ in range(round(total * share / whole))]
    names = (names + ["alike"] * total)[:total]
    kinds, pairs = [], 0
    for number, name in enumerate(names):
        tensions = name in ("lengths", "tensions") or number % 2 == 0
        second, way = "", name
        if name == "pair":
            second, way = SECOND[pairs % len(SECOND)], ("alike", "one", "alike", "drift")[pairs % 4]
            tensions, pairs = tensions or second == "axial_stiffness", pairs + 1
        kinds.append(MovingKind(way, second, tensions))
    return [kinds[index] for index in rng.permutation(total)]


def moving_case(kind: MovingKind, seed: tuple[int, ...]) -> Case:
    """The case of a seed; the same seed gives the same case bit by bit."""
    for attempt in range(ATTEMPTS):
        try:
            return _attempt(kind, np.random.SeedSequence([*seed, attempt]))
        except (RejectedDrawError, SlackStateError, FemError):
            continue
    raise RuntimeError(f"no campaign for {kind} with seed {seed} in {ATTEMPTS} attempts")


def _attempt(kind: MovingKind, seed: np.random.SeedSequence) -> Case:
    choice, workshop, hidden, noise = (np.random.default_rng(stream) for stream in seed.spawn(4))
    robot = entered_robot(str(choice.choice(ROBOTS)))
    frames = LONG if kind.way.startswith("drift") else FRAMES
    curve = drawn_curve(robot, float(np.exp(choice.uniform(*np.log(SPEEDS)))), choice)
    sigma, time = drawn_sigma(choice), STEP * np.arange(frames)
    tolerances = drawn_tolerances(robot.cables, workshop)
    deviations = tolerances.plus("pulley_radius", -tolerances["pulley_radius"])
    seen = Seen.of(robot, planned(robot, curve, frames), time, sigma, kind.tensions)
    late, effects = drawn_delays(kind, seen, hidden)
    if kind.second:
        change, record = _second(kind.second, seen, hidden)
        deviations = deviations.plus(kind.second, change)
        effects.append(record)
    real = moved(robot, deviations, commanded(robot, curve, frames))
    table = read(robot, real, late, sigma, kind.tensions, noise)
    truth = _truth(kind, robot, effects, deviations, {**sigma, "frames": frames})
    return Case(robot, {"static_state": table}, truth, sigma=sigma)


def drawn_sigma(rng: np.random.Generator) -> dict[str, float]:
    """One sigma of sensors of some quality."""
    found = {key: float(np.exp(rng.uniform(np.log(low), np.log(LARGEST[key])))) for key, low in SMALLEST.items()}
    return found | {"rotation_deg": float(np.degrees(found["position_m"] / LEVER))}


@dataclass(frozen=True, eq=False)
class Late:
    """By how much poses are older than lengths and tensions, (m,) each or one number [s], and grow older [s/s]."""

    lengths: np.ndarray
    tensions: np.ndarray
    drift: float = 0.0


def drawn_delays(kind: MovingKind, seen: Seen, rng: np.random.Generator) -> tuple[Late, list[dict[str, Any]]]:
    """Delays of a case, and their record; `MULTIPLE` times what can be detected in its data."""
    m = seen.robot.cables
    if kind.way == "null":
        return Late(np.zeros(m), np.zeros(m)), []
    if kind.way.startswith("drift"):
        return _drifting(kind, seen, rng)
    lengths, tensions = _late_in(seen)
    pattern = rng.choice([-1.0, 1.0]) * np.ones(1)
    columns: list[np.ndarray] = {"lengths": [sum(lengths)], "tensions": [sum(tensions)]}.get(
        kind.way, [sum(lengths) + sum(tensions)]
    )
    if kind.way == "one":
        cable = int(rng.integers(m))
        columns = [lengths[cable]]
    elif kind.way == "each":
        columns, pattern = lengths, rng.standard_normal(m)
    size = MULTIPLE * seen.size(columns, pattern, [])
    delay = _within(size * np.abs(pattern).max(), DELAYS, size) * pattern
    record = {"cause": DELAY, "multiple": MULTIPLE, "size": size, "unit": "s", "shape": kind.way}
    every = np.ones(m) * delay if kind.way != "one" else delay[0] * (np.arange(m) == cable)
    late = Late(
        every if kind.way != "tensions" else 0.0 * every, every if kind.way in ("alike", "tensions") else 0 * every
    )
    return late, [record | {"total": delay.tolist() if kind.way != "one" else [0.0] * cable + delay.tolist()}]


def _late_in(seen: Seen) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Rows (F, 6 + m) of lengths, and of tensions, that are read a second too late, by cable."""
    rates, pulls, every = seen.rate("lengths"), seen.rate("tensions"), np.eye(seen.robot.cables)
    none = np.zeros_like(rates)
    return [seen.rows(none, rates * own) for own in every], [seen.rows(pulls * own, none) for own in every]


def _drifting(kind: MovingKind, seen: Seen, rng: np.random.Generator) -> tuple[Late, list[dict[str, Any]]]:
    lengths, tensions = _late_in(seen)
    whole: np.ndarray = sum(lengths) + sum(tensions)
    apart = kind.way != "drift"
    nuisance = [START * whole] if apart else []
    size = MULTIPLE * seen.size([seen.time[:, None] * whole], np.ones(1), nuisance)
    drift = float(rng.choice([-1.0, 1.0]) * _within(size, RATES, size))
    start = float(START * rng.standard_normal()) if apart else 0.0
    every = np.full(seen.robot.cables, start)
    record = {"cause": DRIFT, "multiple": MULTIPLE, "size": abs(drift), "unit": "1", "shape": kind.way}
    record |= {"total": [drift], "delay_at_start": start, "may_be_said": [DELAY] if apart else []}
    return Late(every, every, drift), [record]


def _within(largest: float, bounds: tuple[float, float], size: float) -> float:
    """The size, if the largest number is one that occurs."""
    if not bounds[0] <= largest <= bounds[1]:
        raise RejectedDrawError
    return size


def _second(name: str, seen: Seen, rng: np.random.Generator) -> tuple[np.ndarray, dict[str, Any]]:
    """Change of a field, of one cable or of all alike, and its record."""
    m = seen.robot.cables
    cable, none = int(rng.integers(m)), np.zeros((len(seen.time), m))
    own, pattern = (np.arange(m) == cable) * 1.0, rng.choice([-1.0, 1.0]) * np.ones(1)
    if name == "frame_anchor_position":
        columns = [seen.rows(none, -seen.along[..., axis] * own) for axis in range(3)]
        pattern = rng.standard_normal(3)
        pattern /= np.linalg.norm(pattern)
        change = np.kron(own, pattern)
    elif name == "unstrained_length_offset":
        columns, change = [seen.rows(none, own + none)], pattern * own
    else:
        columns, change = [seen.stretched()], pattern * np.ones(m)
    size = MULTIPLE * seen.size(columns, pattern, [])
    left = seen.sigmas(size * np.tensordot(pattern, np.array(columns), axes=1), _rivals(name, seen, own))
    if size > PLAUSIBLE[name] or left < SEPARABLE:
        raise RejectedDrawError
    record = {"cause": name, "multiple": MULTIPLE, "size": size, "unit": UNITS[name], "sigmas_left": left}
    return size * change, record | {"change": (size * change).tolist()}


def _rivals(name: str, seen: Seen, own: np.ndarray) -> list[np.ndarray]:
    """Rows of what else may be wrong with the same cables, of a plausible size: where it is as good, no name is owed.

    An offset needs no such test: another cause needs three numbers, which have to lie along the cable by chance.
    """
    if name == "unstrained_length_offset":
        return []
    none = np.zeros((len(seen.time), seen.robot.cables))
    lengths = seen.motion.at("lengths", seen.time)
    offset, scale = seen.rows(none, WIDE * own + none), seen.rows(none, WIDE / 5.0 * lengths * own)
    turned = Rotation.from_rotvec(seen.motion.at("turns", seen.time)).as_matrix()
    joints = np.einsum("fmx,fxk->fmk", seen.along, turned)
    anchors = [seen.rows(none, WIDE * joints[..., axis] * own) for axis in range(3)]
    if name == "axial_stiffness":
        every = np.eye(seen.robot.cables)
        return [seen.rows(none, WIDE * one + none) for one in every] + [seen.rows(none, WIDE / 5.0 * lengths)]
    return [offset, scale, *anchors]


def read(
    robot: EnteredRobot,
    real: Motion,
    late: Late,
    sigma: dict[str, float],
    with_tensions: bool,
    rng: np.random.Generator,
) -> pd.DataFrame:
    """A row for every cable at every frame: what is filed under one time was not read at one time.

    Poses are filed as of their own clock; lengths and tensions are those of a moment that the poses' delay is later.
    """
    frames, m = len(real.time) - 2 * MARGIN, robot.cables
    time = STEP * np.arange(frames)
    tensions, lengths = (
        np.stack([real.at(name, time + own[i] + late.drift * time)[:, i] for i in range(m)], axis=1)
        for name, own in (("tensions", late.tensions), ("lengths", late.lengths))
    )
    position = real.at("position", time) + sigma["position_m"] * rng.standard_normal((frames, 3))
    turned = Rotation.from_rotvec(real.at("turns", time)).as_matrix()
    angles = np.array([angles_deg(own) for own in turned]) + sigma["rotation_deg"] * rng.standard_normal((frames, 3))
    tensions = tensions + sigma["tension_N"] * rng.standard_normal(tensions.shape)
    lengths = lengths + sigma["length_m"] * rng.standard_normal(lengths.shape)
    rows = list(_rows(time, np.concatenate([position, angles], axis=1), tensions, lengths))
    table = pd.DataFrame(rows)
    return table if with_tensions else table.drop(columns="tension_N")


def _rows(time: np.ndarray, pose: np.ndarray, tensions: np.ndarray, lengths: np.ndarray) -> Iterator[dict[str, Any]]:
    for k, moment in enumerate(time.tolist()):
        for cable in range(tensions.shape[1]):
            row = {"case": f"f{k:03d}", "time_s": moment, **dict(zip(POSE, pose[k], strict=True)), "payload_kg": 0.0}
            yield row | {"cable": cable + 1, "tension_N": tensions[k, cable], "length_m": lengths[k, cable]}


def _truth(
    kind: MovingKind, robot: EnteredRobot, effects: list[dict[str, Any]], deviations: Deviations, more: dict[str, Any]
) -> dict[str, Any]:
    """What is sealed."""
    count = {0: "null", 1: "single", 2: "pair"}[len(effects)]
    way = f"{kind.way} + {kind.second}" if kind.second else kind.way
    return {
        "kind": count, "robot": robot.name, "noise": "white", "lengths": True, "tensions": kind.tensions, "way": way,
        "effects": effects, "read_with": more,
        "deviations": {name: value.tolist() for name, value in deviations.fields.items() if np.any(value)},
    }  # fmt: skip
