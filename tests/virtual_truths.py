"""Campaigns whose true tensions are known and not read: finite-element robots off by draws from their tolerances."""

import importlib.util
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
from scipy.spatial.transform import Rotation

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.diagnosis.virtual_sensors import VirtualSensors, opened, virtual_sensors
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_from_arrays import robot_from_arrays
from cdpr_struct.robot.tolerances import tolerance_count, tolerated
from tests import moving_campaigns as moving

PRINTER = Path(__file__).parents[1] / "examples" / "hanging-printer"
ELEMENTS = 10


def made(folder: Path) -> ModuleType:
    """The script that makes an example's data."""
    spec = importlib.util.spec_from_file_location("make", folder / "make.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def drawn(entered: Robot, campaign: Campaign, noise: np.random.Generator) -> tuple[Robot, np.ndarray]:
    """A robot off by a draw from the campaign's tolerances, and errors (m,) of its lengths [m]."""
    arrays = RobotArrays.of(entered)
    numbers = noise.normal(size=tolerance_count(arrays.cable_count))
    there = tolerated(arrays, campaign.tolerances, numbers)
    offset = np.asarray(there.length_offset)
    return robot_from_arrays(entered, replace(there, length_offset=arrays.length_offset), ()), offset


def filmed(seed: int, frames: int) -> tuple[Campaign, np.ndarray]:
    """A suspended robot that is filmed along a curve, and its true tensions (S, 4) [N]; the lengths are read.

    At every frame the finite elements carry the inertia of the platform on its curve.
    """
    noise, entered = np.random.default_rng([seed, 5]), moving.robot()
    pattern = moving.filmed(seed, frames)  # columns and sigmas; every reading is replaced
    real, offset = drawn(entered, pattern, noise)
    time = moving.STEP * np.arange(frames)
    paid, body = moving.paid_out(time), real.platform
    rests = [
        fem.solve_robot(
            to_fem(real, own + offset), place, np.eye(3), ELEMENTS,
            external_force=fem.PointForce(-body.mass * rate, body.center_of_mass),
        )
        for own, place, rate in zip(paid, moving.path(time), accelerations(time), strict=True)
    ]  # fmt: skip
    position = np.array([rest.position for rest in rests]) + noise.normal(0.0, moving.POSITION, (frames, 3))
    turned = Rotation.from_rotvec(noise.normal(0.0, moving.ROTATION, (frames, 3)))
    turned = turned * Rotation.from_matrix(np.array([rest.rotation for rest in rests]))
    length = paid + noise.normal(0.0, moving.LENGTH, paid.shape)
    states = replace(pattern.states, position=position, angles=turned.as_euler("xyz"), length=length)
    return replace(pattern, states=states), np.array([[np.linalg.norm(c.end_force) for c in r.cables] for r in rests])


def accelerations(time: np.ndarray) -> np.ndarray:
    """(F, 3) of the path [m/s^2], by differences."""
    step = 1e-3
    return np.asarray((moving.path(time + step) - 2.0 * moving.path(time) + moving.path(time - step)) / step**2)


def printed(seed: int, pull: float = 40.0, gauged: Sequence[int] = ()) -> tuple[Campaign, np.ndarray]:
    """The hanging printer under a ceiling that does not bend, and its true tensions (S, 9) [N]; no angles but at home.

    Every line has a counter of its own, as a campaign takes it.

    pull : of the lower lines at home [N];  gauged : numbers from 0 of lines whose tensions are read, to 1 N
    """
    make = made(PRINTER)
    make.PULL = pull
    counter, make.COUNTER = make.COUNTER, 0.0
    make.E_I *= 1e6
    noise, held = np.random.default_rng([seed, 6]), []
    rest_of = make.at_rest

    def watched(*given: object) -> fem.RobotEquilibrium:
        held.append(rest_of(*given))
        return held[-1]

    make.at_rest = watched
    tables = make.tables(noise)
    states = len(tables["home.csv"]) + len(tables["points.csv"])
    rests = held[3 : 3 + states]  # after those that bring the nozzle to the bed
    stored = load_campaign(PRINTER / "campaign.toml")
    read = {name: tables[name].drop(columns="case").to_numpy(dtype=float) for name in ("home.csv", "points.csv")}
    rows = np.concatenate([read["home.csv"], read["points.csv"]])
    true = np.array([[np.linalg.norm(c.end_force) for c in r.cables] for r in rests])
    tension, sigma = np.full(true.shape, np.nan), np.full(true.shape, np.nan)
    chosen = list(gauged)
    tension[:, chosen] = np.maximum(true + noise.normal(0.0, make.GAUGE, true.shape), 0.1)[:, chosen]
    sigma[:, chosen] = make.GAUGE
    own = replace(
        stored.states, position=rows[:, :3], angles=np.radians(rows[:, 3:6]),
        length=rows[:, 7:] + noise.normal(0.0, counter, (states, 9)), tension=tension, tension_sigma=sigma,
    )  # fmt: skip
    return replace(stored, states=own), true


def predicted(campaign: Campaign) -> VirtualSensors:
    """By the fit of tolerances alone: nothing else is wrong with these robots."""
    data = opened(recorded(campaign))
    found = judged(data, layout(data), Hypothesis())
    return virtual_sensors(found, data, np.ones(data.states, dtype=bool), np.zeros(data.cables))


def inside(seen: VirtualSensors, tension: np.ndarray, quantile: float) -> np.ndarray:
    """(S, m) whether true tensions lie within so many sigmas."""
    m = seen.cables
    return np.asarray(np.abs(tension - seen.value[:, 6 : 6 + m]) < quantile * seen.sigma[:, 6 : 6 + m])
