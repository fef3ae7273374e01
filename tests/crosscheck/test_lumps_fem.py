"""Masses on cables against the referee, whose nodes carry them."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.damping import Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import platform_port
from cdpr_struct.generated.platform import rotation
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.lump import Lump
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import ForwardSolution, forward
from cdpr_struct.statics.inverse_kinematics import inverse

COARSEST, ELEMENTS, MODES = 16, (16, 32, 64), 12
WEIGHTS = ((1, 4, 0.5), (1, 9, 1.0), (3, 8, 0.8))  # cable, node of the coarsest mesh from the platform, kg


def pose(robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    return robot.home.position + np.array([0.3, -0.2, 0.1]), rotation(0.03, -0.02, 0.05)


def given(name: str, factor: float = 1.0, **more: float) -> tuple[Robot, np.ndarray]:
    """The robot with masses on nodes of every mesh, and lengths that would hold the pose without them."""
    bare = load_robot(name)
    lengths = inverse(bare, *pose(bare), lower_bound=60.0).lengths.round(3)
    lumps = tuple(Lump(c, float(lengths[c - 1] * node / COARSEST), factor * mass) for c, node, mass in WEIGHTS)
    return replace(bare, lumps=lumps, extensions=Extensions.of(len(bare.cables), more)), lengths


def at_rest(robot: Robot, lengths: np.ndarray) -> ForwardSolution:
    found = forward(robot, lengths, *pose(robot))
    assert found.stable
    return found


def referee(robot: Robot, lengths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position [m] and frequencies [Hz] that ever finer meshes tend to."""
    data = to_fem(robot, lengths)
    meshes = [fem.solve_robot(data, *pose(robot), n) for n in ELEMENTS]
    position = fem.extrapolate(ELEMENTS, np.array([mesh.position for mesh in meshes])).limit
    hertz = np.array([fem.robot_modes(mesh, MODES).frequencies_hz for mesh in meshes])
    once = (4.0 * hertz[1:] - hertz[:-1]) / 3.0  # errors go with the second and the fourth power of the bars' length
    return position, (16.0 * once[1] - once[0]) / 15.0


def hertz_of(robot: Robot, rest: ForwardSolution) -> np.ndarray:
    found = certified_modes(OperatingPoint(robot, rest.position, rest.rotation, rest.cables), "exact", MODES)
    assert found.frequencies.certified
    return found.frequencies.hertz


CASES = {
    "cogiro": ("cogiro", {}),
    "thesis-3-1": ("thesis-3-1", {}),
    "masts": ("cogiro", {"frame_compliance": 1e-5}),
}


@pytest.mark.parametrize("name", CASES)
def test_rest_and_modes_are_the_referees(name):
    robot, lengths = given(CASES[name][0], **CASES[name][1])
    ours = at_rest(robot, lengths)
    position, hertz = referee(robot, lengths)
    assert np.abs(position - ours.position).max() < 1e-10  # m; measured: 8e-12
    np.testing.assert_allclose(hertz_of(robot, ours), hertz, rtol=1e-7)  # measured: 1e-8, 9e-11, 1e-9


def sliding(kind: str) -> tuple[Robot, np.ndarray]:
    """Robots whose cables slide at the frame, masses on nodes of what is then free."""
    robot, lengths = given("thesis-3-1", **({"series_compliance": 2e-5} if kind == "in line" else {}))
    first, second, *rest = robot.cables
    if kind == "pulleys":
        robot, lengths = replace(robot, pulleys=(Pulley(0.05, np.array([0.1, 0.0, 1.0])),) * 8), lengths + 0.05
    if kind == "winch":
        robot = replace(robot, cables=(first, replace(second, winch_tension=250.0), *rest))
    for _ in range(5):
        free = at_rest(robot, lengths).cables.length
        lumps = tuple(Lump(c, float(free[c - 1] * node / COARSEST), mass) for c, node, mass in WEIGHTS)
        robot = replace(robot, lumps=lumps)
    return robot, lengths


@pytest.mark.parametrize("kind", ["pulleys", "in line", "winch"])
def test_cables_that_slide_carry_them_alike(kind):
    robot, lengths = sliding(kind)
    ours = at_rest(robot, lengths)
    position, hertz = referee(robot, lengths)
    assert np.abs(position - ours.position).max() < 1e-8  # m; measured: 8e-10 with pulleys, else 3e-12
    np.testing.assert_allclose(hertz_of(robot, ours), hertz, rtol=3e-6)  # measured: 3e-7, 1e-7, 4e-9


def test_other_masses_are_seen():
    """The twin that must fail: 2 % more."""
    robot, lengths = given("cogiro")
    ours = at_rest(robot, lengths)
    position, hertz = referee(given("cogiro", 1.02)[0], lengths)
    assert np.abs(position - ours.position).max() > 1e-6
    assert np.abs(hertz_of(robot, ours) / hertz - 1.0).max() > 1e-3


def test_the_fem_by_its_name_agrees_over_the_interface():
    robot, lengths = given("thesis-3-1")
    exact, bars = (cs.modes(robot, lengths=lengths, model=m, count=6, elements=16) for m in ("exact", "fem"))
    ratio = np.asarray(bars.answer["frequencies_hz"]) / np.asarray(exact.answer["frequencies_hz"])
    assert 1e-6 < np.abs(ratio - 1.0).max() < 1e-2  # of 16 bars


def test_damped_responses_are_the_referees():
    """Viscous, 1 % of each cable's own first frequency, to which masses on it belong."""
    robot, lengths = given("thesis-3-1")
    ours = at_rest(robot, lengths)
    point, hertz = OperatingPoint(robot, ours.position, ours.rotation, ours.cables), np.array([1.1, 1.5, 2.5])
    cables = cable_dynamics(point, "exact", 60.0)
    ports, law = [platform_port("", axis, False, np.zeros(3)) for axis in np.eye(3)], Viscous(np.full(8, 0.01))
    columns = [
        frequency_response(point, cables, law, port, tuple(ports), hertz, "displacement").response for port in ports
    ]
    found = np.stack(columns, axis=-1)
    meshes = [fem.solve_robot(to_fem(robot, lengths), *pose(robot), n) for n in (32, 64)]
    coarse, fine = (fem.frequency_response(mesh, 2.0 * np.pi * hertz, 0.01)[:, :3, :3] for mesh in meshes)
    theirs = fine + (fine - coarse) / 3.0
    np.testing.assert_allclose(found, theirs, atol=2e-4 * np.abs(theirs).max())  # measured: 5e-5


def test_shapes_along_cables_are_the_referees():
    """Of the first four modes, those of the loaded cables; at stations between the masses and on them."""
    robot, lengths = given("thesis-3-1")
    exact, bars = (cs.modes(robot, lengths=lengths, model=m, count=4, elements=32).modes for m in ("exact", "fem"))
    stations = np.linspace(0.0, 1.0, 17)[1:]
    ours, theirs = (found.cable_motion(stations).reshape(4, -1) for found in (exact, bars))
    shared = np.einsum("ki,ki->k", ours, theirs) ** 2
    np.testing.assert_allclose(shared, (ours**2).sum(axis=1) * (theirs**2).sum(axis=1), rtol=1e-4)


def test_large_motion_of_the_referee_refuses_masses():
    robot, lengths = given("cogiro")
    still = fem.solve_robot(to_fem(robot, lengths), *pose(robot), 4)
    with pytest.raises(ValueError, match="knows no masses on cables"):
        fem.integrate(still, 0.02, 1e-3, linear=False)
