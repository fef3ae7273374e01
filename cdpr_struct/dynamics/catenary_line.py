"""Tangent, tension and stiffness along a hanging cable, at unstrained arc lengths from its frame end."""

import numpy as np

from cdpr_struct.statics.cable_state import CableStates


def tangent_and_tension(cables: CableStates, arc: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tangent (m, q, 3) and tension (m, q) [N] at unstrained arc lengths from the frame."""
    hanging = cables.weight[:, None] * (cables.length[:, None] - arc)
    if cables.has_lumps:
        above = (cables.length[:, None] - cables.lump_place)[:, None, :] > arc[..., None]
        hanging = hanging + (cables.lump_weight[:, None, :] * above).sum(axis=-1)
    vertical = cables.force_z[:, None] - hanging
    horizontal = np.broadcast_to(cables.force_x[:, None], vertical.shape)
    tension = np.hypot(horizontal, vertical)
    return np.stack([horizontal, np.zeros_like(vertical), vertical], axis=-1) / tension[..., None], tension


def along(cables: CableStates, arc: np.ndarray) -> np.ndarray:
    """t t^T (m, q, 3, 3), local axes."""
    return _outer(tangent_and_tension(cables, arc)[0])


def across(cables: CableStates, arc: np.ndarray) -> np.ndarray:
    """1 - t t^T (m, q, 3, 3), local axes."""
    return np.asarray(np.eye(3) - along(cables, arc))


def stiffness_density(
    cables: CableStates,
    arc: np.ndarray,
    tightened: np.ndarray | None = None,
    axial_stiffness: np.ndarray | None = None,
) -> np.ndarray:
    """D (m, q, 3, 3) at unstrained arc lengths (m, q) from the frame [m], local axes (heading, across, up) [N].

    tightened : (m,) factor on the tension across the cable, None for 1
    axial_stiffness : (m,) EA [N] in vibration of cables that are inextensible at rest, None for that of the cables
    """
    tangent, tension = tangent_and_tension(cables, arc)
    outer = _outer(tangent)
    stiff = np.broadcast_to(cables.axial_stiffness, cables.length.shape)[:, None]
    held = tension / (1.0 + tension / stiff)
    if axial_stiffness is not None:
        stiff, held = axial_stiffness[:, None], tension
    if tightened is not None:
        held = held * tightened[:, None]
    return stiff[..., None, None] * outer + held[..., None, None] * (np.eye(3) - outer)


def _outer(tangent: np.ndarray) -> np.ndarray:
    return np.asarray(tangent[..., :, None] * tangent[..., None, :])
