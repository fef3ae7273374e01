"""Natural frequencies of the real robot: of its cables, and of platform with cables and masts."""

from __future__ import annotations

import numpy as np
from scipy.sparse import block_array, csc_array, diags_array, lil_array

from cdpr_struct.fem_reference import RobotEquilibrium, cable_modes
from cdpr_struct.fem_reference.eigen_solver import frequencies_hz, lowest_eigenpairs
from cdpr_struct.fem_reference.pendulum import PendulumData, with_pendulum
from cdpr_struct.fem_reference.rigid_platform import platform_mass_matrix
from cdpr_struct.fem_reference.robot_modes import robot_matrices
from tests.blind.bending_masts import exit_blocks, mast_motion, mast_springs
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import EnteredRobot
from tests.blind.platform_parts import moving_parts, with_parts
from tests.blind.true_robot import balancer_stiffness, true_gravity

CABLE_MODES = 4
ROBOT_MODES = 48
VISIBLE_SHARE = 0.3  # of the kinetic energy in the platform: what an accelerometer on it shows as a clear peak
CORD = 0.25  # m, of a payload that swings below the platform origin
SHIFT = -0.4  # (rad/s)^2, far below every mode of these robots


def in_plane_frequencies(equilibrium: RobotEquilibrium) -> np.ndarray:
    """Lowest in-plane frequencies (m, 4) [Hz] of the cables, platform held."""
    found = [cable_modes(cable, 2 * CABLE_MODES + 2) for cable in equilibrium.cables]
    return np.array([modes.frequencies_hz[modes.in_plane_share > 0.5][:CABLE_MODES] for modes in found])


def whole_matrices(
    robot: EnteredRobot, deviations: Deviations, equilibrium: RobotEquilibrium
) -> tuple[csc_array, csc_array]:
    """Stiffness and mass of cables and platform with hose and balancer, and of the masts that are not rigid.

    The mean of lumped and consistent mass is right to fourth order, also where modes of cables and platform are so
    close that frequencies of two meshes could not be extrapolated.
    """
    stiffness, lumped = robot_matrices(equilibrium, "lumped")
    mass = csc_array(0.5 * (lumped + robot_matrices(equilibrium, "consistent")[1]))
    hose = np.zeros(stiffness.shape[0])
    hose[-6:-3] = deviations["hose_stiffness"][0]
    stiffness = csc_array(stiffness + diags_array(hose))
    if np.any(deviations["tool_balancer"]):
        line = lil_array(stiffness.shape)
        line[-6:-3, -6:-3] = balancer_stiffness(robot, deviations, equilibrium.position)
        stiffness = csc_array(stiffness + line)
    if bob := swinging_mass(robot, deviations):
        gravity, hung = true_gravity(robot, deviations), PendulumData(bob, CORD, np.zeros(3))
        stiffness, mass = with_pendulum(stiffness, mass, equilibrium.rotation, gravity, hung)
    stiffness, mass = with_parts(robot, deviations, equilibrium.rotation, stiffness, mass)
    compliance = deviations["frame_compliance"]
    if not np.any(compliance):
        return stiffness, mass
    springs, motion = mast_springs(robot, compliance), mast_motion(robot, compliance)
    bars = 0.5 * (equilibrium.element_mass("lumped") + equilibrium.element_mass("consistent"))
    size = mass.shape[0], equilibrium.elements
    between, own = exit_blocks(equilibrium.element_stiffness()[:, 0], motion, *size)
    dragged, carried = exit_blocks(bars[:, 0], motion, *size)
    return (
        csc_array(block_array([[stiffness, between.T], [between, csc_array(own + springs)]])),
        csc_array(block_array([[mass, dragged.T], [dragged, csc_array(carried)]])),
    )


def swinging_mass(robot: EnteredRobot, deviations: Deviations) -> float:
    """[kg] of the platform's mass that hangs from its origin."""
    return float(robot.mass * deviations["swinging_payload"][0])


def robot_frequencies(
    robot: EnteredRobot, deviations: Deviations, equilibrium: RobotEquilibrium
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lowest frequencies (k,) [Hz], the share (k,) of their kinetic energy in the platform, and its motion (k, 6) [m,
    rad] of unit modal mass."""
    stiffness, mass = whole_matrices(robot, deviations, equilibrium)
    values, vectors = lowest_eigenpairs(stiffness, mass, ROBOT_MODES, SHIFT)
    end = 3 * len(equilibrium.cables) * (equilibrium.elements - 1)
    moved = vectors[end : end + 6]
    body = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation)
    body = body - moving_parts(robot, deviations, equilibrium.rotation)
    body = body - swinging_mass(robot, deviations) * np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    return frequencies_hz(values), np.einsum("ak,ab,bk->k", moved, body, moved), moved.T
