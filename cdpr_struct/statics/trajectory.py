"""Where the platform is along a path, how it moves there, and which wrench its inertia makes."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import make_interp_spline

from cdpr_struct.errors import CdprError
from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose

SPLINE_DEGREE = 5


class TrajectoryLimitError(CdprError):
    """The trajectory is faster than allowed."""

    def __init__(self, what: str, value: float, limit: float, unit: str, time: float) -> None:
        self.value, self.limit, self.time = value, limit, time
        super().__init__(
            f"{what} reaches {value:.4g} {unit} at t = {time:.4g} s, {value - limit:.4g} {unit} above the limit "
            f"{limit:.4g} {unit}. Give the trajectory more time, or raise the limit."
        )


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Motion of the platform frame at k instants, world axes.

    time                   : (k,) ascending [s]
    position, velocity, acceleration : (k, 3) of the platform origin [m, m/s, m/s^2]
    rotation               : (k, 3, 3) platform to world
    angular_velocity, angular_acceleration : (k, 3) [rad/s, rad/s^2]
    """

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    rotation: np.ndarray
    angular_velocity: np.ndarray
    angular_acceleration: np.ndarray

    def __post_init__(self) -> None:
        for name in self.__slots__:
            if not np.isfinite(getattr(self, name)).all():
                raise ValueError(f"Trajectory.{name} must be finite")
        if not (np.diff(self.time) > 0.0).all():
            raise ValueError("Trajectory.time must ascend")

    def __len__(self) -> int:
        return len(self.time)

    @property
    def speed(self) -> np.ndarray:
        """(k,) of the platform origin [m/s]."""
        return np.linalg.norm(self.velocity, axis=1)

    @property
    def acceleration_size(self) -> np.ndarray:
        """(k,) of the platform origin [m/s^2]."""
        return np.linalg.norm(self.acceleration, axis=1)

    def require_within(self, max_speed: float = np.inf, max_acceleration: float = np.inf) -> None:
        """Check speed [m/s] and acceleration [m/s^2] of the platform origin.

        Raises
        ------
        TrajectoryLimitError : names the instant and the excess.
        """
        for what, values, limit, unit in (
            ("the platform's speed", self.speed, max_speed, "m/s"),
            ("the platform's acceleration", self.acceleration_size, max_acceleration, "m/s^2"),
        ):
            worst = int(values.argmax())
            if values[worst] > limit:
                raise TrajectoryLimitError(what, float(values[worst]), limit, unit, float(self.time[worst]))

    def inertia_wrench(self, platform: Platform) -> np.ndarray:
        """(k, 6) d'Alembert wrench of the platform about its origin, world axes [N, N m]."""
        spin, rotation = self.angular_velocity, self.rotation
        center = rotation @ platform.center_of_mass
        turning = np.cross(self.angular_acceleration, center) + np.cross(spin, np.cross(spin, center))
        force = -platform.mass * (self.acceleration + turning)
        inertia = rotation @ platform.inertia @ np.swapaxes(rotation, -1, -2)
        rate = np.einsum("kij,kj->ki", inertia, self.angular_acceleration)
        rate += np.cross(spin, np.einsum("kij,kj->ki", inertia, spin))
        return np.concatenate([force, np.cross(center, force) - rate], axis=1)


def helix(count: int = 3001, duration: float = 30.0, radius: float = 3.0) -> Trajectory:
    """The thesis's circular helix: two turns and 3 m up, at rest at both ends, eqs (5.17)-(5.20).

    Parameters
    ----------
    count : instants, evenly spaced
    duration, radius : T [s], r [m]
    """
    time = np.linspace(0.0, duration, count)
    share, share_1, share_2 = _quintic(time, duration)
    angle, angle_1, angle_2 = (4.0 * np.pi * s for s in (share, share_1, share_2))
    sin, cos = np.sin(angle), np.cos(angle)
    position = np.stack([radius * cos, radius * sin, 3.0 * share + 1.0], axis=1)
    velocity = np.stack([-radius * sin * angle_1, radius * cos * angle_1, 3.0 * share_1], axis=1)
    acceleration = np.stack(
        [
            -radius * (cos * angle_1**2 + sin * angle_2),
            radius * (cos * angle_2 - sin * angle_1**2),
            3.0 * share_2,
        ],
        axis=1,
    )
    return _moving(time, (position, velocity, acceleration), (np.zeros((count, 3)),) * 3)


