"""How large must an effect be to stand out of tolerances and noise? By the referee, for typical plans of a robot.

Readings r (in units of their noise) scatter with covariance S = 1 + J J^T, where J holds the change of r by one
sigma of each tolerance and of each length reading. A change d of the readings is then seen with
sqrt(d^T S^-1 d) sigmas. A pattern of one number is found with power 0.8 at a false-alarm rate of 0.001 if it stands
out by 4.1 of them; one of more numbers, all of which are to be found, by what a noncentral chi^2 of as many degrees of
freedom asks (4.6 for 3, 5.1 for 6, 6.3 for 24). The products d_i^T S^-1 d_k of all effects, averaged over plans of
which only those peaks are read that somebody picks, are kept in `reference_sizes.npz`, so that every drawn pattern has
its own size and its own distance from whatever else could explain it. `static_sizes.npz` holds the same of campaigns
without frequencies.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2, ncx2

from tests.blind.catalogue import BEYOND, EQUIVALENT, LIBRARY
from tests.blind.deviations import NUMBERS_PER_CABLE, NUMBERS_PER_ROBOT, Deviations, field_sizes, tolerance_columns
from tests.blind.entered_robot import PULLEY_SUFFIX, EnteredRobot, entered_robot, wheelless
from tests.blind.measuring_plan import Plan, drawn_plan
from tests.blind.observation import Observation, observed
from tests.blind.sensors import (
    CABLE_HZ,
    INCLINATION_READ,
    NOTHING_READ,
    PICKED,
    POSE_READ,
    ROBOT_HZ,
    SIGMA,
    pose_readings,
    settled_readings,
)
from tests.blind.vibrations import CABLE_MODES, VISIBLE_SHARE

TABLE = Path(__file__).with_name("reference_sizes.npz")
STATIC_TABLE = Path(__file__).with_name("static_sizes.npz")  # of campaigns without frequencies
FALSE_ALARMS, POWER = 1e-3, 0.8
PLAUSIBLE = 0.2  # of the largest size of the catalogue: one sigma of what a rival may be
ELEMENTS = 12
PLAN_SEEDS = (1, 2, 3, 4, 5)
STATIC_PLAN_SEEDS = PLAN_SEEDS[:2]  # statics depend less on the plan than the few states with frequencies
CELL_FIELDS = (
    "load_cell_gain",
    "load_cell_bias",
    "pulley_friction",
    "cell_quadratic",
    "cell_crosstalk",
    "cell_settling",
    "cell_tilt",
    "cell_fading",
)
SENSOR_FIELDS = ("tracker_frame", "tracker_lens", "tracker_shear", "tracker_heading", *CELL_FIELDS)
STEPS = {"temperature": 0.3, "external_force": 0.3, "hose_stiffness": 0.3, "internal_force": 0.3, "dead_length": 0.02}
STEPS |= {"platform_mass": 0.03, "joint_mass": 0.005, "joint_compliance": 3e-8, "frame_compliance": 3e-8}
STEPS |= {"axial_stiffness": 3e-3, "cable_linear_density": 3e-3, "platform_inertia": 5e-3, "wind_gradient": 0.1}
STEPS |= {"drum_scale": 5e-6, "cable_warming": 0.3, "construction_stretch": 5e-6, "tool_balancer": 0.3}
STEPS |= {"hook_offset": 1e-3, "gusts": 0.3, "floor_magnet": 0.3, "cubic_hose": 0.3}
FEW = ("two-cables", "three-cables", "four-cables", "five-cables", "thesis-3-1-inclined", "four-cables-inclined")
"""Robots with few cables, or whose position nobody reads: of sets without frequencies."""
UNREAD = ("thesis-3-1-unread", "cogiro-unread")
"""Robots of whose pose nobody reads anything, of sets without frequencies."""
STEP = 5e-5  # all others: m, rad, ratios


class Sensitivity:
    """Changes of the readings of one robot and plan, in sigmas of their noise, by any field; or of statics alone."""

    def __init__(self, robot: EnteredRobot, plan_seed: int, statics: bool = False) -> None:
        self.robot, self.exact, self.plan_seed = robot, Deviations.none(robot.cables), plan_seed
        self.statics = statics
        self.plan = self._planned(self.exact)
        self.seen = observed(robot, self.exact, self.plan, ELEMENTS)
        read = np.random.default_rng([plan_seed, 1]).random(self.seen.shares.shape) < PICKED
        self.peaks = read & (self.seen.shares > VISIBLE_SHARE)
        self.start = self._readings(self.plan, self.seen, self.exact)
        self._kept: dict[str, np.ndarray] = {}
        self._white: dict[str, np.ndarray] = {}

    def _planned(self, deviations: Deviations) -> Plan:
        plan = drawn_plan(self.robot, np.random.default_rng(self.plan_seed), deviations)
        return replace(plan, frequency_states=0) if self.statics else plan

    def _readings(self, plan: Plan, seen: Observation, deviations: Deviations) -> np.ndarray:
        pose, own = np.repeat([SIGMA["position_m"], SIGMA["rotation_deg"]], 3), self._of_pose
        parts = [(pose_readings(deviations, rest) / pose)[own] for rest in seen.statics]
        parts += [(pose_readings(deviations, rest) / pose)[own] for lock in seen.locks for rest in lock]
        parts += [shown / SIGMA["tension_N"] for shown in settled_readings(plan, seen, deviations)]
        parts += [np.log(seen.cable_hz).ravel() / CABLE_HZ]
        return np.concatenate([*parts, np.log(seen.robot_hz)[self.peaks] / ROBOT_HZ])

    @property
    def _of_pose(self) -> slice:
        """Which numbers of a pose are read."""
        if self.robot.tracked:
            return POSE_READ
        return INCLINATION_READ if self.robot.inclined else NOTHING_READ

    @property
    def _numbers(self) -> int:
        """How many numbers of a pose are read."""
        return len(range(6)[self._of_pose])

    def of(self, name: str) -> np.ndarray:
        """Derivatives (readings, size) by a field, per unit."""
        if name not in self._kept:
            step = STEPS.get(name, STEP)
            columns = [self._change(name, step * row) / step for row in np.eye(field_sizes(self.robot.cables)[name])]
            self._kept[name] = np.array(columns).T
        return self._kept[name]

    def _change(self, name: str, change: np.ndarray) -> np.ndarray:
        deviations = self.exact.plus(name, change)
        if name in SENSOR_FIELDS:
            return self._readings(self.plan, self.seen, deviations) - self.start
        plan = self._planned(deviations) if name == "internal_force" else self.plan
        seen = observed(self.robot, deviations, plan, ELEMENTS)
        return self._readings(plan, seen, deviations) - self.start

    def whitened(self, name: str) -> np.ndarray:
        """Derivatives (readings, size) by a field, white: their squares are squared sigmas.

        Where the controller's tensions are the question no lengths are filed, and only the cells can tell.
        """
        if name == "internal_force":
            return np.asarray(self._whitener(lengths=False)[0] @ self.of(name)[self._cells()])
        if "all" not in self._white:
            self._white["all"] = self._whitener(lengths=True)[1]
        return np.asarray(self._white["all"] @ self.of(name))

    def _whitener(self, lengths: bool) -> tuple[np.ndarray, np.ndarray]:
        """W with W^T W = S^-1, of the cells alone and of all readings."""
        null = [self.of(name) @ change for name, change in self._tolerances()]
        if lengths:
            null += [SIGMA["length_m"] * column for column in self._length_readings().T]
        spread = np.array(null).T
        scatter = np.eye(len(spread)) + spread @ spread.T
        cells = scatter[np.ix_(self._cells(), self._cells())]
        return np.linalg.inv(np.linalg.cholesky(cells)), np.linalg.inv(np.linalg.cholesky(scatter))

    def _cells(self) -> np.ndarray:
        """Which readings are tensions."""
        first = self._numbers * (len(self.plan.statics) + sum(len(lock) for lock in self.plan.locks))
        return np.arange(first, first + len(self.plan.statics) * self.robot.cables)

    def _tolerances(self) -> list[tuple[str, np.ndarray]]:
        columns = tolerance_columns(self.robot.cables)
        return [(n, c) for n, c in columns if n != "pulley_radius" or self.robot.pulley_radius is not None]

    def _length_readings(self) -> np.ndarray:
        """Changes (readings, lengths read) by every single length reading: one a cable a state, one a cable a lock."""
        by_cable, owners = self.of("unstrained_length_offset"), self._owners()
        return np.hstack([np.where((owners == state)[:, None], by_cable, 0.0) for state in np.unique(owners)])

    def _owners(self) -> np.ndarray:
        """Number of the state, or of the lock after them, that each reading belongs to."""
        states, measured = len(self.plan.statics), self.plan.frequency_states
        parts = [np.repeat(np.arange(states), self._numbers)]
        parts += [np.full(self._numbers * len(lock), states + number) for number, lock in enumerate(self.plan.locks)]
        parts += [np.repeat(np.arange(states), self.robot.cables)]
        parts += [np.repeat(np.arange(measured), self.robot.cables * CABLE_MODES)]
        return np.concatenate([*parts, np.nonzero(self.peaks)[0]])


def measured_table(name: str, plan_seed: int, statics: bool = False) -> tuple[list[str], np.ndarray, np.ndarray]:
    """Effect of each column, d^T S^-1 d of all columns (k, k), and that of the internal force by the cells (2, 2)."""
    sensitivity = Sensitivity(entered_robot(name), plan_seed, statics)
    without = "pulley_radius" if sensitivity.robot.pulley_radius is None else "frame_compliance"
    balanced = sensitivity.robot.hangs or not sensitivity.robot.tracked  # of sets without effects outside the library
    known = [*LIBRARY, *EQUIVALENT] if balanced else [*LIBRARY, *EQUIVALENT, *BEYOND]
    effects = [effect for effect in dict.fromkeys(known) if effect != without]
    alone = np.zeros((1, 2)) if balanced else sensitivity.whitened("internal_force")
    changes = [sensitivity.whitened(effect) for effect in effects if effect != "internal_force"]
    names = [effect for effect in effects if effect != "internal_force"]
    labels = [effect for effect, change in zip(names, changes, strict=True) for _ in range(change.shape[1])]
    together = np.hstack(changes)
    return labels, together.T @ together, alone.T @ alone


@cache
def _table(robot: str, statics: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of a robot; one whose pulleys the others lack is as sensitive as they are."""
    robot = robot if robot.endswith(PULLEY_SUFFIX) else wheelless(robot)
    with np.load(STATIC_TABLE if statics else TABLE) as kept:
        labels, gram, internal = (kept[f"{robot}/{part}"] for part in ("labels", "gram", "internal"))
    return labels, gram.astype(float), internal


