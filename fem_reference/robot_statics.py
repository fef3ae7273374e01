"""Where does the platform rest when all cable lengths are fixed?

The cables are solved to equilibrium for every trial pose, so the pose is the only unknown. Newton with the
exact tangent, cable flexibility and turning lever arms included, descends on the total potential energy:
what it finds is a stable rest position, not merely a balance of forces.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cdpr_struct.fem_reference.arrays import fixed_array
from cdpr_struct.fem_reference.bent_masts import bend, softened
from cdpr_struct.fem_reference.cable import CableEquilibrium
from cdpr_struct.fem_reference.cable_statics import EPS, CableBatch, ChainState, equilibria
from cdpr_struct.fem_reference.cable_wind import pressure, settled
from cdpr_struct.fem_reference.errors import (
    FoldedCableError,
    PulleysNotSettledError,
    RobotNotConvergedError,
    WindNotSettledError,
)
from cdpr_struct.fem_reference.pulley_statics import (
    drawn_from_winches,
    guessed_wraps,
    handed_on,
    movement,
    rewrapped,
    sliding_in,
    unwound,
    wraps_towards,
)
from cdpr_struct.fem_reference.rigid_platform import point_motion, rotating_arm_stiffness, turned
from cdpr_struct.fem_reference.robot import DeadLoads, PointForce, RobotData, RobotEquilibrium

MAX_ITERATIONS = 100
LARGEST_TURN = 0.3  # rad a step
SHORTEST_UNFOLDED = 1e-3  # share of a Newton step; where even this folds a cable, the rest position lies in the fold


@dataclass(frozen=True, eq=False)
class PlatformState:
    """Everything known at one trial pose.

    wrench  : (6,) [N, N m] of all forces on the platform
    tangent : (6, 6) minus the derivative of the wrench by (displacement, rotation)
    energy  : [J] total potential energy
    starts  : (m, 3) [m], where the cables start: the frame anchors, or where masts have moved them
    """

    position: np.ndarray
    rotation: np.ndarray
    chains: ChainState
    chain_iterations: int
    wrench: np.ndarray
    tangent: np.ndarray
    energy: float
    starts: np.ndarray


def platform_state(
    robot: RobotData,
    batch: CableBatch,
    loads: DeadLoads,
    position: np.ndarray,
    rotation: np.ndarray,
    first: np.ndarray | None = None,
) -> PlatformState:
    """Solve the cables at a pose and sum what they and the loads do to the platform."""
    arms = robot.platform_anchors @ rotation.T
    load_arms = loads.points @ rotation.T
    ends = position + arms
    around = robot.surroundings
    bent = bend(batch, robot.frame_anchors, ends, robot.soft_masts, first)
    chains = bent.chains
    pulls = batch.on_end - chains.mid_force
    forces, levers = np.vstack([pulls, loads.forces]), np.vstack([arms, load_arms])
    wrench = np.concatenate([forces.sum(axis=0), np.cross(levers, forces).sum(axis=0)])
    away = position - around.tether_point
    wrench[3:] += loads.moment
    wrench[:3] -= around.tether_stiffness * away
    motion = point_motion(arms)
    if around.bending:
        rates = np.linalg.inv(chains.flexibility)
        tangent, _ = softened(robot.soft_masts, rates, rates, -rates, motion)
    else:
        tangent = np.einsum("mka,mkb->ab", motion, np.linalg.solve(chains.flexibility, motion))
    tangent[:3, :3] += around.tether_stiffness * np.eye(3)
    tangent += rotating_arm_stiffness(levers, forces)
    cable_energy = -chains.energy - (batch.on_start * bent.starts + batch.on_end * ends).sum(axis=1)
    load_energy = (loads.forces * (position + load_arms)).sum() - 0.5 * around.tether_stiffness * (away @ away)
    energy = float(cable_energy.sum() - load_energy) + bent.energy
    return PlatformState(position, rotation, chains, bent.iterations, wrench, tangent, energy, bent.starts)


def _step(state: PlatformState, reach: float, free: np.ndarray) -> np.ndarray:
    """Newton step (6,) that goes downhill even where the tangent is not positive, of limited size, in unknowns (f,)."""
    scale = np.array([1.0] * 3 + [1.0 / reach] * 3)
    tangent = scale[:, None] * 0.5 * (state.tangent + state.tangent.T) * scale
    values, vectors = np.linalg.eigh(tangent[np.ix_(free, free)])
    values = np.maximum(np.abs(values), 1e-12 * np.abs(values).max())
    step = np.zeros(6)
    step[free] = vectors @ (vectors.T @ (scale * state.wrench)[free] / values)
    step *= scale
    size = float(max(np.linalg.norm(step[3:]), np.linalg.norm(step[:3]) / reach))
    return step * min(1.0, LARGEST_TURN / max(size, 1e-300))


def _tolerances(
    batch: CableBatch, loads: DeadLoads, state: PlatformState, ends_reach: float, arm: float
) -> tuple[float, float]:
    """Force [N] and moment [N m] below which a wrench is round-off, for the present forces."""
    tensions = np.linalg.norm(state.chains.tension_vectors, axis=-1).max(axis=1)
    scale = tensions.sum() + np.linalg.norm(loads.forces, axis=-1).sum() + np.linalg.norm(loads.moment) / arm
    noise = (batch.axial_stiffness * (1.0 + ends_reach / batch.unstrained_length)).sum()
    force = float(max(1e-12 * scale, 16.0 * EPS * noise))
    return force, force * arm


def _reach(robot: RobotData, loads: DeadLoads) -> float:
    """Lever arm [m] that makes rotations comparable with displacements."""
    arms = np.vstack([robot.platform_anchors, loads.points])
    inertia = float(np.trace(robot.platform.inertia)) / (2.0 * robot.platform.mass)
    return float(max(np.linalg.norm(arms, axis=-1).max(), np.sqrt(inertia)))


def _descend(
    robot: RobotData,
    batch: CableBatch,
    loads: DeadLoads,
    state: PlatformState,
    step: np.ndarray,
    floor: float,
) -> PlatformState:
    """Halve the step until the energy falls, or at round-off until the wrench does not grow.

    A step so long that a cable goes slack and folds is halved, too; `FoldedCableError` if short ones fold as well.
    """
    free = robot.free_unknowns
    slope, size = float(state.wrench @ step), float(np.abs(state.wrench[free]).max())
    scale = 1.0
    for _ in range(40):
        place, turn = state.position + scale * step[:3], turned(state.rotation, scale * step[3:])
        try:
            trial = platform_state(robot, batch, loads, place, turn, state.chains.mid_force)
        except FoldedCableError:
            if scale < SHORTEST_UNFOLDED:
                raise
            scale *= 0.5
            continue
        work = scale * float(loads.moment @ step[3:])  # of the moment, which is constant along this turn
        lower = trial.energy - work <= state.energy - 1e-4 * scale * slope
        if lower or float(np.abs(trial.wrench[free]).max()) <= max(0.5 * size, floor):
            break
        scale *= 0.5
    return trial


def solve_robot(
    robot: RobotData,
    position: ArrayLike,
    rotation: ArrayLike,
    elements: int,
    hold_pose: bool = False,
    external_force: PointForce | None = None,
) -> RobotEquilibrium:
    """Static equilibrium of the robot with unstrained lengths, or tensions of winches, fixed; guided unknowns stay.

    Parameters
    ----------
    robot : RobotData.
    position, rotation : (3,) [m] and (3, 3) platform to world: first guess of the pose, or the pose itself.
    elements : bars per cable.
    hold_pose : keep the platform where it is; `residual_wrench` then reports what is out of balance.
    external_force : a further constant force on the platform.

    Raises
    ------
    RobotNotConvergedError : forces and moments did not balance; carries the last pose and wrench.
    FoldedCableError, CableNotConvergedError : a cable has no equilibrium that bars can show.
    PulleysNotSettledError, UndefinedSwivelError : the pulleys find no place to face.
    WindNotSettledError : the wind on the cables kept changing with the pose.
    ValueError : wrong shapes or numbers.
    """
    place, turn = fixed_array("position", position, (3,)), fixed_array("rotation", rotation, (3, 3))
    if np.abs(turn @ turn.T - np.eye(3)).max() > 1e-9 or np.linalg.det(turn) < 0.0:
        raise ValueError(f"rotation must be a proper rotation matrix, got {turn.tolist()!r}")
    loads = DeadLoads.on(robot, external_force)
    state, cables, iterations = _settled(robot, loads, place, turn, elements, hold_pose)
    return RobotEquilibrium(
        robot,
        external_force,
        fixed_array("position", state.position, (3,)),
        fixed_array("rotation", state.rotation, (3, 3)),
        cables,
        fixed_array("residual_wrench", state.wrench, (6,)),
        iterations,
    )


def _settled(
    robot: RobotData, loads: DeadLoads, place: np.ndarray, turn: np.ndarray, elements: int, hold_pose: bool
) -> tuple[PlatformState, tuple[CableEquilibrium, ...], int]:
    """Statics with the exits of the pulleys and the wind on the cables held, until both stay; one round without."""
    wraps, first, iterations = guessed_wraps(robot, place, turn), None, 0
    handed, tensions = np.zeros_like(robot.frame_anchors), np.zeros(len(robot.cables))
    starts = unwound(robot, wraps).frame_anchors
    for _ in range(MAX_ITERATIONS):
        bare = unwound(robot, wraps)
        pressed = pressure(robot, starts, place, turn)
        batch = sliding_in(CableBatch.of(bare.cables, elements, bare.gravity, pressed), handed, tensions, wraps)
        state = platform_state(bare, batch, loads, place, turn, first)
        if not hold_pose:
            state, steps = _balanced(bare, batch, loads, state)
            iterations += steps
        place, turn, first, starts = state.position, state.rotation, state.chains.mid_force, state.starts
        before, pulls = wraps, state.chains.tension_vectors[:, 0]
        tensions = np.linalg.norm(pulls, axis=-1)
        drawn = drawn_from_winches(wraps, batch, tensions)
        wraps = wraps_towards(robot, pulls, tensions, 0.5 * batch.element_weight, drawn)
        handed = handed_on(wraps, batch.element_length * (1.0 + tensions / batch.axial_stiffness))
        moved, floor = movement(before, wraps)
        if moved <= floor and settled(pressed, pressure(robot, starts, place, turn)):
            cables = equilibria(batch, state.starts, state.chains, state.chain_iterations)
            return state, rewrapped(cables, before), iterations
    raise PulleysNotSettledError(moved, MAX_ITERATIONS) if moved > floor else WindNotSettledError(MAX_ITERATIONS)


def _balanced(robot: RobotData, batch: CableBatch, loads: DeadLoads, state: PlatformState) -> tuple[PlatformState, int]:
    """Newton steps until the wrench is round-off."""
    reach, free = _reach(robot, loads), robot.free_unknowns
    far = float(np.abs(robot.frame_anchors).max()) + reach
    for iteration in range(MAX_ITERATIONS):
        force, moment = _tolerances(batch, loads, state, far + float(np.abs(state.position).max()), reach)
        left = np.zeros(6)
        left[free] = state.wrench[free]
        sizes = np.linalg.norm(left[:3]), np.linalg.norm(left[3:])
        if sizes[0] <= force and sizes[1] <= moment:
            return state, iteration
        state = _descend(robot, batch, loads, state, _step(state, reach, free), force)
    raise RobotNotConvergedError(state.wrench, force, MAX_ITERATIONS, state.position, state.rotation)
