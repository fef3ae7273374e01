"""A linear cable as static shapes of its moving end plus modes of the clamped cable.

In these coordinates the robot's eigenproblem is an ordinary matrix one: nothing becomes infinite at a clamped
frequency, so mode shapes are found there too.
"""

from dataclasses import dataclass, fields, replace
from typing import Protocol

import numpy as np

_STATIONS = np.linspace(0.0, 1.0, 33)[1:-1]  # odd and many: along them a mode's direction is judged


class Shapes(Protocol):
    """Static shapes (..., m, s, 3, 3) [motion component, end component] and modes (..., m, p, s, 3) [kg^(-1/2)].

    stations : (s,) in (0, 1), fractions of the unstrained cable from the frame; or (n, s), those of each of the n
        cables of a whole batch
    derivative : 0, 1 or 2 times by that fraction
    """

    def __call__(self, stations: np.ndarray, derivative: int = 0) -> tuple[np.ndarray, np.ndarray]: ...


@dataclass(frozen=True, slots=True, eq=False)
class ModalExpansion:
    """m cables with p clamped modes of unit modal mass each, in local axes; leading axes (...) are a batch of poses.

    frame            : (..., m, 3, 3) local axes as columns in the world
    static_stiffness : (..., m, 3, 3) of the moving end [N/m]
    end_mass         : (..., m, 3, 3) mass of the static shapes [kg]
    omega_squared    : (..., m, p) of the clamped cable [rad^2/s^2]
    coupling         : (..., m, p, 3) mass coupling of modes and end [kg^(1/2)]
    rigid_mass       : (..., m, 3, 3) of the cable moved as a whole with its mast [kg]
    rigid_end        : (..., m, 3, 3) mass coupling of static shapes (rows) and that motion [kg]
    rigid_modes      : (..., m, p, 3) mass coupling of modes and that motion [kg^(1/2)]
    shapes           : of the cables, see `Shapes`
    """

    frame: np.ndarray
    static_stiffness: np.ndarray
    end_mass: np.ndarray
    omega_squared: np.ndarray
    coupling: np.ndarray
    rigid_mass: np.ndarray
    rigid_end: np.ndarray
    rigid_modes: np.ndarray
    shapes: Shapes

    def stiffness(self, omega_squared: np.ndarray) -> np.ndarray:
        """Dynamic stiffness of the moving ends, (..., m, 3, 3), world axes [N/m].

        K(omega) = K(0) - omega^2 M - sum_j omega^4 / (omega_j^2 - omega^2) l_j l_j^T

        omega_squared : broadcasts against (..., m) [rad^2/s^2], may be complex. Exactly at a clamped frequency the
        stiffness is that just below it.
        """
        return self._dynamic(omega_squared, self.static_stiffness, self.end_mass, (self.coupling, self.coupling))

    def mast_stiffness(self, omega_squared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What the cables' inertia adds if their masts move too: two (..., m, 3, 3), world axes [N/m].

        Rows: moving ends against their masts (first) and masts (second); columns: masts.
        """
        nothing = np.zeros_like(self.static_stiffness)
        ends = self._dynamic(omega_squared, nothing, self.rigid_end, (self.coupling, self.rigid_modes))
        own = self._dynamic(omega_squared, nothing, self.rigid_mass, (self.rigid_modes, self.rigid_modes))
        return ends, own

    def _dynamic(
        self, omega_squared: np.ndarray, static: np.ndarray, mass: np.ndarray, modal: tuple[np.ndarray, np.ndarray]
    ) -> np.ndarray:
        squared = np.asarray(omega_squared)[..., None]
        gap = self.omega_squared - squared
        gain = squared**2 / np.where(gap == 0.0, np.finfo(float).eps * self.omega_squared, gap)
        outer = (modal[0][..., :, None] * modal[1][..., None, :]).reshape((*self.omega_squared.shape, 9))
        sums = (gain[..., None, :] @ outer)[..., 0, :]
        local = static - squared[..., None] * mass - sums.reshape((*sums.shape[:-1], 3, 3))
        return np.asarray(self.frame @ local @ np.swapaxes(self.frame, -1, -2))

    @property
    def sideways(self) -> np.ndarray:
        """(..., m, p) whether a mode moves mostly out of the cable's plane, along the second local axis."""
        energy = (self.shapes(_STATIONS)[1] ** 2).sum(axis=-2)
        return np.asarray(energy[..., 1] > 0.5 * energy.sum(axis=-1))

    def ascending(self) -> "ModalExpansion":
        """The same expansion with each cable's modes in the order of frequency, which `reduced` needs."""
        rank = np.argsort(self.omega_squared, axis=-1)

        def shapes(stations: np.ndarray, derivative: int = 0) -> tuple[np.ndarray, np.ndarray]:
            static, modes = self.shapes(stations, derivative)
            return static, np.take_along_axis(modes, rank[..., None, None], axis=-3)

        return replace(
            self,
            omega_squared=np.take_along_axis(self.omega_squared, rank, axis=-1),
            coupling=np.take_along_axis(self.coupling, rank[..., None], axis=-2),
            rigid_modes=np.take_along_axis(self.rigid_modes, rank[..., None], axis=-2),
            shapes=shapes,
        )

    def reduced(self, highest: float, factor: float = 2.0) -> "ModalExpansion":
        """The same cables with fewer modes, for motion up to `highest` [rad/s].

        Modes above `factor` times that are replaced by six Ritz vectors a cable that answer the moving end alike in
        their first four moments (two steps of block Lanczos). Measured error of the stiffness up to `highest`: below
        1e-9 for factor 2.
        """
        keep = int((self.omega_squared < (factor * highest) ** 2).sum(axis=-1).max())
        if self.omega_squared.shape[-1] - keep <= 6:
            return self
        slow, fast = self.omega_squared[..., :keep], self.omega_squared[..., keep:]
        vectors, squared = _tail_vectors(fast, self.coupling[..., keep:, :])
        tail = np.swapaxes(vectors, -1, -2)

        def shapes(stations: np.ndarray, derivative: int = 0) -> tuple[np.ndarray, np.ndarray]:
            static, modes = self.shapes(stations, derivative)
            condensed = np.einsum("...kp,...psa->...ksa", tail, modes[..., keep:, :, :], optimize=True)
            return static, np.concatenate([modes[..., :keep, :, :], condensed], axis=-3)

        return replace(
            self,
            omega_squared=np.concatenate([slow, squared], axis=-1),
            coupling=np.concatenate([self.coupling[..., :keep, :], tail @ self.coupling[..., keep:, :]], axis=-2),
            rigid_modes=np.concatenate(
                [self.rigid_modes[..., :keep, :], tail @ self.rigid_modes[..., keep:, :]], axis=-2
            ),
            shapes=shapes,
        )

    def reshaped(self, shape: tuple[int, ...]) -> "ModalExpansion":
        """The same cables with their one axis m unfolded to `shape` (..., m)."""

        def unfold(value: np.ndarray) -> np.ndarray:
            return value.reshape(shape + value.shape[1:])

        def shapes(stations: np.ndarray, derivative: int = 0) -> tuple[np.ndarray, np.ndarray]:
            static, modes = self.shapes(stations, derivative)
            return unfold(static), unfold(modes)

        arrays = [f.name for f in fields(self) if f.name != "shapes"]
        return ModalExpansion(**{name: unfold(getattr(self, name)) for name in arrays}, shapes=shapes)

    def motion(self, stations: np.ndarray, end: np.ndarray, modal: np.ndarray, mast: np.ndarray) -> np.ndarray:
        """Motion along the cables, (..., k, m, s, 3), world axes.

        Parameters
        ----------
        end : (..., k, m, 3) displacement of the moving end against the mast, local axes
        modal : (..., k, m, p) modal coordinates
        mast : (..., k, m, 3) displacement of the mast, local axes
        """
        static, modes = self.shapes(stations)
        local = np.einsum("...mscb,...kmb->...kmsc", static, end, optimize=True)
        local += np.einsum("...mpsc,...kmp->...kmsc", modes, modal, optimize=True) + mast[..., None, :]
        return np.einsum("...mac,...kmsc->...kmsa", self.frame, local, optimize=True)

    def kinetic_energy(self, end: np.ndarray, modal: np.ndarray, mast: np.ndarray) -> np.ndarray:
        """(..., k, m) twice the kinetic energy at unit frequency: displacement^T mass displacement of each cable."""
        own = np.einsum("...kma,...mab,...kmb->...km", end, self.end_mass, end, optimize=True)
        cross = np.einsum("...kmp,...mpa,...kma->...km", modal, self.coupling, end, optimize=True)
        own += np.einsum("...kma,...mab,...kmb->...km", mast, self.rigid_mass, mast, optimize=True)
        cross += np.einsum("...kma,...mab,...kmb->...km", end, self.rigid_end, mast, optimize=True)
        cross += np.einsum("...kmp,...mpa,...kma->...km", modal, self.rigid_modes, mast, optimize=True)
        return own + (modal**2).sum(-1) + 2.0 * cross


def _tail_vectors(omega_squared: np.ndarray, coupling: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ritz vectors (..., p, 6) of unit modal mass of the modes that the moving end excites; omega^2 (..., 6)."""
    root = np.sqrt(omega_squared)[..., None]
    first, _ = np.linalg.qr(coupling / root)
    image = first / omega_squared[..., None]
    own = np.swapaxes(first, -1, -2) @ image
    second, _ = np.linalg.qr(image - first @ own)
    basis, _ = np.linalg.qr(np.concatenate([first, second], axis=-1))
    periods, turn = np.linalg.eigh(np.swapaxes(basis, -1, -2) @ (basis / omega_squared[..., None]))
    return basis @ turn / root / np.sqrt(periods)[..., None, :], 1.0 / periods