@cache
def sigmas_to_find(unknowns: int) -> float:
    """By how many sigmas a pattern of so many unknown numbers has to stand out to be found."""
    limit = chi2.isf(FALSE_ALARMS, unknowns)
    found = brentq(lambda sigmas: ncx2.sf(limit, unknowns, sigmas**2) - POWER, 1.0, 20.0)
    return float(found)


def reference_size(
    robot: str, effect: str, pattern: np.ndarray, unknowns: int = 1, statics: bool = False
) -> float | None:
    """Size of a pattern of so many unknown numbers that can be found; None where the robot cannot have the effect.

    Outside the library only that part counts which the nearest cause of the library leaves.
    statics : by a campaign without frequencies
    """
    labels, gram, internal = _table(robot, statics)
    if effect == "internal_force":
        if not internal.any():
            return None
        return sigmas_to_find(unknowns) / float(np.sqrt(pattern @ internal @ pattern))
    own = labels == effect
    if not own.any():
        return None
    seen = (
        sigmas_left(robot, effect, pattern, statics)
        if effect in BEYOND
        else float(pattern @ gram[np.ix_(own, own)] @ pattern) ** 0.5
    )
    return sigmas_to_find(unknowns) / seen if seen > 0.0 else None


def typical_size(robot: str, effect: str) -> float | None:
    """Smallest detectable size of the usual pattern: all alike, or a random direction for vectors.

    None of robots that are in sets without frequencies only.
    """
    if robot in (*FEW, *UNREAD):
        return None
    labels, gram, internal = _table(robot)
    own = labels == effect
    own_gram = internal if effect == "internal_force" else gram[np.ix_(own, own)]
    if not own_gram.size:
        return None
    alike = NUMBERS_PER_CABLE.get(effect, NUMBERS_PER_ROBOT.get(effect)) == 1
    # anchors: rms a coordinate over all; other vectors: the length of a vector of any direction
    spread = float(
        own_gram.sum() if alike else np.trace(own_gram) / (1 if effect in NUMBERS_PER_CABLE else len(own_gram))
    )
    return sigmas_to_find(1) / float(np.sqrt(spread)) if spread > 0.0 else None


