"""How does the robot move in time, after a stop or under a wrench that varies?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from cdpr_struct.fem_reference.bar_element import MassModel
from cdpr_struct.fem_reference.linear_motion import linear_motion
from cdpr_struct.fem_reference.motion_problem import MotionProblem, TimeHistory, Wrench, motion_problem
from cdpr_struct.fem_reference.moving_robot import MovingRobot, MovingState, secant_stiffness
from cdpr_struct.fem_reference.nonlinear_motion import Stepper, body_wrench
from cdpr_struct.fem_reference.pulley import Wrap
from cdpr_struct.fem_reference.robot import RobotEquilibrium


def integrate(
    equilibrium: RobotEquilibrium,
    duration: float,
    time_step: float,
    initial_velocity: ArrayLike | None = None,
    damping_ratio: ArrayLike | None = None,
    external_wrench: Wrench | None = None,
    linear: bool = True,
    mass: MassModel = "lumped",
    record: Sequence[tuple[int, int]] = (),
) -> TimeHistory:
    """Motion of the robot from rest, all unstrained lengths locked.

    Parameters
    ----------
    equilibrium : RobotEquilibrium; of a platform held out of balance, what holds it goes on doing so.
    duration, time_step : [s].
    initial_velocity : (6,) velocity of the reference point [m/s] and angular velocity [rad/s], world; or None.
        As in a stop of all winches, each cable then moves too: with the velocity of its platform anchor at
        that end, falling linearly along the cable to zero at the frame.
    damping_ratio : xi [-] of the cables, one or (m,), or None; see `damping_rates`.
    external_wrench : function of the time [s] that returns (6,) force [N] and moment [N m] about the moving
        reference point, world; or None.
    linear : small motion on the tangent at rest; else large motion, in which bars turn slack instead of pushing.
    mass : "lumped" or "consistent", of the cables; large motion knows the lumped one only.
    record : (cable, node) pairs, node 1 ... n - 1 from the frame, whose displacement to keep.

    Raises
    ------
    StepNotConvergedError : a step of the large motion found no balance.
    ValueError : unfit arguments; large motion with pulleys or with consistent mass.
    """
    robot = equilibrium.robot
    if not robot.surroundings.still:
        raise ValueError("motion in time knows no SurroundingsData")
    problem = motion_problem(
        equilibrium, duration, time_step, initial_velocity, damping_ratio, external_wrench, record, mass
    )
    if linear:
        return linear_motion(problem)
    if mass != "lumped":
        raise ValueError(f"mass must be 'lumped' with linear=False, got {mass!r}")
    if any(isinstance(cable.wrap, Wrap) for cable in equilibrium.cables):
        raise ValueError("linear must be True for a robot with pulleys, got False")
    return _large_motion(problem)


def _large_motion(problem: MotionProblem) -> TimeHistory:
    robot, rest = MovingRobot.of(problem), problem.equilibrium
    turn, nodes = rest.rotation, np.array([cable.nodes[1:-1] for cable in rest.cables])
    still = MovingState(nodes, 0.0 * nodes, rest.position + turn @ robot.center, np.zeros(3), turn, np.zeros(3))
    spin = turn.T @ problem.twist[3:]
    velocity = problem.twist[:3] + np.cross(problem.twist[3:], turn @ robot.center)
    state = MovingState(nodes, problem.node_velocities(), still.center, velocity, turn, spin)
    stepper, floor = Stepper.of(robot, problem), robot.energy(still)
    wrenches = problem.wrenches - rest.residual_wrench
    history = TimeHistory.empty(problem.time, len(problem.recorded))
    for index, time in enumerate(problem.time):
        if index > 0:
            state = stepper.advance(state, 0.5 * (wrenches[index - 1] + wrenches[index]), float(time))
        cable, node = problem.recorded.T
        history.platform[index], history.platform_velocity[index] = _platform(robot, state, still)
        history.platform_acceleration[index] = _acceleration(robot, state, wrenches[index])
        history.cable_nodes[index] = (state.nodes - still.nodes)[cable, node - 1]
        history.energy[index] = robot.energy(state) - floor
    return history


def _platform(robot: MovingRobot, state: MovingState, still: MovingState) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and velocity (6,) of the platform, at the reference point."""
    arm, rate = -state.rotation @ robot.center, state.rotation @ state.spin
    shift = state.center + arm - still.center + still.rotation @ robot.center
    turn = Rotation.from_matrix(state.rotation @ still.rotation.T).as_rotvec()
    return np.concatenate([shift, turn]), np.concatenate([state.velocity + np.cross(rate, arm), rate])


def _acceleration(robot: MovingRobot, state: MovingState, wrench: np.ndarray) -> np.ndarray:
    """Acceleration (6,) at the reference point, from the forces on the body in this very state."""
    bars = np.diff(robot.points(state.nodes, state.center, state.rotation), axis=1)
    spans = np.linalg.norm(bars, axis=-1)
    pulls = secant_stiffness(robot, spans, spans)[0][:, -1:] * bars[:, -1]
    rate, arm = state.rotation @ state.spin, -state.rotation @ robot.center
    speeds = state.velocity + np.cross(rate, robot.anchors @ state.rotation.T)
    ends = -pulls - (robot.end_mass * robot.rates)[:, None] * speeds
    on_body = body_wrench(robot, state.rotation, ends, wrench)
    moment = state.rotation.T @ on_body[3:] - np.cross(state.spin, robot.inertia @ state.spin)
    angular = state.rotation @ np.linalg.solve(robot.inertia, moment)
    linear = on_body[:3] / robot.mass + np.cross(angular, arm) + np.cross(rate, np.cross(rate, arm))
    return np.concatenate([linear, angular])
