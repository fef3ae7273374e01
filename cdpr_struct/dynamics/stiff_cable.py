"""How bending stiffness and a mass at mid-cable change the natural frequencies of a taut cable clamped at both ends."""

import numpy as np


def slenderness(bending_stiffness: np.ndarray, tension: np.ndarray, chord: np.ndarray) -> np.ndarray:
    """sqrt(EI / tau) / l [-]: how far a clamped end reaches into the cable, over its chord."""
    return np.sqrt(np.maximum(bending_stiffness, 0.0) / tension) / chord


def bending_factor(slender: np.ndarray, half_waves: np.ndarray | int) -> np.ndarray:
    """Frequency over that of the flexible cable, to second order in the slenderness [-]."""
    return 1.0 + 2.0 * slender + (4.0 + 0.5 * (half_waves * np.pi) ** 2) * slender**2


def load_factor(added_mass: np.ndarray, cable_mass: np.ndarray, half_waves: np.ndarray | int) -> np.ndarray:
    """Modal mass with a mass at mid-cable over that without [-]; frequencies go with its inverse root."""
    middle = np.sin(0.5 * half_waves * np.pi) ** 2
    return np.maximum(1.0 + 2.0 * added_mass * middle / cable_mass, 0.1)
