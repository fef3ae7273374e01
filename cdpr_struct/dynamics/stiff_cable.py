"""How bending stiffness and a mass on it change the natural frequencies of a taut cable between held ends."""

import numpy as np


def slenderness(bending_stiffness: np.ndarray, tension: np.ndarray, chord: np.ndarray) -> np.ndarray:
    """sqrt(EI / tau) / l [-]: how far a clamped end reaches into the cable, over its chord."""
    return np.sqrt(np.maximum(bending_stiffness, 0.0) / tension) / chord


def shortening(slender: np.ndarray, fixity: np.ndarray | float = 1.0) -> np.ndarray:
    """By how much two ends that reach into the cable raise its frequencies, to second order, relative [-].

    fixity : 0 for pinned ends, 1 for clamped ones; of springs k against turning, k / (k + sqrt(EI tau))
    """
    ends = 2.0 * fixity * slender
    return np.asarray(ends + ends**2)


def bending_factor(slender: np.ndarray, half_waves: np.ndarray | int, fixity: np.ndarray | float = 1.0) -> np.ndarray:
    """Frequency over that of the flexible cable, to second order in the slenderness [-]; fixity as in `shortening`."""
    return np.asarray(1.0 + shortening(slender, fixity) + 0.5 * (half_waves * np.pi) ** 2 * slender**2)


def load_factor(
    added_mass: np.ndarray, cable_mass: np.ndarray, half_waves: np.ndarray | int, place: np.ndarray | float = 0.5
) -> np.ndarray:
    """Modal mass with a mass at a share `place` of the cable over that without [-]; frequencies go with its inverse
    root."""
    moved = np.sin(place * half_waves * np.pi) ** 2
    return np.maximum(1.0 + 2.0 * added_mass * moved / cable_mass, 0.1)
