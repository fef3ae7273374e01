"""The platform in large free motion, lengths locked: how its modes change their frequencies with their size.

The platform moves far; the cables follow without vibrating of their own (exact statics at every pose) and add a third
of their mass at their platform ends, as a straight cable does whose motion is linear along its length. A mode changes
its frequency for three reasons, all of them in the balance: the restoring force is not linear, the platform leaves the
straight line of its small motion so that its cables do not stretch, and its inertia turns with it.

Coordinates are modal amplitudes of the small motion, for unit modal mass; their sum is a displacement of the platform
origin and a rotation vector, both from rest, world axes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh

from cdpr_struct.dynamics.harmonic_balance import FreeMotion, free_motion
from cdpr_struct.dynamics.large_rotation import angular_motion, inertia_wrench, turning
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import attachment, platform_mass_matrix, platform_static_stiffness
from cdpr_struct.errors import CdprError
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import (
    PlatformArms,
    cable_wrench,
    cross_product_matrix,
    load_wrench,
    moment_skew,
    platform_radius,
    rotation_from_vector,
    tangent_stiffness,
)
from cdpr_struct.statics.potential_energy import potential_energy

_ORDER = {1: 7, 2: 5}  # highest harmonic for one and two modes
_MANY = 4  # for more
_SMALL = 5e-4  # of the platform's radius: amplitude of the leading shifts, whose stiff directions need it so small
_DIFFERENCE = 1e-5  # step of central differences of the inertia, of the motion's size


@dataclass(frozen=True, slots=True, eq=False)
class PlatformAt:
    """The platform at g displacements from rest: pose, lever arms, cables, and displacement (g, 6) [m, rad]."""

    motion: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    arms: PlatformArms
    cables: CableStates


@dataclass(frozen=True, slots=True, eq=False)
class LargeMotion:
    """A platform on quasi-static cables of locked lengths.

    omega    : (6,) of its small motion, ascending [rad/s]
    shapes   : (6, 6) column k is mode k: motion of the origin and rotation, world axes, unit modal mass
    end_mass : (m,) that the cables add at their platform ends [kg]
    """

    point: OperatingPoint
    omega: np.ndarray
    shapes: np.ndarray
    end_mass: np.ndarray

    @classmethod
    def about(cls, point: OperatingPoint) -> "LargeMotion":
        """About a rest of the robot.

        Raises
        ------
        CdprError : the robot has something that this motion does not know, or is not held in every direction.
        """
        _require_known(point.arrays)
        end_mass, carried = point.arrays.linear_density * point.cables.length / 3.0, attachment(point)
        mass = platform_mass_matrix(point.arrays, point.rotation) + np.einsum(
            "m,mai,maj->ij", end_mass, carried, carried
        )
        squared, shapes = eigh(platform_static_stiffness(point), mass)
        if squared[0] <= 0.0:
            raise CdprError("large motion needs a platform that is held in every direction; this one is not")
        return cls(point, np.sqrt(squared), shapes, end_mass)

    def reach(self, mode: int) -> float:
        """Displacement of the cables' platform end that moves most, for modal amplitude 1 [m]."""
        return float(np.linalg.norm(attachment(self.point) @ self.shapes[:, mode], axis=-1).max())

    def swing(self, modes: Sequence[int], amplitudes: npt.ArrayLike, order: int | None = None) -> FreeMotion:
        """Free motion of modes that swing together, in modal coordinates.

        Parameters
        ----------
        modes : n of 0 to 5
        amplitudes : (n,) of the fundamental of each: displacement of the cables' platform end that moves most [m]
        order : of the harmonics kept; default 7 for one mode, 5 for two, 4 for more

        Raises
        ------
        ConvergenceError : no such motion was found.
        """
        sizes = np.asarray(amplitudes, dtype=float) / [self.reach(mode) for mode in modes]
        return free_motion(self, self.omega, modes, sizes, order or _ORDER.get(len(modes), _MANY))

    def shifts(self, modes: Sequence[int], amplitudes: npt.ArrayLike, order: int | None = None) -> np.ndarray:
        """(n,) by which share modes that swing together change their frequencies; arguments as of `swing`."""
        return np.asarray(self.swing(modes, amplitudes, order).omega / self.omega[list(modes)] - 1.0)

    def leading(self, modes: Sequence[int]) -> np.ndarray:
        """(n, n) by which share mode i shifts per squared amplitude of mode j [1/m^2], while amplitudes are small.

        Amplitudes are those of `swing`. The second harmonics of every two modes are all that this order needs. In modal
        amplitudes omega_i^2 times the matrix is symmetric, as a conservative system demands.

        Raises
        ------
        ConvergenceError : two modes exchange energy.
        """
        size, count = _SMALL * platform_radius(self.point.arrays), len(modes)
        sizes, omega = size / np.array([self.reach(mode) for mode in modes]), self.omega
        found = np.zeros((count, count))
        for i, j in combinations_with_replacement(range(count), 2):
            own = [modes[i]] if i == j else [modes[i], modes[j]]
            swing = free_motion(self, omega, own, sizes[[i]] if i == j else sizes[[i, j]], 2, first=1.0)
            shift = swing.omega / omega[own] - 1.0
            if i == j:
                found[i, i] = shift[0]
            else:
                found[i, j], found[j, i] = shift
        own_share = np.diag(found)[:, None] * (1.0 - np.eye(count))
        return np.asarray((found - own_share) / size**2)

    def at(self, u: np.ndarray) -> PlatformAt:
        """The platform at modal coordinates (g, 6)."""
        motion, rest = u @ self.shapes.T, self.point
        position, rotation = rest.position + motion[:, :3], rotation_from_vector(motion[:, 3:]) @ rest.rotation
        arms = PlatformArms.at(rest.arrays, position, rotation)
        length = np.broadcast_to(rest.cables.total_length, arms.points.shape[:-1])
        return PlatformAt(
            motion, position, rotation, arms, cable_model("sagging").states(rest.arrays, arms.points, length)
        )

    def linearised(
        self, u: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Modal inertia minus modal force (g, 6) and its derivatives (g, 6, 6); for `harmonic_balance`."""
        there, shapes = self.at(u), self.shapes
        motion = (there.motion, velocity @ shapes.T, acceleration @ shapes.T)
        wrench, tangent = _force(self.point.arrays, there)
        rates = [self._inertia_rate(motion, which) for which in range(3)]
        rates[0] += tangent
        by_place, by_speed, by_acceleration = (shapes.T @ rate @ shapes for rate in rates)
        return (self.inertia(*motion) - wrench) @ shapes, by_place, by_speed, by_acceleration

    def energy(self, u: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """(g,) kinetic and potential energy [J]; a constant moment is left out."""
        there, rate, arrays = self.at(u), velocity @ self.shapes.T, self.point.arrays
        spin, _ = angular_motion(there.motion[:, 3:], rate[:, 3:], rate[:, 3:])
        twist = np.concatenate([rate[:, :3], spin], axis=1)
        ends = rate[:, None, :3] + np.cross(spin[:, None], there.arms.arms)
        moving = np.einsum("gi,gij,gj->g", twist, platform_mass_matrix(arrays, there.rotation), twist)
        moving += (self.end_mass * (ends**2).sum(axis=-1)).sum(axis=-1)
        stored = potential_energy(arrays, there.position, there.rotation, there.cables, np.zeros(6))
        return np.asarray(0.5 * moving + stored)

    def inertia(self, motion: np.ndarray, rate: np.ndarray, second: np.ndarray) -> np.ndarray:
        """(g, 6) inertia of platform and cables' shares about the origin, world [N, N m].

        motion : (g, 6) displacement and rotation vector from rest;  rate, second : their derivatives by time
        """
        arrays, angle = self.point.arrays, motion[:, 3:]
        spin, angular = angular_motion(angle, rate[:, 3:], second[:, 3:])
        rotation = rotation_from_vector(angle) @ self.point.rotation
        arms = PlatformArms.at(arrays, motion[:, :3], rotation)
        inertia = rotation @ arrays.inertia @ rotation.swapaxes(-1, -2)
        body = inertia_wrench(arrays.mass, arms.center, inertia, spin, second[:, :3], angular)
        turn = cross_product_matrix(angular) + cross_product_matrix(spin) @ cross_product_matrix(spin)
        force = self.end_mass[:, None] * (second[:, None, :3] + arms.arms @ turn.swapaxes(-1, -2))
        moment = np.cross(arms.arms, force).sum(axis=1)
        return np.asarray(body + np.concatenate([force.sum(axis=1), moment], axis=1))

    def _inertia_rate(self, motion: tuple[np.ndarray, ...], which: int) -> np.ndarray:
        """(g, 6, 6) derivative of the inertia by motion, rate or second, by central differences."""
        step, columns = max(float(np.abs(motion[which]).max()), 1e-3) * _DIFFERENCE, []
        for k in range(6):
            ends = []
            for sign in (1.0, -1.0):
                moved = list(motion)
                moved[which] = motion[which] + sign * step * np.eye(6)[k]
                ends.append(self.inertia(*moved))
            columns.append((ends[0] - ends[1]) / (2.0 * step))
        return np.stack(columns, axis=-1)


def _force(arrays: RobotArrays, there: PlatformAt) -> tuple[np.ndarray, np.ndarray]:
    """Wrench (g, 6) on the platform, and minus its derivative (g, 6, 6) by displacement and rotation vector."""
    tangent = tangent_stiffness(arrays, there.cables, there.arms)
    wrench = cable_wrench(there.cables, there.arms) + load_wrench(arrays, there.arms)
    tangent[:, 3:, 3:] += moment_skew(wrench[:, 3:] - arrays.moment)
    tangent[:, :, 3:] = tangent[:, :, 3:] @ turning(there.motion[:, 3:])
    return np.asarray(wrench), np.asarray(tangent)


def _require_known(arrays: RobotArrays) -> None:
    lacking = {
        "a guided platform": arrays.has_guides,
        "internal_mass": arrays.has_internal_mass,
        "masts that give way": arrays.has_masts,
        "masses on cables": arrays.has_lumps or bool(arrays.added_mass.any()),
        "winches that hold a tension": arrays.has_tension_winches,
        "wind on cables": arrays.has_cable_drag,
    }
    unknown = [what for what, given in lacking.items() if given]
    if unknown:
        raise CdprError(f"large motion cannot be computed with {', '.join(unknown)}: leave it out of the robot file")