def sigmas_left(robot: str, effect: str, change: np.ndarray, statics: bool = False) -> float:
    """Sigmas of a change of a field that the nearest other cause of the library cannot imitate at a plausible size."""
    labels, gram, _ = _table(robot, statics)
    own = labels == effect
    if not own.any():
        return np.inf
    whole = float(change @ gram[np.ix_(own, own)] @ change)
    left = [whole]
    for rival in {**LIBRARY, **EQUIVALENT}.values():
        other = labels == rival.name
        if rival.name == effect or not other.any():
            continue
        basis = np.ones((other.sum(), 1)) if rival.shapes == ("common",) else np.eye(other.sum())
        seen = basis.T @ gram[np.ix_(other, own)] @ change
        cost = np.eye(len(seen)) * (PLAUSIBLE * rival.largest) ** -2
        left.append(whole - float(seen @ np.linalg.solve(basis.T @ gram[np.ix_(other, other)] @ basis + cost, seen)))
    return float(np.sqrt(max(min(left), 0.0)))


def write_table(names: list[str], workers: int = 1, statics: bool = False) -> None:
    """Measure the robots named, averaged over plans, and store them beside the others."""
    table: dict[str, np.ndarray] = {}
    file, seeds = (STATIC_TABLE, STATIC_PLAN_SEEDS) if statics else (TABLE, PLAN_SEEDS)
    seeds = seeds[:1] if all(name in (*FEW, *UNREAD) for name in names) else seeds
    if file.exists():
        with np.load(file) as kept:
            table = dict(kept.items())
    with ProcessPoolExecutor(workers) as pool:
        measured = list(pool.map(measured_table, *zip(*product(names, seeds, [statics]), strict=True)))
    for number, name in enumerate(names):
        plans = measured[number * len(seeds) : (number + 1) * len(seeds)]
        gram, internal = (np.mean([plan[part] for plan in plans], axis=0) for part in (1, 2))
        table |= {f"{name}/labels": np.array(plans[0][0]), f"{name}/gram": gram.astype(np.float32)}
        table[f"{name}/internal"] = internal
    np.savez_compressed(file, **table)
