"""Small motion about rest in time: Newmark's average acceleration on the sparse tangent, factored once.

Without damping and load the step keeps the energy v M v / 2 + u K u / 2 exactly; its error is of order two.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import SuperLU, splu

from cdpr_struct.fem_reference.motion_problem import MotionProblem, TimeHistory
from cdpr_struct.fem_reference.robot_modes import node_motion, robot_matrices
from cdpr_struct.fem_reference.sparse_chain import chain_matrix


def banded_factors(matrix: csc_array) -> SuperLU:
    """Factors of a positive matrix in the order of `node_motion`: bands, and a border at the end."""
    return splu(csc_array(matrix), permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


@dataclass(frozen=True, eq=False)
class LinearSystem:
    """M a + C v + K u = f in the unknowns of `node_motion`, sparse."""

    stiffness: csc_array
    mass: csc_array
    damping: csc_array

    @classmethod
    def of(cls, problem: MotionProblem) -> LinearSystem:
        """Tangent of the robot at rest, with mass-proportional damping of each cable, its last half bar included."""
        stiffness, mass = robot_matrices(problem.equilibrium, problem.mass)
        motion = node_motion(problem.equilibrium)
        damped = problem.rates[:, None, None, None] * problem.equilibrium.element_mass(problem.mass)
        return cls(stiffness, mass, csc_array(motion.T @ chain_matrix(damped) @ motion))

    def energy(self, place: np.ndarray, velocity: np.ndarray) -> float:
        """Kinetic and potential energy [J] above rest."""
        return float(0.5 * velocity @ (self.mass @ velocity) + 0.5 * place @ (self.stiffness @ place))


def linear_motion(problem: MotionProblem) -> TimeHistory:
    """Integrate the small motion from rest."""
    system, step = LinearSystem.of(problem), problem.time_step
    factors = banded_factors(system.stiffness + 2.0 / step * system.damping + 4.0 / step**2 * system.mass)
    place = np.zeros(system.mass.shape[0])
    velocity = np.concatenate([problem.node_velocities().ravel(), problem.twist])
    load = np.zeros_like(place)
    load[-6:] = problem.wrenches[0]
    acceleration = banded_factors(system.mass).solve(load - system.damping @ velocity)
    history = TimeHistory.empty(problem.time, len(problem.recorded))
    _note(history, 0, problem, system, (place, velocity, acceleration))
    for index in range(1, len(problem.time)):
        load[-6:] = problem.wrenches[index]
        inertial = system.mass @ (4.0 / step**2 * place + 4.0 / step * velocity + acceleration)
        after = factors.solve(load + inertial + system.damping @ (2.0 / step * place + velocity))
        faster = 2.0 / step * (after - place) - velocity
        acceleration = 2.0 / step * (faster - velocity) - acceleration
        place, velocity = after, faster
        _note(history, index, problem, system, (place, velocity, acceleration))
    return history


def _note(
    history: TimeHistory,
    index: int,
    problem: MotionProblem,
    system: LinearSystem,
    motion: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    """Write one time into the history."""
    place, velocity, acceleration = motion
    history.platform[index] = place[-6:]
    history.platform_velocity[index] = velocity[-6:]
    history.platform_acceleration[index] = acceleration[-6:]
    nodes = place[:-6].reshape(len(problem.rates), -1, 3)
    history.cable_nodes[index] = nodes[problem.recorded[:, 0], problem.recorded[:, 1] - 1]
    history.energy[index] = system.energy(place, velocity)
