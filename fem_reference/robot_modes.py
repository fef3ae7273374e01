"""Eigenfrequencies and shapes of platform and cables together, and what part of the mass moves in each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.sparse import block_diag, csc_array, eye_array, hstack, lil_array, vstack

from cdpr_struct.fem_reference.bar_element import MassModel
from cdpr_struct.fem_reference.cable_modes import string_eigenvalue
from cdpr_struct.fem_reference.eigen_solver import frequencies_hz, lowest_eigenpairs
from cdpr_struct.fem_reference.errors import MissedModesError
from cdpr_struct.fem_reference.masts import unknowns
from cdpr_struct.fem_reference.rigid_platform import platform_mass_matrix
from cdpr_struct.fem_reference.robot import RobotEquilibrium
from cdpr_struct.fem_reference.robot_dynamics import count_below, platform_dynamic_stiffness
from cdpr_struct.fem_reference.sparse_chain import chain_matrix

SPARE_MODES = (4, 16, 64)  # solved beyond the asked ones, until the count can be checked in a clear gap
CLEAR_GAP = 1e-7  # relative distance of two frequencies between which a count is beyond doubt


@dataclass(frozen=True, eq=False)
class RobotModes:
    """Modes of a robot with held lengths, ascending; modal mass 1 kg.

    frequencies_hz  : (k,) [Hz]
    platform_shapes : (k, 6) displacement of the reference point and rotation, world axes
    cable_shapes    : (k, m, n - 1, 3) displacement of the interior nodes, world
    platform_energy : (k,) share of the kinetic energy in the platform
    cable_energy    : (k, m) share of the kinetic energy in each cable, its last half element included
    """

    frequencies_hz: np.ndarray
    platform_shapes: np.ndarray
    cable_shapes: np.ndarray
    platform_energy: np.ndarray
    cable_energy: np.ndarray


def node_motion(equilibrium: RobotEquilibrium) -> csc_array:
    """Motion of all nodes 1 ... n of all cables per unknown: sparse (3 m n, 3 m (n - 1) + 6).

    The unknowns are the interior nodes, cable by cable, and at the end the six of the platform. Masts are not among
    them: they move only the start nodes, which are left out.
    """
    interior, ends = 3 * (equilibrium.elements - 1), equilibrium.end_motion()
    own = vstack([eye_array(interior), csc_array((3, interior))])
    moved = [vstack([csc_array((interior, 6)), csc_array(end)]) for end in ends]
    return csc_array(hstack([block_diag([own] * len(ends)), vstack(moved)]))


def robot_matrices(equilibrium: RobotEquilibrium, mass: MassModel = "lumped") -> tuple[csc_array, csc_array]:
    """Tangent stiffness and mass of the whole robot in the unknowns of `node_motion`, sparse.

    Masts that bend add three unknowns each, between the cables' and the platform's. What a guide holds is among them.
    """
    motion, robot = node_motion(equilibrium), equilibrium.robot
    elements = (equilibrium.element_stiffness(), equilibrium.element_mass(mass))
    on_platform = (
        equilibrium.geometric_stiffness(),
        platform_mass_matrix(robot.platform, equilibrium.rotation),
    )
    cables = motion.shape[1] - 6
    stiffness, inertia = (
        csc_array(motion.T @ chain_matrix(matrices) @ motion + block_diag([csc_array((cables, cables)), added]))
        for matrices, added in zip(elements, on_platform, strict=True)
    )
    if not robot.surroundings.bending:
        return stiffness, inertia
    return (
        _with_masts(equilibrium, stiffness, elements[0], elastic=True),
        _with_masts(equilibrium, inertia, elements[1], elastic=False),
    )


def _with_masts(
    equilibrium: RobotEquilibrium, matrix: csc_array, element_matrices: np.ndarray, elastic: bool
) -> csc_array:
    """The matrix with the unknowns of the masts before the platform's: first bars of their cables, and own stiffness.

    elastic : whether it is the stiffness; masts have mass at their exits only
    """
    robot, interior = equilibrium.robot, 3 * (equilibrium.elements - 1)
    masts, places = robot.soft_masts, unknowns(robot.soft_masts)
    cables, count = matrix.shape[0] - 6, places[-1].stop
    full = lil_array((matrix.shape[0] + count, matrix.shape[0] + count))
    keep = np.r_[0:cables, cables + count : full.shape[0]]
    coo = matrix.tocoo()
    full[keep[coo.row], keep[coo.col]] = coo.data
    for mast, rows in zip(masts, places, strict=True):
        own = slice(cables + rows.start, cables + rows.stop)
        alone = np.linalg.inv(mast.flexibility) if elastic else mast.inertia
        full[own, own] = mast.condensed(element_matrices[:, 0, :3, :3]) + alone
        for cable, moved in zip(mast.cables, mast.motion, strict=True):
            node = slice(cable * interior, cable * interior + 3)
            full[own, node] = moved.T @ element_matrices[cable, 0, :3, 3:]
            full[node, own] = element_matrices[cable, 0, 3:, :3] @ moved
    return csc_array(full)


def robot_modes(equilibrium: RobotEquilibrium, count: int, mass: MassModel = "lumped") -> RobotModes:
    """Lowest `count` modes; the number of frequencies found is certified by `count_below`.

    Raises
    ------
    ValueError : count above the number of unknowns, or an unknown mass model.
    UnstableEquilibriumError : the platform does not rest stably.
    MissedModesError : the sign count contradicts the eigensolver.
    """
    held = 6 - len(equilibrium.robot.free_unknowns)
    stiffness, inertia = (_of_free(equilibrium, matrix) for matrix in robot_matrices(equilibrium, mass))
    if not 1 <= count <= stiffness.shape[0]:
        raise ValueError(f"count must be between 1 and {stiffness.shape[0]}, got {count!r}")
    for spare in SPARE_MODES:
        solved = min(count + spare, stiffness.shape[0])
        values, vectors = lowest_eigenpairs(stiffness, inertia, solved, _shift(equilibrium))
        found, counted, omega = _counted_in_gap(equilibrium, values, count, mass)
        if found == counted:
            break
    else:
        raise MissedModesError(found, counted, omega / (2.0 * np.pi))
    platform = vectors[vectors.shape[0] - 6 + held :, :count]
    vectors = np.delete(vectors[:, :count], _mast_unknowns(equilibrium), axis=0)
    vectors = np.concatenate([vectors[: len(vectors) - 6 + held], np.zeros((6, count))])
    vectors[-6 + equilibrium.robot.free_unknowns] = platform
    cables, interior = len(equilibrium.cables), equilibrium.elements - 1
    platform_energy, cable_energy = _energy_shares(equilibrium, vectors, mass)
    return RobotModes(
        frequencies_hz(values[:count]),
        vectors[-6:].T.copy(),
        vectors[:-6].T.reshape(count, cables, interior, 3),
        platform_energy,
        cable_energy,
    )


def _of_free(equilibrium: RobotEquilibrium, matrix: csc_array) -> csc_array:
    """The matrix without rows and columns of what a guide holds of the platform, whose unknowns come last."""
    first = matrix.shape[0] - 6
    kept = np.concatenate([np.arange(first), first + equilibrium.robot.free_unknowns])
    return csc_array(csc_array(matrix[kept])[:, kept])


def _mast_unknowns(equilibrium: RobotEquilibrium) -> np.ndarray:
    first = 3 * len(equilibrium.cables) * (equilibrium.elements - 1)
    return first + np.arange(unknowns(equilibrium.robot.soft_masts)[-1].stop if equilibrium.robot.soft_masts else 0)


def _shift(equilibrium: RobotEquilibrium) -> float:
    """A small negative eigenvalue [rad^2/s^2], well below strings and platform of this robot."""
    scales = [string_eigenvalue(cable) for cable in equilibrium.cables]
    stiffness = platform_dynamic_stiffness(equilibrium, 0.0)
    platform = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation)
    free = np.ix_(equilibrium.robot.free_unknowns, equilibrium.robot.free_unknowns)
    rigid = scipy.linalg.eigh(stiffness[free], platform[free], eigvals_only=True)
    scales += [float(value) for value in rigid if value > 1e-12 * rigid[-1]]
    return -1e-3 * min(scales)


def _counted_in_gap(
    equilibrium: RobotEquilibrium, values: np.ndarray, count: int, mass: MassModel
) -> tuple[int, int, float]:
    """Modes found and modes counted below omega, in the widest gap at or after the last mode asked for.

    A gap too narrow to count in is reported as found = -1. With every unknown solved nothing can be missed.
    """
    roots = np.sqrt(np.maximum(values, 0.0))
    free = 3 * len(equilibrium.cables) * (equilibrium.elements - 1) + len(equilibrium.robot.free_unknowns)
    if len(roots) == free + len(_mast_unknowns(equilibrium)):
        return len(roots), len(roots), float(roots[-1])
    gaps = np.diff(roots[count - 1 :])
    last = count - 1 + int(np.argmax(gaps))
    omega = 0.5 * float(roots[last] + roots[last + 1])
    clear = gaps.max() > CLEAR_GAP * omega
    return (last + 1 if clear else -1), count_below(equilibrium, omega, mass), omega


def _energy_shares(
    equilibrium: RobotEquilibrium, vectors: np.ndarray, mass: MassModel
) -> tuple[np.ndarray, np.ndarray]:
    """Shares (k,) of the platform and (k, m) of the cables in the kinetic energy of vectors (dofs, k)."""
    moved = node_motion(equilibrium) @ vectors
    held = chain_matrix(equilibrium.element_mass(mass)) @ moved
    in_cables = (moved * held).reshape(len(equilibrium.cables), -1, vectors.shape[1]).sum(axis=1).T
    matrix = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation)
    in_platform = np.einsum("ak,ab,bk->k", vectors[-6:], matrix, vectors[-6:])
    total = in_platform + in_cables.sum(axis=1)
    return in_platform / total, in_cables / total[:, None]
