"""Searches that are given too few rounds say so: an error, or a mark that keeps the pose from counting."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct import fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics import clamped_cable
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import ConvergenceError
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot import Robot, anchors_in_world
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics import (
    cable_distance,
    hanging_cables,
    inverse_kinematics,
    stiffening,
    tension_bound,
    tensioned_cables,
)
from cdpr_struct.statics.cable_curves import CableCurves
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.forward_kinematics import ForwardStatus, forward
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.inverse_kinematics import InverseStatus, inverse
from cdpr_struct.statics.lost_cables import lost as lost_cables
from cdpr_struct.statics.tensioned_cables import tensioned
from cdpr_struct.workspace.rest_columns import rest_columns

PLACE, LEVEL = np.array([0.5, -1.0, 0.8]), np.eye(3)
NO_BOUNDS = np.zeros((1, 8)), np.full((1, 8), np.inf)


def robot_with(pulleys: bool = False, winch: float = 0.0, **extensions: float) -> Robot:
    robot = load_robot("thesis-3-1")
    first, *others = robot.cables
    robot = replace(robot, cables=(replace(first, winch_tension=winch), *others))
    robot = replace(robot, extensions=Extensions.of(8, extensions)) if extensions else robot
    return replace(robot, pulleys=(Pulley(0.3),) * 8) if pulleys else robot


@pytest.mark.parametrize(
    ("robot", "search", "rounds"),
    [
        (robot_with(winch=247.0), inverse_kinematics, "_MOST_WINCH_STEPS"),
        (robot_with(nonlinearity=20.0), stiffening, "MOST_ROUNDS"),
    ],
    ids=["winches", "stiffening"],
)
def test_inverse_does_not_count_what_was_cut_short(robot, search, rounds, monkeypatch):
    assert inverse(robot, PLACE, LEVEL).held
    monkeypatch.setattr(search, rounds, 1)
    found = inverse(robot, PLACE, LEVEL, allow_unheld=True)
    assert found.status == InverseStatus.NOT_CONVERGED
    assert rest_columns(found)["cut_short"]
    with pytest.raises(ConvergenceError, match="inverse kinematics"):
        inverse(robot, PLACE, LEVEL)


def test_exits_from_pulleys_that_were_not_found_are_marked_and_their_poses_do_not_count(monkeypatch):
    robot = robot_with(True)
    found = inverse(robot, PLACE[None], LEVEL[None])
    problem = HoldingProblem.at(
        RobotArrays.of(robot), cable_model("sagging"), (PLACE[None], LEVEL[None]), np.zeros((1, 6)), NO_BOUNDS
    )
    points, model = anchors_in_world(robot, PLACE[None], LEVEL[None])[0], cable_model("sagging")
    for rounds, lost in ((30, False), (1, True)):
        monkeypatch.setattr(hanging_cables, "_EXIT_ITERATIONS", rounds)
        monkeypatch.setattr(hanging_cables, "_EXIT_REPEATED", rounds)
        states = model.hold(problem.arrays, points, found.cables.tension).states
        assert lost_cables(states).all() == lost
        assert lost_cables(model.states(problem.arrays, points, found.lengths)).any() == lost
        judged = inverse_kinematics._judged(problem, states, np.array([True]), np.array([1]))
        assert judged.held.all() == (not lost)


def test_forward_does_not_count_a_stiffness_that_was_not_found(monkeypatch):
    robot = robot_with(nonlinearity=20.0)
    lengths = inverse(robot, PLACE, LEVEL).lengths
    assert forward(robot, lengths, PLACE, LEVEL).converged
    monkeypatch.setattr(stiffening, "MOST_ROUNDS", 1)
    assert forward(robot, lengths, PLACE, LEVEL).status == ForwardStatus.NOT_CONVERGED


def test_exits_from_pulleys_at_given_tensions(monkeypatch):
    arrays = RobotArrays.of(robot_with(True))
    points = anchors_in_world(load_robot("thesis-3-1"), PLACE, LEVEL)[0]
    given = cable_model("sagging"), arrays, points, np.full(8, 200.0)
    tensioned(*given)
    monkeypatch.setattr(tensioned_cables, "_EXIT_ITERATIONS", 1)
    with pytest.raises(ConvergenceError, match="exits from the pulleys"):
        tensioned(*given)


def test_a_bound_of_force_that_is_not_found(monkeypatch):
    robot = robot_with()
    pose = PLACE[None], LEVEL[None]
    problem = HoldingProblem.at(RobotArrays.of(robot), cable_model("sagging"), pose, np.zeros((1, 6)), NO_BOUNDS)
    tension_bound.chord_tension_at(problem, tension_bound.constant(100.0))
    monkeypatch.setattr(tension_bound, "MAX_ITERATIONS", 1)
    with pytest.raises(ConvergenceError, match="bound of the cable forces"):
        tension_bound.chord_tension_at(problem, tension_bound.constant(100.0))


def test_weightless_cables_fall_to_no_tension_where_none_is_asked_for():
    arrays = replace(RobotArrays.of(robot_with()), gravity=np.zeros(()))
    problem = HoldingProblem.at(arrays, cable_model("sagging"), (PLACE[None], LEVEL[None]), np.zeros((1, 6)), NO_BOUNDS)
    tau, pull = tension_bound.chord_tension_at(problem, tension_bound.constant(0.0))
    assert max(tau.max(), pull.max()) < 1e-9


def test_roots_of_irvines_equation(monkeypatch):
    monkeypatch.setattr(clamped_cable, "_ROOT_STEPS", 2)
    with pytest.raises(ConvergenceError, match="Irvine"):
        clamped_cable.symmetric_roots(np.array([10.0]), 3)


def hung(poses: int) -> tuple[CableCurves, int]:
    robot = load_robot("cogiro")
    place = np.linspace((0.0, 0.0, 1.0), (1.0, 1.0, 1.5), poses)
    turned = np.broadcast_to(LEVEL, (poses, 3, 3))
    found = inverse(robot, place, turned)
    return CableCurves.of(found.cables, anchors_in_world(robot, place, turned)[0]), 8


def test_distances_of_many_poses_are_found_in_parts_and_of_one_refused(monkeypatch):
    """Before, the bound that was reached when pieces became too many was given as the distance."""
    curves = hung(6)
    whole = cable_distance.cable_distance(*curves, 0.1)
    pieces = []
    monkeypatch.setattr(cable_distance, "_MOST_PIECES", 5)
    real = cable_distance._narrowed
    monkeypatch.setattr(cable_distance, "_narrowed", lambda *given: pieces.append(given[0]) or real(*given))
    parts = cable_distance.cable_distance(*curves, 0.1)
    assert len(pieces) > 1
    assert parts.distance == pytest.approx(whole.distance, abs=2.0 * cable_distance.CLOSE)
    monkeypatch.setattr(cable_distance, "_MOST_PIECES", 1)
    with pytest.raises(ConvergenceError, match="smallest distance"):
        cable_distance.cable_distance(*hung(1), 0.1)


def test_masts_of_the_fem_that_have_not_settled(monkeypatch):
    from cdpr_struct.fem_reference import bent_masts

    robot = robot_with(frame_compliance=1e-4)
    point = OperatingPoint(robot, PLACE, LEVEL, inverse(robot, PLACE, LEVEL).cables)
    solve_in_fem(point, 4)
    monkeypatch.setattr(bent_masts, "MAX_ITERATIONS", 1)
    with pytest.raises(fem.MastsNotSettledError, match="heads of masts still move"):
        solve_in_fem(point, 4)
