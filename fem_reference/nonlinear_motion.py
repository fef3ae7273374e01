"""Large motion in time: an implicit midpoint scheme that keeps energy, with Newton in every step.

Bars use secant forces (`secant_stiffness`). The body turns by R1 = cay(theta) R0, the exponential of the
rotation vector 2 atan(|theta| / 2) theta / |theta|, because then a point on the body moves by exactly
theta x (mean of its arms), so that moments about mean arms do the work of the forces; with theta / dt the mean
spin, the balance of angular momentum conserves the energy of rotation. Order two in the step. For small motion
it is the average-acceleration scheme.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import SuperLU

from cdpr_struct.fem_reference.errors import StepNotConvergedError
from cdpr_struct.fem_reference.linear_motion import banded_factors
from cdpr_struct.fem_reference.motion_problem import MotionProblem
from cdpr_struct.fem_reference.moving_robot import MovingRobot, MovingState, secant_stiffness
from cdpr_struct.fem_reference.rigid_platform import point_motion, rotating_arm_stiffness, turned
from cdpr_struct.fem_reference.sparse_chain import BorderedChains

MAX_ITERATIONS = 60
EPS = float(np.finfo(float).eps)
SLOW = 0.05  # a residual that keeps more than this share asks for a new tangent


@dataclass(frozen=True, eq=False)
class Step:
    """One trial step: the state it leads to, and by how much it violates the equations of motion.

    residual         : (3 m (n - 1) + 6,) [N] nodes, [N] and [N m] body
    vectors, secants : (m, n, 3) [m], (m, n) [N/m] mean bar vectors and what makes forces of them
    slopes           : (m, n, 3) [N/m^2] gradient of the secants by the bar vectors after the step
    arms, end_forces : (m, 3) [m], (m, 3) [N] mean arms of the anchors and forces of the cables there
    """

    after: MovingState
    residual: np.ndarray
    vectors: np.ndarray
    secants: np.ndarray
    slopes: np.ndarray
    arms: np.ndarray
    end_forces: np.ndarray


@dataclass(eq=False)
class Stepper:
    """Takes steps and keeps the factored tangent as long as it serves.

    reach     : [m] makes moments comparable with forces
    tolerance : [N]
    """

    robot: MovingRobot
    time_step: float
    reach: float
    tolerance: float
    assembly: BorderedChains
    factors: SuperLU | None = None

    @classmethod
    def of(cls, robot: MovingRobot, problem: MotionProblem) -> Stepper:
        """With a tolerance at the round-off of the present tensions and coordinates."""
        cables = problem.equilibrium.cables
        tension = max(float(cable.tensions.max()) for cable in cables)
        floor = max(cable.residual_floor for cable in cables)
        reach = float(max(np.linalg.norm(robot.anchors, axis=-1).max(), np.sqrt(np.trace(robot.inertia) / robot.mass)))
        assembly = BorderedChains(len(cables), problem.equilibrium.elements)
        return cls(robot, problem.time_step, reach, max(1e-11 * tension, 16.0 * floor), assembly)

    def advance(self, before: MovingState, wrench: np.ndarray, time: float) -> MovingState:
        """The state one step later, under a mean wrench (6,) about the reference point.

        Raises
        ------
        StepNotConvergedError : the equations of motion did not balance.
        """
        guess = np.concatenate([before.velocity, before.rotation @ before.spin])
        moved = self.time_step * np.concatenate([before.node_velocity.ravel(), guess])
        tolerance, last = self.tolerance + 64.0 * EPS * self._momentum(before) / self.time_step, np.inf
        for _ in range(MAX_ITERATIONS):
            step = self.trial(before, moved, wrench)
            size = self._size(step.residual)
            if size <= tolerance:
                return step.after
            if self.factors is None or size > SLOW * last:
                self.factors = banded_factors(self._tangent(step))
            moved, last = moved - self.factors.solve(step.residual), size
        raise StepNotConvergedError(time, size, tolerance, MAX_ITERATIONS)

    def _momentum(self, state: MovingState) -> float:
        """Size [N s] of the body's momentum, its spin included."""
        robot = self.robot
        turning = np.linalg.norm(robot.inertia @ state.spin) / self.reach
        return float(robot.mass * np.linalg.norm(state.velocity) + turning)

    def _size(self, residual: np.ndarray) -> float:
        forces, moments = np.abs(residual[:-3]).max(), np.abs(residual[-3:]).max() / self.reach
        return float(max(forces, moments))

    def trial(self, before: MovingState, moved: np.ndarray, wrench: np.ndarray) -> Step:
        """Evaluate the step in which the unknowns move by `moved`."""
        robot, dt = self.robot, self.time_step
        after = _moved(before, moved, dt)
        points = [robot.points(state.nodes, state.center, state.rotation) for state in (before, after)]
        old, new = (np.diff(each, axis=1) for each in points)
        vectors = 0.5 * (old + new)
        spans = [np.linalg.norm(each, axis=-1) for each in (old, new)]
        secants, rates = secant_stiffness(robot, *spans)
        pulls = secants[..., None] * vectors
        travel = (points[1] - points[0]) / dt
        drag = robot.node_mass * robot.rates[:, None, None]
        gained = robot.node_mass * (after.node_velocity - before.node_velocity) / dt
        on_nodes = gained - np.diff(pulls, axis=1) - robot.node_mass * robot.gravity + drag * travel[:, 1:-1]
        ends = -pulls[:, -1] - (robot.end_mass * robot.rates)[:, None] * travel[:, -1]
        rotation = 0.5 * (before.rotation + after.rotation)
        on_body = body_wrench(robot, rotation, ends, wrench)
        momentum = [state.rotation @ (robot.inertia @ state.spin) for state in (before, after)]
        gain = [robot.mass * (after.velocity - before.velocity), momentum[1] - momentum[0]]
        residual = np.concatenate([on_nodes.ravel(), np.concatenate(gain) / dt - on_body])
        slopes = (rates / spans[1])[..., None] * new
        return Step(after, residual, vectors, secants, slopes, robot.anchors @ rotation.T, ends)

    def _tangent(self, step: Step) -> csc_array:
        """Derivative of the residual by the step, but for terms of the body's turn in a step."""
        robot, dt = self.robot, self.time_step
        blocks = 0.5 * step.secants[..., None, None] * np.eye(3)
        blocks = blocks + step.vectors[..., :, None] * step.slopes[..., None, :]
        inertia = np.zeros((6, 6))
        inertia[:3, :3] = robot.mass * np.eye(3)
        inertia[3:, 3:] = step.after.rotation @ robot.inertia @ step.after.rotation.T
        arms = rotating_arm_stiffness(step.arms, step.end_forces)
        body = 2.0 / dt**2 * inertia + 0.25 * (arms + arms.T)
        lumps = robot.node_mass.ravel() * (2.0 / dt**2 + robot.rates / dt)
        return self.assembly.assembled(blocks, point_motion(step.arms), lumps, body)


