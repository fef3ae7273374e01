"""Cables between two points, written down a second time; nothing here is taken from the program.

An elastic catenary of unstrained length L, pulled at its platform end by F = (horizontal, V), weight w per length:

    horizontal: F_h (L / EA + ln[(V + T) / (V_0 + T_0)] / w),   up: (V + V_0) L (1 / (2 EA) + 1 / (T + T_0)),

V_0 = V - w L and T_0 at the frame end. Its compliance is the derivative by F, by steps into the complex plane. Without
weight a cable is a spring that cannot push.

Over a pulley of radius R the cable comes along the axis a through the frame anchor and leaves the groove along its
pull t at the frame end, t = cos(p) a + sin(p) e: at the anchor plus R (1 - cos(p)) e + R sin(p) a, after R p of
stretched cable without weight. What is left of the length hangs; it is found by repetition.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct import Robot

_STEP = 1e-30  # of the largest force, into the complex plane
_ITERATIONS = 30
_REPEATED = 60  # of the length beyond a pulley; it shrinks by R w / T each time


@dataclass(frozen=True, slots=True, eq=False)
class Wheels:
    """Pulleys at the frame ends: radius (m,), 0 for none [m]; axis (m, 3) unit vectors."""

    radius: np.ndarray
    axis: np.ndarray

    @classmethod
    def of(cls, robot: Robot) -> "Wheels | None":
        """Those of a robot, None if it has none."""
        if not any(robot.pulleys):
            return None
        radius = np.array([0.0 if pulley is None else pulley.radius for pulley in robot.pulleys])
        return cls(radius, np.array([[0.0, 0.0, 1.0] if p is None else p.axis for p in robot.pulleys]))

    def left(self, pull: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where cables leave that pull (..., m, 3) at the frame end, from the anchor on (..., m, 3); R p (..., m)."""
        along = pull / np.sqrt((pull**2).sum(axis=-1))[..., None]
        cos = (along * self.axis).sum(axis=-1)
        across = along - cos[..., None] * self.axis
        sin = np.sqrt((across**2).sum(axis=-1) + 1e-300)
        point = (1.0 - cos)[..., None] * across / sin[..., None] + sin[..., None] * self.axis
        back = cos.real < 0.0
        angle = 2.0 * np.arctan(sin / np.where(back, 1.0 - cos, 1.0 + cos))
        return self.radius[:, None] * point, self.radius * np.where(back, np.pi - angle, angle)


def end_offset(
    force: np.ndarray, length: np.ndarray, stiff: np.ndarray, weight: np.ndarray, wheels: Wheels | None = None
) -> np.ndarray:
    """(..., m, 3) platform end minus frame anchor of cables pulled by `force` (..., m, 3) [N] at the platform end."""
    if wheels is None:
        return _hung(force, length, stiff, weight)
    hanging = length + 0.0 * force[..., 2]
    for _ in range(_REPEATED):
        before, frame = hanging, force - (weight * hanging)[..., None] * [0.0, 0.0, 1.0]
        point, arc = wheels.left(frame)
        hanging = length - arc / (1.0 + np.sqrt((frame**2).sum(axis=-1)) / stiff)
        if (np.abs(hanging.real - before.real) <= 1e-15 * length).all() and _still(hanging.imag, before.imag):
            break
    return point + _hung(force, hanging, stiff, weight)


def _still(now: np.ndarray, before: np.ndarray) -> bool:
    return bool((np.abs(now - before) <= 1e-14 * np.abs(now).max()).all())


def _hung(force: np.ndarray, length: np.ndarray, stiff: np.ndarray, weight: np.ndarray) -> np.ndarray:
    across, up = np.sqrt(force[..., 0] ** 2 + force[..., 1] ** 2), force[..., 2]
    at_frame = up - weight * length
    pull, frame_pull = np.sqrt(across**2 + up**2), np.sqrt(across**2 + at_frame**2)
    mean = (up + at_frame) * length / (pull + frame_pull)  # (T - T_0) / w
    rising, falling = at_frame.real >= 0.0, up.real <= 0.0
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # of the branches that are not taken
        grown = np.where(rising, (length + mean) / _nonzero(at_frame + frame_pull), 0.0) * weight
        fallen = np.where(falling, (length - mean) / _nonzero(pull - up), 0.0) * weight
        through = np.arcsinh(up / _nonzero(across)) - np.arcsinh(at_frame / _nonzero(across))
        bend = np.where(rising, np.log1p(grown), np.where(falling, np.log1p(fallen), through)) / weight
    flat = force[..., :2] * (length / stiff + bend)[..., None]
    return np.concatenate([flat, ((up + at_frame) * length / (2.0 * stiff) + mean)[..., None]], axis=-1)


def _nonzero(value: np.ndarray) -> np.ndarray:
    return np.where(value == 0.0, 1e-300, value)


def compliance(
    force: np.ndarray, length: np.ndarray, stiff: np.ndarray, weight: np.ndarray, wheels: Wheels | None = None
) -> np.ndarray:
    """(m, 3, 3) derivative of `end_offset` by the force [m/N]."""
    step = _STEP * np.abs(force).max(axis=1)
    pushed = force[None] + 1j * step[None, :, None] * np.eye(3)[:, None, :]
    return np.moveaxis(end_offset(pushed, length, stiff, weight, wheels).imag / step[None, :, None], 0, -1)


def solved(
    robot: Robot, offset: np.ndarray, length: np.ndarray, pull: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Forces (m, 3) on the cables' platform ends, stiffnesses (m, 3, 3), and the misfit of ends over chords.

    offset : (m, 3) platform ends minus frame anchors [m];  pull : (m, 3) forces from which the search begins [N]
    """
    stiff, weight, wheels = robot.axial_stiffness, robot.weight_per_length, Wheels.of(robot)
    chord = np.linalg.norm(offset, axis=1)
    if robot.gravity == 0.0:
        return *_springs(offset, chord, length, stiff), 0.0
    for _ in range(_ITERATIONS):
        pull = _off_axis(pull)
        left = end_offset(pull, length, stiff, weight, wheels) - offset
        step = np.linalg.solve(compliance(pull, length, stiff, weight, wheels), left[..., None])[..., 0]
        size = np.linalg.norm(pull, axis=1)
        half = 0.5 * size
        pull = pull - step * (half / np.maximum(np.linalg.norm(step, axis=1), half))[:, None]
        if (np.linalg.norm(step, axis=1) <= 1e-13 * size).all():
            break
    pull = _off_axis(pull)
    left = np.linalg.norm(end_offset(pull, length, stiff, weight, wheels) - offset, axis=1) / chord
    return pull, np.linalg.inv(compliance(pull, length, stiff, weight, wheels)), float(left.max())


def _off_axis(pull: np.ndarray) -> np.ndarray:
    """Forces with a trace of horizontal pull where they are vertical: directions then have derivatives."""
    size, across = np.linalg.norm(pull, axis=1), np.linalg.norm(pull[:, :2], axis=1)
    return np.where((across < 1e-12 * size)[:, None], pull + 1e-12 * size[:, None] * [1.0, 0.0, 0.0], pull)


def _springs(
    offset: np.ndarray, chord: np.ndarray, length: np.ndarray, stiff: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    along = offset / chord[:, None]
    strain = chord / length - 1.0
    tension = stiff * np.maximum(strain, 0.0)
    lengthwise = along[:, :, None] * along[:, None, :]
    rate = np.where(strain > 0.0, stiff / length, 0.0)[:, None, None] * lengthwise
    return tension[:, None] * along, rate + (tension / chord)[:, None, None] * (np.eye(3) - lengthwise)
