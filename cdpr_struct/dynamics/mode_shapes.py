"""In which few numbers can mode shapes at different poses be compared?

A shape is the platform's motion and the part of each cable's motion in each of its first harmonics sin(k pi s), s from
the frame to the platform, in world axes, all times the root of the mass that moves. Products of two shapes at one pose
are products with the mass matrix, but for what the cables do beyond these harmonics and along their chords. Nothing in
this depends on the order of frequencies, on how the modes were computed, or on the cables' planes.
"""

import numpy as np

from cdpr_struct.dynamics.cables_of_poses import HangingCables
from cdpr_struct.dynamics.condensed_robot import Platform
from cdpr_struct.dynamics.internal_mass import PARTS
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import RitzModes
from cdpr_struct.dynamics.string_functions import StringFunctions

_MORE_NODES = 4
_RIGID = 6 + PARTS


def shape_size(cables: int, harmonics: int) -> int:
    """Numbers of a shape: six of the platform, those of parts moving in it, three a cable and harmonic."""
    return _RIGID + 3 * cables * harmonics


def condensed_shapes(
    platform: Platform, motion: np.ndarray, leads: np.ndarray, functions: StringFunctions, harmonics: int
) -> np.ndarray:
    """Shapes (n, s, d) of modes on condensed cables.

    motion : (n, 6, s) of the platform, at unit modal mass
    leads  : (n, 2 p m, s) of the pencil's unknowns beside the platform's
    """
    m, n, s = platform.motion.shape[2], len(motion), motion.shape[2]
    root = np.linalg.cholesky(np.moveaxis(platform.mass, -1, 0))
    rigid = np.moveaxis(np.swapaxes(root, 1, 2) @ motion, 1, 2)
    p = leads.shape[1] // (2 * m)
    used = min(p, harmonics)
    of_lead = leads.reshape(n, 2, p, m, s)[:, :, :used] * _signs(functions, used)[:, None, None]
    shapes = np.zeros((n, s, shape_size(m, harmonics)))
    shapes[..., :6] = rigid
    across = np.moveaxis(platform.motion[1:, :3], -1, 0)  # (n, 2, 3, m): unit vectors n and y
    moved = np.einsum("npam,npkms->nsmka", across, of_lead, optimize=True)
    shapes[..., _RIGID:].reshape(n, s, m, harmonics, 3)[..., :used, :] = moved
    return shapes


def _signs(functions: StringFunctions, count: int) -> np.ndarray:
    """(count,) +-1: the string's functions times this rise from the frame like sines."""
    k = np.arange(count)
    return np.asarray(np.sign(functions.mass[:count, -1]) * (-1.0) ** k)


def ritz_shapes(point: OperatingPoint, modes: RitzModes, harmonics: int) -> np.ndarray:
    """Shapes (n, k, d) of modes of the general solver at a flat batch of poses."""
    n, count = modes.omega.shape
    m = modes.end.shape[-2]
    moved = np.concatenate([modes.platform, modes.internal], axis=-1)
    mass = np.zeros((n, _RIGID, _RIGID))
    mass[:, :6, :6] = modes.platform_mass
    mass[:, :6, 6:] = modes.internal_coupling
    mass[:, 6:, :6] = np.swapaxes(modes.internal_coupling, 1, 2)
    mass[:, range(6, _RIGID), range(6, _RIGID)] = 1.0
    mass[:, range(6), range(6)] += point.arrays.guided  # where a guide holds the platform it has no motion
    nodes, weights = np.polynomial.legendre.leggauss(2 * harmonics + _MORE_NODES)
    stations, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    sines = np.sin(np.pi * np.arange(1, harmonics + 1)[:, None] * stations) * weights
    parts = np.einsum("hs,nkmsa->nkmha", sines, modes.cable_motion(stations), optimize=True)
    along = _chord_axes(point)
    parts -= np.einsum("nkmha,nma,nmb->nkmhb", parts, along, along, optimize=True)
    states = point.cables
    heavy = np.sqrt(2.0 * np.broadcast_to(point.arrays.linear_density, states.length.shape) * states.length)
    shapes = np.zeros((n, count, shape_size(m, harmonics)))
    shapes[..., :_RIGID] = moved @ np.linalg.cholesky(mass)
    shapes[..., _RIGID:] = (parts * heavy[:, None, :, None, None]).reshape(n, count, -1)
    return shapes


def _chord_axes(point: OperatingPoint) -> np.ndarray:
    """(n, m, 3) unit vectors along the cables' tensions at mid-cable, world axes."""
    states = point.cables
    cables = HangingCables.of(states, point.arrays.linear_density)
    cos, sin = (part.T for part in cables.direction)
    return np.asarray(cos[..., None] * states.heading + sin[..., None] * states.up)
