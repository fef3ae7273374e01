"""The two-node bar: large displacement, Hooke's law on the unstrained length.

Per element the tension is N = EA (l / L0 - 1), with l the present node distance and L0 the unstrained
length; its nodes are pulled towards each other. Everything here acts on all elements at once: arrays carry
any leading axes (cables, elements) and a trailing element matrix of 6 x 6 = (first node, second node).
"""

from __future__ import annotations

from typing import Literal

import numpy as np

MassModel = Literal["lumped", "consistent"]


def bar_tensions(nodes: np.ndarray, element_length: float, axial_stiffness: float | np.ndarray) -> np.ndarray:
    """Tension vectors (n, 3) [N] of the bars between nodes (n + 1, 3) [m], each towards the next node.

    axial_stiffness : EA [N], one or (n,)
    """
    steps = np.diff(nodes, axis=0)
    lengths = np.linalg.norm(steps, axis=-1, keepdims=True)
    stiffness = np.asarray(axial_stiffness)[..., None]
    return np.asarray(stiffness * (lengths / element_length - 1.0) * steps / lengths)


def internal_forces(nodes: np.ndarray, element_length: float, axial_stiffness: float | np.ndarray) -> np.ndarray:
    """Forces (n + 1, 3) [N] that must act on the nodes to hold the stretched bars in place (no weight)."""
    tensions = bar_tensions(nodes, element_length, axial_stiffness)
    forces = np.zeros_like(nodes)
    forces[:-1] -= tensions
    forces[1:] += tensions
    return forces


def bar_stiffness(
    directions: np.ndarray, tensions: np.ndarray, element_length: np.ndarray, axial_stiffness: np.ndarray
) -> np.ndarray:
    """Tangent stiffness of bars: material part along the bar, geometric part N / l across it.

    Parameters
    ----------
    directions : (..., 3) unit vectors.
    tensions : (...) N [N].
    element_length, axial_stiffness : (...) L0 [m], EA [N], or anything that broadcasts to (...).

    Returns
    -------
    (..., 6, 6) [N/m]: derivative of the nodal `internal_forces` by the node positions.
    """
    along = directions[..., :, None] * directions[..., None, :]
    stretched = element_length * (1.0 + tensions / axial_stiffness)
    material = np.asarray(axial_stiffness / element_length)[..., None, None]
    geometric = (tensions / stretched)[..., None, None]
    block = material * along + geometric * (np.eye(3) - along)
    return np.block([[block, -block], [-block, block]])


def bar_mass(element_mass: np.ndarray, model: MassModel) -> np.ndarray:
    """Mass matrices (..., 6, 6) [kg] of bars of mass (...) [kg].

    "lumped" puts half the mass on either node, "consistent" integrates the linear shape functions.

    Raises
    ------
    ValueError : unknown mass model.
    """
    if model == "lumped":
        pattern = np.diag([0.5, 0.5])
    elif model == "consistent":
        pattern = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    else:
        raise ValueError(f"mass must be 'lumped' or 'consistent', got {model!r}")
    return np.asarray(element_mass)[..., None, None] * np.kron(pattern, np.eye(3))
