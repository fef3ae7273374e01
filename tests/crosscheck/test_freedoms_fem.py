"""Neutral, guided and weightless robots before the referee, which has a constraint and a gravity of its own."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs
import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.natural_frequencies import count_below
from cdpr_struct.dynamics.ports import platform_port
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot_file import load_robot

ROBOTS = Path(__file__).parents[2] / "examples" / "robots"
MESHES = (16, 32, 64)
COUNT = 10
PORTS = (("x", 0, False), ("z", 2, False), ("ry", 1, True))
TILTED = np.array([1.5, -2.0, -9.2])


def example(name):
    return load_robot(ROBOTS / name / "robot.toml")


def off_the_plane():
    """The planar robot tilted, its centre of mass before the plane: the guide has something to do."""
    robot = example("planar-four-cables")
    body = replace(robot.platform, center_of_mass=np.array([0.02, 0.05, 0.01]))
    where = Pose.from_degrees(np.array([0.2, 0.1, 0.15, 2.0, 6.0, 0.0]))
    return replace(robot, platform=body, gravity=TILTED, home=where)


CASES = {
    "one rope": lambda: example("load-on-one-rope"),
    "point camera": lambda: example("point-camera"),
    "planar": lambda: example("planar-four-cables"),
    "planar, tilted": off_the_plane,
    "weightless": lambda: example("zero-gravity"),
    "tilted": lambda: replace(load_robot("cogiro"), gravity=TILTED),
}


@pytest.mark.parametrize("case", CASES)
def test_rest_and_modes_are_those_of_the_referee(case):
    """Extrapolated from 16, 32 and 64 elements; measured below 1e-6, positions below 1e-11 m."""
    robot = CASES[case]()
    found = cs.modes(robot, count=COUNT)
    meshes = [solve_in_fem(found.point, n) for n in MESHES]
    neutral = int((found.modes.hertz == 0.0).sum())
    assert [fem.neutral_freedoms(mesh) for mesh in meshes] == [neutral] * len(MESHES)
    assert neutral == (1 if case in ("one rope", "point camera") else 0)
    theirs = fem.extrapolate(
        MESHES, np.array([fem.robot_modes(m, COUNT).frequencies_hz[neutral:] for m in meshes])
    ).limit
    assert found.modes.hertz[neutral:] == pytest.approx(theirs, rel=1e-5)
    assert found.modes.count_certified
    place = fem.extrapolate(MESHES, np.array([mesh.position for mesh in meshes])).limit
    assert place == pytest.approx(found.point.position, abs=1e-7)
    if robot.guided:
        held = [i for i, name in enumerate(("x", "y", "z", "rx", "ry", "rz")) if name in robot.guided]
        reaction = found.answer["guide"]["reaction_wrench"]
        assert reaction[held] == pytest.approx(-meshes[-1].residual_wrench[held], abs=1e-3)
        assert meshes[-1].rotation == pytest.approx(found.point.rotation, abs=1e-4)


def test_wrong_stiffness_is_seen():
    """EA two percent off, and another guide: the same comparison fails."""
    robot = example("planar-four-cables")
    hertz = cs.modes(robot, count=3).modes.hertz
    softer = replace(robot, cables=tuple(replace(c, axial_stiffness=0.98 * c.axial_stiffness) for c in robot.cables))
    freer = replace(robot, guided=("rx", "rz"))
    for other in (softer, freer):
        theirs = fem.robot_modes(solve_in_fem(cs.modes(other, count=1).point, 32), 3).frequencies_hz
        assert np.abs(theirs / hertz - 1.0).max() > 5e-3


@pytest.mark.parametrize("case", ["point camera", "planar, tilted", "weightless"])
def test_counts_agree(case):
    """Up to four half waves, which 60 elements have to 0.2 %."""
    point = cs.modes(CASES[case](), count=1).point
    top = 4.0 * float(cable_dynamics(point, "exact").first_frequency.min())
    cables, mesh = cable_dynamics(point, "exact", top), solve_in_fem(point, 60)
    for omega in np.random.default_rng(5).uniform(0.1, 1.0, 12) * top:
        ours = count_below(point, cables, omega * np.array([0.997, 1.003]))
        assert ours[0] <= fem.count_below(mesh, omega) <= ours[1]


def test_a_guided_platform_answers_as_in_the_referee():
    point = cs.modes(off_the_plane(), count=1).point
    hertz = np.array([3.0, 11.0, 17.0])
    cables = cable_dynamics(point, "exact", 2.0 * np.pi * 17.0)
    ports = [platform_port(name, np.eye(3)[i], turns, np.zeros(3)) for name, i, turns in PORTS]
    law = Viscous(np.full(4, 0.01))
    own = frequency_response(point, cables, law, ports[1], tuple(ports), hertz, "displacement").response
    theirs = [
        fem.frequency_response(solve_in_fem(point, n), 2.0 * np.pi * hertz, 0.01)[:, [0, 2, 4], 2] for n in MESHES
    ]
    limit = theirs[-1] + (theirs[-1] - theirs[-2]) / 3.0  # order two
    assert own == pytest.approx(limit, rel=2e-4, abs=1e-4 * np.abs(limit).max())


@pytest.mark.parametrize("case", ["point camera", "planar, tilted", "weightless"])
def test_verify_holds(case):
    found = cs.verify(CASES[case](), modes=6, elements=[8, 16, 32])
    assert found.holds, found.trial.objections()
    assert found.trial.neutral == found.trial.fem_neutral == (1 if case == "point camera" else 0)
    assert (found.trial.fem_limit_hertz > 0.1).all()


def test_the_referee_refuses_what_it_cannot_integrate_and_what_is_no_guide():
    point = cs.modes(example("planar-four-cables"), count=1).point
    with pytest.raises(ValueError, match="guided platform"):
        fem.integrate(solve_in_fem(point, 8), 0.1, 0.01)
    robot = solve_in_fem(point, 8).robot
    with pytest.raises(ValueError, match="guided must be"):
        replace(robot, guided=(0, 7))
