"""The robot as arrays: one table of parameters, point masses, and the same vibrations as the robot as entered."""

from dataclasses import fields, replace

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import CABLE_MODELS, cable_dynamics, expand_catenaries_at
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.parameters import CABLES, EXTENSIONS, LUMPS, PARAMETERS
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

ROBOT = load_robot("thesis-3-1")
LEVEL = np.eye(3)
BY_ANCHORS = ("masts", "uprights")  # follow from the frame anchors
PLACE = ROBOT.home.position + np.array([0.4, -0.2, 0.1])


def test_the_table_has_one_row_a_field():
    assert {f.name for f in fields(RobotArrays)} == set(PARAMETERS)
    assert {f.name for f in fields(Extensions)} - {"causes"} == set(EXTENSIONS)


@pytest.mark.parametrize("name", PARAMETERS)
def test_arrays_have_the_shape_of_the_table_and_obey_its_bounds(name):
    rule, value = PARAMETERS[name], getattr(RobotArrays.of(ROBOT), name)
    assert value.shape == tuple({CABLES: 8, LUMPS: 1}.get(n, n) for n in rule.shape)
    assert ((value >= rule.least) & (value > rule.above) & (value <= rule.most)).all()
    assert (rule.place == "extensions") == (name in EXTENSIONS)


NEUTRAL = [n for n, rule in PARAMETERS.items() if rule.neutral is not None and n not in BY_ANCHORS]


@pytest.mark.parametrize("name", NEUTRAL)
def test_what_is_not_given_is_neutral(name):
    whole = RobotArrays.of(ROBOT)
    needed = {n: getattr(whole, n) for n, rule in PARAMETERS.items() if rule.neutral is None or n == "pulley_radius"}
    bare = RobotArrays(**needed, center_of_mass=whole.center_of_mass)
    if name not in ("pulley_radius", "center_of_mass"):
        np.testing.assert_array_equal(getattr(bare, name), np.full_like(getattr(bare, name), PARAMETERS[name].neutral))
    assert bare.batch_shape == ()


def test_a_batch_of_point_masses_is_a_batch_of_platforms():
    rng = np.random.default_rng(3)
    masses, places = rng.uniform(0.0, 2.0, (4, 3)), rng.uniform(-0.5, 0.5, (4, 3, 3))
    found = RobotArrays.of(ROBOT).with_point_masses(masses, places)
    for i in range(4):
        body: Platform = ROBOT.platform.with_masses_at(masses[i], places[i])
        np.testing.assert_allclose(found.mass[i], body.mass, rtol=1e-14)
        np.testing.assert_allclose(found.center_of_mass[i], body.center_of_mass, atol=1e-15)
        np.testing.assert_allclose(found.inertia[i], body.inertia, rtol=1e-12, atol=1e-12)


def test_a_point_mass_has_the_kinetic_energy_of_a_point():
    """Of the joined body, turning about any axis through its origin, less that of the body alone."""
    place, omega = np.array([0.3, -0.2, 0.5]), np.array([0.4, 1.0, -0.7])
    alone = RobotArrays.of(ROBOT)
    joined = alone.with_point_masses(np.array([1.7]), place)

    def energy(body: RobotArrays) -> float:
        speed = np.cross(omega, body.center_of_mass)
        return 0.5 * body.mass * speed @ speed + 0.5 * omega @ body.inertia @ omega

    speed = np.cross(omega, place)
    assert energy(joined) - energy(alone) == pytest.approx(0.5 * 1.7 * speed @ speed, rel=1e-12)


def extended(masts: float) -> RobotArrays:
    """With everything at work that vibration knows; the masts alike."""
    each = np.linspace(0.5, 1.5, 8)
    given = {
        "series_compliance": 2e-6 * each, "frame_compliance": masts * np.repeat([0.0, 1.0, 2.0, 3.0], 2),
        "mast_bending": 2.0 * masts,
        "hose": 200.0, "tilt": [0.002, -0.001], "bending_stiffness": 20.0 * each, "added_mass": 0.02 * each,
    }  # fmt: skip
    more = Extensions.of(8, given)
    return replace(RobotArrays.of(ROBOT), **{n: np.asarray(getattr(more, n)) for n in EXTENSIONS})


@pytest.mark.parametrize("model", CABLE_MODELS)
def test_a_batch_of_robots_vibrates_as_each_of_them_does(model):
    """Batch axes on mass, inertia, density, masts and all extensions; one robot of the batch has rigid masts."""
    robots = [extended(masts) for masts in (0.0, 3e-6)]
    robots[1] = replace(
        robots[1].with_point_masses([2.0], np.array([[0.1, 0.2, 0.3]])),
        linear_density=1.1 * robots[1].linear_density, hose=np.array(900.0), gravity=np.array(9.7),
    )  # fmt: skip
    cables = inverse(ROBOT, PLACE, LEVEL).cables
    singles = [ritz(OperatingPoint(robot, PLACE, LEVEL, cables), model) for robot in robots]
    both = RobotArrays(
        **{n: np.stack([getattr(r, n) for r in robots]) for n in PARAMETERS if n not in BY_ANCHORS},
        **{n: getattr(robots[0], n) for n in BY_ANCHORS},
    )
    twice = type(cables)(*(np.stack([getattr(cables, n)] * 2) for n in cables.__slots__))
    together = ritz(OperatingPoint(both, np.stack([PLACE] * 2), np.stack([LEVEL] * 2), twice), model)
    for own, alone in zip(together, singles, strict=True):
        np.testing.assert_allclose(own, alone, rtol=1e-8)  # the closed form's series ends after its softest cable
    assert abs(singles[0] / singles[1] - 1.0).max() > 1e-3


def ritz(point: OperatingPoint, model: str) -> np.ndarray:
    """First frequencies [rad/s], from series that end at the same term whatever else is in the batch."""
    if model == "exact":
        return ritz_modes(point, expand_catenaries_at(point, 16), 6).omega
    return ritz_modes(point, cable_dynamics(point, model).expansion(120.0), 6).omega
