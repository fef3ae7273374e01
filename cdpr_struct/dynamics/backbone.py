"""Backbone curves: the frequency of each platform mode over its amplitude.

A mode of any cable model is followed to large amplitude where it is one of the platform on quasi-static cables, and
takes over the share by which that one shifts. Modes in which cables vibrate have no such partner and are left out.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.large_motion import LargeMotion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import ConvergenceError

_OF_PLATFORM = 0.8  # share of the kinetic energy from which a mode counts as the platform's
_SAME_SHAPE = 0.9  # modal assurance criterion, by the mass of platform and cables' shares
_FAST = 3.0  # times its frequency: slower cables answer the harmonics of a large motion by vibrating


@dataclass(frozen=True, slots=True, eq=False)
class BackboneCurves:
    """Of n platform modes at a amplitudes.

    modes : (n,) numbers in the list they come from, from 0
    amplitudes : (a,) of the fundamental, at the cables' platform end that moves most [m]
    hertz : (n, a) [Hz], nan where no periodic motion was found;  slack : (n, a) bool, a cable's tension falls
        below its weight on the way, where few harmonics are not enough
    ringing : (n,) bool, the lowest string frequency of the cables is below three times that of the mode
    """

    modes: np.ndarray
    amplitudes: np.ndarray
    hertz: np.ndarray
    slack: np.ndarray
    ringing: np.ndarray


def backbone_curves(
    point: OperatingPoint, hertz: np.ndarray, platform: np.ndarray, energy: np.ndarray, amplitudes: np.ndarray
) -> BackboneCurves:
    """Curves of those of k modes that are the platform's.

    Parameters
    ----------
    hertz : (k,) of small motion [Hz];  platform : (k, 6) motion of origin and rotation, world axes, any size
    energy : (k,) the platform's share of the kinetic energy

    Raises
    ------
    CdprError : the robot has something that large motion does not know.
    """
    motion = LargeMotion.about(point)
    pairs = platform_partners(motion, platform, energy)
    found, slack = np.full((len(pairs), len(amplitudes)), np.nan), np.zeros((len(pairs), len(amplitudes)), dtype=bool)
    for row, (mode, own) in enumerate(pairs):
        for column, amplitude in enumerate(amplitudes):
            try:
                swing = motion.swing([own], [amplitude])
            except ConvergenceError:
                continue
            found[row, column] = hertz[mode] * swing.omega[0] / motion.omega[own]
            u, _, _ = swing.harmonics.motion(swing.coefficients, swing.omega)
            cables = motion.at(u).cables
            slack[row, column] = bool((cables.tension_at_platform <= cables.weight * cables.length).any())
    modes = np.array([mode for mode, _ in pairs], dtype=int)
    ringing = _FAST * np.asarray(hertz)[modes] > _lowest_string(point)
    return BackboneCurves(modes, np.asarray(amplitudes, dtype=float), found, slack, ringing)


def platform_partners(motion: LargeMotion, platform: np.ndarray, energy: np.ndarray) -> list[tuple[int, int]]:
    """Of k modes those that are the platform's, each with its number among those of the large motion.

    platform : (k, 6) motion of origin and rotation, world axes, any size;  energy : (k,) the platform's share
    """
    parts = (platform @ np.linalg.inv(motion.shapes).T) ** 2
    share = parts / np.maximum(parts.sum(axis=1, keepdims=True), 1e-300)
    own = share.argmax(axis=1)
    same = (share.max(axis=1) >= _SAME_SHAPE) & (np.asarray(energy) >= _OF_PLATFORM)
    return [(int(k), int(own[k])) for k in np.flatnonzero(same)]


def _lowest_string(point: OperatingPoint) -> float:
    """Lowest first frequency of the cables as strings held at both ends [Hz]; infinite without mass."""
    density, cables = point.arrays.linear_density, point.cables
    heavy = density > 0.0
    tension = np.minimum(cables.tension_at_platform, cables.tension_at_frame)
    speed = np.sqrt(tension / np.where(heavy, density, 1.0))
    return float(np.where(heavy, speed / (2.0 * cables.length), np.inf).min())
