"""A linear cable as static shapes of its moving end plus modes of the clamped cable.

In these coordinates the robot's eigenproblem is an ordinary matrix one: nothing becomes infinite at a clamped
frequency, so mode shapes are found there too.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Shapes = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True, slots=True, eq=False)
class ModalExpansion:
    """m cables with p clamped modes of unit modal mass each, in local axes.

    frame            : (m, 3, 3) local axes as columns in the world
    static_stiffness : (m, 3, 3) of the moving end [N/m]
    end_mass         : (m, 3, 3) mass of the static shapes [kg]
    omega_squared    : (m, p) of the clamped cable [rad^2/s^2]
    coupling         : (m, p, 3) mass coupling of modes and end [kg^(1/2)]
    shapes           : stations (s,) in (0, 1), fractions of the cable from the frame -> static shapes (m, s, 3, 3)
                       [motion component, end component] and modes (m, p, s, 3) [kg^(-1/2)]
    """

    frame: np.ndarray
    static_stiffness: np.ndarray
    end_mass: np.ndarray
    omega_squared: np.ndarray
    coupling: np.ndarray
    shapes: Shapes

    def stiffness(self, omega_squared: np.ndarray) -> np.ndarray:
        """Dynamic stiffness of the moving ends, (..., m, 3, 3), world axes [N/m].

        K(omega) = K(0) - omega^2 M - sum_j omega^4 / (omega_j^2 - omega^2) l_j l_j^T

        omega_squared : broadcasts against (..., m) [rad^2/s^2], may be complex. Exactly at a clamped frequency the
        stiffness is that just below it.
        """
        squared = np.asarray(omega_squared)[..., None]
        gap = self.omega_squared - squared
        gain = squared**2 / np.where(gap == 0.0, np.finfo(float).eps * self.omega_squared, gap)
        modal = np.einsum("...mp,mpa,mpb->...mab", gain, self.coupling, self.coupling, optimize=True)
        local = self.static_stiffness - squared[..., None] * self.end_mass - modal
        return self.frame @ local @ np.swapaxes(self.frame, -1, -2)

    def motion(self, stations: np.ndarray, end: np.ndarray, modal: np.ndarray) -> np.ndarray:
        """Motion along the cables, (k, m, s, 3), world axes.

        Parameters
        ----------
        end : (k, m, 3) displacement of the moving end, local axes
        modal : (k, m, p) modal coordinates
        """
        static_shapes, modes = self.shapes(stations)
        local = np.einsum("mscb,kmb->kmsc", static_shapes, end) + np.einsum("mpsc,kmp->kmsc", modes, modal)
        return np.einsum("mac,kmsc->kmsa", self.frame, local)

    def kinetic_energy(self, end: np.ndarray, modal: np.ndarray) -> np.ndarray:
        """(k, m) twice the kinetic energy at unit frequency: displacement^T mass displacement of each cable."""
        own = np.einsum("kma,mab,kmb->km", end, self.end_mass, end)
        return own + (modal**2).sum(-1) + 2.0 * np.einsum("kmp,mpa,kma->km", modal, self.coupling, end)
