"""A robot in large motion: bars, and one rigid body that carries the platform and the last half bars.

Lumped mass. The body is described about its own centre of mass, so that its two balances do not couple. Bars
pull by Hooke's law and do not push; a first bar that slides through an eyelet is one with the path behind it, as long
as both are together, and its half mass stays at the start. Forces of a step are those of the discrete-gradient kind:
they do exactly the work by which the stored energy falls between the ends of the step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cdpr_struct.fem_reference.motion_problem import MotionProblem
from cdpr_struct.fem_reference.rigid_platform import cross_matrix


@dataclass(frozen=True, eq=False)
class MovingState:
    """Where everything is and how fast.

    nodes, node_velocity : (m, n - 1, 3) [m], [m/s] interior nodes
    center, velocity     : (3,) [m], [m/s] centre of mass of the body
    rotation, spin       : (3, 3) body to world; (3,) [rad/s] angular velocity, body axes
    """

    nodes: np.ndarray
    node_velocity: np.ndarray
    center: np.ndarray
    velocity: np.ndarray
    rotation: np.ndarray
    spin: np.ndarray


@dataclass(frozen=True, eq=False)
class MovingRobot:
    """Constants of the motion; arrays of cables broadcast against (m, n) or (m, n, 3).

    natural_length, bar_rate   : (m, n) [m] at which a bar is slack, [N/m] of its stretch beyond
    node_mass, end_mass, rates : (m, 1, 1) [kg], (m,) [kg] of the last half bars, (m,) [1/s]
    mass, inertia              : [kg], (3, 3) [kg m^2] of the body, body axes
    center                     : (3,) [m] centre of mass from the reference point, body axes
    anchors, load_point        : (m, 3), (3,) [m] from the centre of mass, body axes
    load, moment               : (3,) [N] constant force at the load point, (3,) [N m] constant moment, world
    """

    starts: np.ndarray
    natural_length: np.ndarray
    bar_rate: np.ndarray
    node_mass: np.ndarray
    end_mass: np.ndarray
    rates: np.ndarray
    gravity: np.ndarray
    mass: float
    inertia: np.ndarray
    center: np.ndarray
    anchors: np.ndarray
    load: np.ndarray
    moment: np.ndarray
    load_point: np.ndarray

    @classmethod
    def of(cls, problem: MotionProblem) -> MovingRobot:
        """Collect the constants, with the last half bars fixed to the platform."""
        rest, robot = problem.equilibrium, problem.equilibrium.robot
        if robot.windy:
            raise ValueError("large motion knows no wind on cables: take linear=True, or CableData.drag_width = 0")
        if any(cable.lumps for cable in robot.cables):
            raise ValueError("large motion knows no masses on cables: take linear=True, or CableData.lumps = ()")
        length = np.array([cable.element_length for cable in rest.cables])
        lumps = length * np.array([cable.linear_density for cable in robot.cables])
        mass, center, inertia = _with_points(problem, 0.5 * lumps)
        push = rest.external_force
        return cls(
            np.array([cable.nodes[0] for cable in rest.cables]),
            *_bars(problem),
            lumps[:, None, None],
            0.5 * lumps,
            problem.rates,
            robot.gravity,
            mass,
            inertia,
            center,
            robot.platform_anchors - center,
            np.zeros(3) if push is None else push.force,
            np.zeros(3) if push is None else push.moment,
            -center if push is None else push.point - center,
        )

    def points(self, nodes: np.ndarray, center: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """All nodes (m, n + 1, 3) [m] from frame to platform."""
        ends = center + self.anchors @ rotation.T
        return np.concatenate([self.starts[:, None], nodes, ends[:, None]], axis=1)

    def energy(self, state: MovingState) -> float:
        """Kinetic and potential energy [J]; the height of the potential is arbitrary. A moment has none."""
        spans = np.linalg.norm(np.diff(self.points(state.nodes, state.center, state.rotation), axis=1), axis=-1)
        stretch = np.maximum(spans - self.natural_length, 0.0)
        strain = (0.5 * self.bar_rate * stretch**2).sum()
        moving = (
            0.5 * (self.node_mass * state.node_velocity**2).sum() + 0.5 * self.mass * state.velocity @ state.velocity
        )
        turning = 0.5 * state.spin @ self.inertia @ state.spin
        weight = (self.node_mass * state.nodes).sum(axis=(0, 1)) + self.mass * state.center
        push = self.load @ (state.center + state.rotation @ self.load_point)
        return float(strain + moving + turning - weight @ self.gravity - push)


def _bars(problem: MotionProblem) -> tuple[np.ndarray, np.ndarray]:
    """Natural lengths (m, n) [m] and rates (m, n) [N/m] of all bars, such that they pull at rest as they do."""
    rest = problem.equilibrium
    stiffness = np.array([cable.axial_stiffness for cable in rest.robot.cables])
    unstrained = np.repeat([[cable.element_length] for cable in rest.cables], rest.elements, axis=1)
    natural = unstrained.copy()
    for index, cable in enumerate(rest.cables):
        if cable.wrap is not None:
            behind, pull = cable.wrap.behind, float(cable.tensions[0])
            unstrained[index, 0] += behind / (1.0 + pull / stiffness[index])
            natural[index, 0] = unstrained[index, 0] - behind
    return natural, stiffness[:, None] / unstrained


def _with_points(problem: MotionProblem, lumps: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, centre of mass (from the reference point) and inertia of the platform with masses at its anchors."""
    robot = problem.equilibrium.robot
    masses = np.append(lumps, robot.platform.mass)
    places = np.vstack([robot.platform_anchors, robot.platform.center_of_mass])
    mass = float(masses.sum())
    center = masses @ places / mass
    arms = cross_matrix(places - center)
    return mass, center, robot.platform.inertia + np.einsum("k,kab,kcb->ac", masses, arms, arms)


def secant_stiffness(robot: MovingRobot, before: np.ndarray, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Twice the change of a bar's energy by the change of its squared length, and its derivative by `after`.

    before, after : (m, n) [m] lengths. Returns (m, n) [N/m], never negative, and (m, n) [N/m^2]. Times the mean
    of the two bar vectors the first is the force that does the work.
    """
    length, rate = robot.natural_length, robot.bar_rate
    old, new = np.maximum(before - length, 0.0), np.maximum(after - length, 0.0)
    taut = (before >= length) & (after >= length)
    turning = (before >= length) != (after >= length)
    squares = np.where(turning, after**2 - before**2, 1.0)
    secant = np.where(taut, rate * (old + new) / (before + after), 0.0)
    secant = np.where(turning, rate * (new**2 - old**2) / squares, secant)
    slope = np.where(taut, (rate - secant) / (before + after), 0.0)
    return secant, np.where(turning, 2.0 * (rate * new - secant * after) / squares, slope)