def _moved(before: MovingState, moved: np.ndarray, dt: float) -> MovingState:
    """The state at the end of a step of the unknowns, with velocities whose mean is the step over dt."""
    nodes = moved[:-6].reshape(before.nodes.shape)
    shift, turn = moved[-6:-3], moved[-3:]
    size = float(np.linalg.norm(turn))
    stretch = 2.0 * np.arctan(0.5 * size) / size if size > 0.0 else 1.0
    return MovingState(
        before.nodes + nodes,
        2.0 / dt * nodes - before.node_velocity,
        before.center + shift,
        2.0 / dt * shift - before.velocity,
        turned(before.rotation, stretch * turn),
        2.0 / dt * before.rotation.T @ turn - before.spin,
    )


def body_wrench(robot: MovingRobot, rotation: np.ndarray, ends: np.ndarray, wrench: np.ndarray) -> np.ndarray:
    """Force and moment (6,) about the centre of mass, from cables (m, 3) [N], loads and a wrench (6,)."""
    arms = np.vstack([robot.anchors, robot.load_point, -robot.center]) @ rotation.T
    forces = np.vstack([ends, robot.load, wrench[:3]])
    moment = np.cross(arms, forces).sum(axis=0) + wrench[3:]
    return np.concatenate([forces.sum(axis=0) + robot.mass * robot.gravity, moment])
