"""One campaign from a seed: robot, tolerances, hidden effect and its size, plan, readings, and the truth about it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cdpr_struct.fem_reference import FemError
from tests.blind.beside_checks import CHECKED, BesideCheck
from tests.blind.catalogue import (
    BEYOND,
    EQUIVALENT,
    LAWS,
    LIBRARY,
    ONE_SIDED,
    STATICS_ONLY,
    Effect,
    drawn_pattern,
    unknowns,
)
from tests.blind.detectability import reference_size, sigmas_left
from tests.blind.deviations import Deviations, drawn_tolerances
from tests.blind.entered_robot import EnteredRobot, entered_robot
from tests.blind.measuring_plan import Plan, PlanSize, drawn_plan
from tests.blind.note_errors import mistaken
from tests.blind.observation import Observation, SlackStateError, observed
from tests.blind.sensors import SIGMA, Noise, Tables, filed, timed
from tests.blind.true_robot import bare_inertia

ROBOTS = ("thesis-3-1", "cogiro", "thesis-5", "thesis-5-pulleys")
SHARES = (0.35, 0.25, 0.25, 0.15)
SUSPENDED = ROBOTS[:2]
SMALLEST_MULTIPLE_KEPT = 0.8  # of the multiple asked for, where the plausible size ends earlier
ATTEMPTS = 60


@dataclass(frozen=True)
class CaseKind:
    """What a case is to hold.

    kind     : null, single, pair, ambiguous, outside, handling, or law: a single one of `LAWS`
    effects  : (name, multiple of the smallest detectable size) of each hidden effect
    noise    : white, coloured or outlier
    lengths  : whether lengths are filed
    separated : an ambiguous case with the measurements that tell its names apart, where there are any
    statics  : without frequencies; sizes are then multiples of what statics alone can detect
    signals  : the same, but for records of vibration that are made of the modes
    robot    : which one; any of `ROBOTS` if not given
    timed    : whether the time of every state is filed
    alone    : effects act on one entry, with their multiple itself as size, never mind what can be detected
    """

    kind: str
    effects: tuple[tuple[str, float], ...] = ()
    noise: str = "white"
    lengths: bool = True
    separated: bool = False
    statics: bool = False
    size: PlanSize = field(default_factory=PlanSize)
    robot: str = ""
    timed: bool = False
    signals: bool = False
    alone: bool = False


@dataclass(frozen=True, eq=False)
class Case:
    """A drawn case: what is handed out and what is sealed (truth).

    weighed : the platform's mass [kg];  check : what else was measured beside the robot;  sigma : of the sensors
    """

    robot: EnteredRobot
    tables: Tables
    truth: dict[str, Any]
    weighed: float | None = None
    check: BesideCheck | None = None
    sigma: Mapping[str, float] = field(default_factory=lambda: SIGMA)


class RejectedDrawError(Exception):
    """This draw is slack, out of range or cannot have the effect: the next one is tried."""


def drawn_case(kind: CaseKind, seed: tuple[int, ...]) -> Case:
    """The case of a seed; the same seed gives the same case bit by bit."""
    for attempt in range(ATTEMPTS):
        try:
            return _attempt(kind, seed, attempt)
        except (RejectedDrawError, SlackStateError, FemError):
            continue
    raise RuntimeError(f"no campaign for {kind} with seed {seed} in {ATTEMPTS} attempts")


def _attempt(kind: CaseKind, seed: tuple[int, ...], attempt: int) -> Case:
    streams = np.random.SeedSequence([*seed, attempt]).spawn(6)
    hidden, sensor, beside = (np.random.default_rng(streams[number]) for number in (2, 4, 5))
    real = drawn_reality(kind, streams, hidden)
    robot, deviations, effects, names = real.robot, real.deviations, real.effects, [name for name, _ in kind.effects]
    lengths = kind.lengths and "internal_force" not in names
    tables = filed(real.plan, real.seen, deviations, Noise(sensor, kind.noise), lengths)
    tables = timed(tables, real.plan) if kind.timed else tables
    confused, weighed = _is_confused(kind), None
    if kind.kind == "ambiguous" and names[0] in STATICS_ONLY:
        del tables["robot_frequency"]
        weighed = None if confused else round(float(robot.mass + deviations["platform_mass"][0]), 2)
    if kind.kind == "handling":
        effects = [mistaken(names[0], tables, hidden)]
    truth = truth_record(kind, robot, effects, deviations) | ({} if weighed is None else {"weighed_kg": weighed})
    check = None
    if kind.separated and names[0] in CHECKED:
        check = CHECKED[names[0]](robot, deviations, beside)
        truth |= {"measured": list(check.measured)}
    return Case(robot, tables, truth, weighed, check)


@dataclass(frozen=True, eq=False)
class Reality:
    """What is there before anybody reads a sensor; effects are the records of what is hidden."""

    robot: EnteredRobot
    deviations: Deviations
    effects: list[dict[str, Any]]
    plan: Plan
    seen: Observation


def drawn_reality(kind: CaseKind, streams: Sequence[np.random.SeedSequence], hidden: np.random.Generator) -> Reality:
    """Robot, tolerances, effects and what the referee sees of them; the first, second and fourth stream are used."""
    choice, workshop, route = (np.random.default_rng(streams[number]) for number in (0, 1, 3))
    robot = entered_robot(kind.robot or str(choice.choice(ROBOTS, p=SHARES)))
    deviations = drawn_tolerances(robot.cables, workshop)
    if robot.pulley_radius is None:
        deviations = deviations.plus("pulley_radius", -deviations["pulley_radius"])
    effects: list[dict[str, Any]] = []
    if kind.kind != "handling":
        deviations, effects = _hidden(kind, robot, deviations, hidden)
    one_sided = _is_confused(kind) and kind.effects[0][0] in ONE_SIDED
    plan = drawn_plan(robot, route, deviations, kind.size, one_sided)
    if kind.statics and not kind.signals:
        plan = replace(plan, frequency_states=0)
    return Reality(robot, deviations, effects, plan, observed(robot, deviations, plan))


def _is_confused(kind: CaseKind) -> bool:
    """Whether nothing in the case tells the names of an ambiguous effect apart."""
    return kind.kind == "ambiguous" and not kind.separated


def _hidden(
    kind: CaseKind, robot: EnteredRobot, tolerances: Deviations, rng: np.random.Generator
) -> tuple[Deviations, list[dict[str, Any]]]:
    """The tolerances with the effects on top, and a record of each effect."""
    effects = []
    catalogue = {**EQUIVALENT, **BEYOND, **LIBRARY} | (EQUIVALENT if kind.kind == "ambiguous" else {})
    deviations = tolerances
    for name, multiple in kind.effects:
        effect = LAWS[name] if kind.kind == "law" else catalogue[name]
        effect = replace(effect, shapes=("one",), signed=False, typical=1.0) if kind.alone else effect
        seen_as = "load_cell_gain" if kind.kind == "ambiguous" and name in ONE_SIDED else name
        shape, pattern, size, reached = sized(effect, robot.name, multiple, rng, seen_as, kind.statics)
        deviations = deviations.plus(name, size * pattern)
        record = {"cause": name, "multiple": reached, "size": size, "unit": effect.unit, "shape": shape}
        if not effect.typical:
            record["sigmas_left"] = sigmas_left(robot.name, name, size * pattern, kind.statics)
        effects.append(record | {"change": (size * pattern).tolist(), "rivals": list(effect.rivals)})
    for record in effects:
        record["total"] = deviations[str(record["cause"])].tolist()
    _refuse_impossible(robot, deviations)
    return deviations, effects


def sized(
    effect: Effect, robot: str, multiple: float, rng: np.random.Generator, seen_as: str, statics: bool
) -> tuple[str, np.ndarray, float, float]:
    """Shape, pattern, size and the multiple of the reference size that it reaches.

    seen_as : effect whose reference size counts; approached from one side only, friction is a gain
    statics : of what can be detected without frequencies
    """
    if effect.name == "internal_force" and robot not in SUSPENDED:
        raise RejectedDrawError
    shape, pattern = drawn_pattern(effect, entered_robot(robot).cables, rng)
    reference = effect.typical or reference_size(robot, seen_as, pattern, unknowns(shape, pattern), statics)
    if reference is None:
        raise RejectedDrawError
    size = min(multiple * reference, effect.largest)
    if size < SMALLEST_MULTIPLE_KEPT * multiple * reference:
        raise RejectedDrawError
    return shape, pattern, size, size / reference


def _refuse_impossible(robot: EnteredRobot, deviations: Deviations) -> None:
    """No negative masses or radii, no moments of inertia that no body has."""
    radius = robot.pulley_radius
    if radius is not None and radius + deviations["pulley_radius"].min() < 0.01:
        raise RejectedDrawError
    if robot.mass + deviations["platform_mass"][0] < 0.5 * robot.mass:
        raise RejectedDrawError
    moments = np.linalg.eigvalsh(bare_inertia(robot, deviations))
    if moments[2] > moments[0] + moments[1]:
        raise RejectedDrawError


def truth_record(
    kind: CaseKind, robot: EnteredRobot, effects: list[dict[str, Any]], deviations: Deviations
) -> dict[str, Any]:
    return {
        "kind": kind.kind,
        "robot": robot.name,
        "noise": kind.noise,
        "lengths": kind.lengths,
        "effects": effects,
        "deviations": {name: value.tolist() for name, value in deviations.fields.items() if np.any(value)},
    }


def can_be_separated(kind: CaseKind) -> bool:
    """Whether more measurements of the same robot would tell the names of an ambiguous case apart."""
    return kind.kind == "ambiguous" and kind.effects[0][0] in (*ONE_SIDED, *STATICS_ONLY, *CHECKED)


def without_effect(kind: CaseKind) -> CaseKind:
    """The same case with effects of size zero."""
    return replace(kind, effects=tuple((name, 0.0) for name, _ in kind.effects))
