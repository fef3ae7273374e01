"""What is to be integrated in time, and what comes out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cdpr_struct.fem_reference.arrays import fixed_array
from cdpr_struct.fem_reference.bar_element import MassModel
from cdpr_struct.fem_reference.cable_damping import damping_rates
from cdpr_struct.fem_reference.robot import RobotEquilibrium

Wrench = Callable[[float], ArrayLike]


@dataclass(frozen=True, eq=False)
class TimeHistory:
    """Motion of a robot from its rest position, at n equidistant times.

    time                  : (n,) [s]
    platform              : (n, 6) displacement of the reference point [m], rotation vector from rest [rad], world
    platform_velocity     : (n, 6) velocity of the reference point [m/s], angular velocity [rad/s], world
    platform_acceleration : (n, 6) their rates [m/s^2], [rad/s^2]
    cable_nodes           : (n, k, 3) [m] displacement of the nodes asked for
    energy                : (n,) [J] kinetic and potential, above rest; the work of an external wrench shows in it
    """

    time: np.ndarray
    platform: np.ndarray
    platform_velocity: np.ndarray
    platform_acceleration: np.ndarray
    cable_nodes: np.ndarray
    energy: np.ndarray

    @classmethod
    def empty(cls, time: np.ndarray, nodes: int) -> TimeHistory:
        """Arrays of the right shapes, to be filled."""
        count = len(time)
        place, velocity, acceleration = np.zeros((3, count, 6))
        return cls(time, place, velocity, acceleration, np.zeros((count, nodes, 3)), np.zeros(count))


@dataclass(frozen=True, eq=False)
class MotionProblem:
    """Everything a time integration needs to know.

    time           : (n,) [s]
    twist          : (6,) velocity of the reference point, angular velocity at time 0
    rates          : (m,) [1/s], damping force per mass and velocity of the cables
    wrenches       : (n, 6) [N, N m] on the platform, about the reference point
    recorded       : (k, 2) cable and node numbers
    """

    equilibrium: RobotEquilibrium
    time: np.ndarray
    twist: np.ndarray
    rates: np.ndarray
    wrenches: np.ndarray
    recorded: np.ndarray
    mass: MassModel

    @property
    def time_step(self) -> float:
        """Distance [s] of the times."""
        return float(self.time[1] - self.time[0])

    def node_velocities(self) -> np.ndarray:
        """Velocities (m, n - 1, 3) [m/s] of the interior nodes: that of the platform anchor, falling to zero.

        They fall linearly with the unstrained length from the platform end to the frame end.
        """
        elements = self.equilibrium.elements
        fraction = np.arange(1, elements) / elements
        return np.asarray(fraction[:, None] * (self.equilibrium.end_motion() @ self.twist)[:, None, :])


def motion_problem(
    equilibrium: RobotEquilibrium,
    duration: float,
    time_step: float,
    initial_velocity: ArrayLike | None,
    damping_ratio: ArrayLike | None,
    external_wrench: Wrench | None,
    record: Sequence[tuple[int, int]],
    mass: MassModel,
) -> MotionProblem:
    """Check the arguments of `integrate` and evaluate what depends on time alone."""
    if not 0.0 < time_step <= duration < np.inf:
        raise ValueError(f"time_step must lie between 0 and duration, got {time_step!r} and {duration!r}")
    time = time_step * np.arange(int(np.ceil(duration / time_step * (1.0 - 1e-12))) + 1)
    wrenches = np.zeros((len(time), 6))
    if external_wrench is not None:
        wrenches = np.array([fixed_array("external_wrench(t)", external_wrench(float(at)), (6,)) for at in time])
    recorded = np.array(list(record), dtype=int).reshape(-1, 2)
    cables, elements = len(equilibrium.cables), equilibrium.elements
    for cable, node in recorded.tolist():
        if not (0 <= cable < cables and 1 <= node < elements):
            raise ValueError(
                f"record must hold cables 0 ... {cables - 1}, nodes 1 ... {elements - 1}, got {cable, node}"
            )
    if equilibrium.robot.guided:
        raise ValueError("the motion of a guided platform in time is not among what this program integrates")
    if any(cable.winch_tension for cable in equilibrium.robot.cables):
        raise ValueError("winches that hold a tension are not among what this program integrates in time")
    twist = fixed_array("initial_velocity", np.zeros(6) if initial_velocity is None else initial_velocity, (6,))
    rates = damping_rates(equilibrium, damping_ratio, mass)
    return MotionProblem(equilibrium, time, twist, rates, wrenches, recorded, mass)