def straight_line(start: Pose, end: Pose, duration: float, count: int = 1001) -> Trajectory:
    """From pose to pose on a straight line, angles in proportion, with quintic timing: at rest at both ends.

    Raises
    ------
    ValueError : a duration that is not positive, or fewer than two instants.
    """
    if not (duration > 0.0 and count >= 2):
        raise ValueError(f"duration must be > 0 s with at least 2 instants, got {duration!r} s and {count!r}")
    time = np.linspace(0.0, duration, count)
    parts = [part[:, None] for part in _quintic(time, duration)]
    way, turn = end.position - start.position, end.angles - start.angles
    path = (start.position + parts[0] * way, parts[1] * way, parts[2] * way)
    angles = (start.angles + parts[0] * turn, parts[1] * turn, parts[2] * turn)
    return _moving(time, path, angles)


def through_samples(time: npt.ArrayLike, position: npt.ArrayLike, angles: npt.ArrayLike | None = None) -> Trajectory:
    """Trajectory through sampled poses; rates by a quintic interpolating spline (of lower degree below six samples).

    Parameters
    ----------
    time : (k,) ascending [s]; a single instant is a pose at rest
    position, angles : (k, 3) [m], rx, ry, rz [rad]; jumps of whole turns in the angles are taken out

    Raises
    ------
    ValueError : times that do not ascend, or numbers that are not finite.
    """
    t, place = np.asarray(time, dtype=float), np.asarray(position, dtype=float)
    turn = np.zeros_like(place) if angles is None else np.unwrap(np.asarray(angles, dtype=float), axis=0)
    if not (np.isfinite(t).all() and np.isfinite(place).all() and np.isfinite(turn).all()):
        raise ValueError("time, position and angles must be finite")
    if not (np.diff(t) > 0.0).all():
        raise ValueError("time must ascend")
    return _moving(t, _with_rates(t, place), _with_rates(t, turn))


def turning_by(path: Trajectory, angles: np.ndarray) -> Trajectory:
    """The same way at other orientations: rx, ry, rz (k, 3) [rad] at its instants, with rates by the same spline."""
    whole = np.unwrap(angles, axis=0)
    return _moving(path.time, (path.position, path.velocity, path.acceleration), _with_rates(path.time, whole))


Motion = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Values, first and second time derivatives."""


def _quintic(time: np.ndarray, duration: float) -> Motion:
    """Share of the way done (0..1) with its rates; velocity and acceleration vanish at both ends."""
    s = time / duration
    return (
        s**3 * (10.0 + s * (6.0 * s - 15.0)),
        30.0 * s**2 * (1.0 - s) ** 2 / duration,
        60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / duration**2,
    )


def _with_rates(time: np.ndarray, values: np.ndarray) -> Motion:
    degree = min(SPLINE_DEGREE, len(time) - 1)
    if degree == 0:
        return values, np.zeros_like(values), np.zeros_like(values)
    degree -= 1 - degree % 2  # odd degrees put the knots on the samples
    spline = make_interp_spline(time, values, k=degree)
    second = spline.derivative(2)(time) if degree > 1 else np.zeros_like(values)
    return values, spline.derivative(1)(time), second


def _moving(time: np.ndarray, path: Motion, angles: Motion) -> Trajectory:
    """Trajectory of a position and of the angles rx, ry, rz (k, 3) [rad], each with its rates."""
    turn, rate, second = angles
    rx, ry, rz = turn.T
    zero = np.zeros_like(rx)
    axis_x = rotation_from_angles(zero, ry, rz)[..., :, 0]
    axis_y = np.stack([-np.sin(rz), np.cos(rz), zero], axis=1)
    axis_z = np.broadcast_to([0.0, 0.0, 1.0], axis_y.shape)
    axes = np.stack([axis_x, axis_y, axis_z], axis=2)
    about_z = rate[:, 2:] * axis_z
    axes_rate = np.zeros_like(axes)
    axes_rate[..., 0] = np.cross(about_z + rate[:, 1:2] * axis_y, axis_x)
    axes_rate[..., 1] = np.cross(about_z, axis_y)
    spin = np.einsum("kij,kj->ki", axes, rate)
    spin_rate = np.einsum("kij,kj->ki", axes, second) + np.einsum("kij,kj->ki", axes_rate, rate)
    return Trajectory(time, *path, rotation_from_angles(rx, ry, rz), spin, spin_rate)
