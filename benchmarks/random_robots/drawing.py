"""Robots and poses drawn from a seed: kinds of robots, 3 to 16 cables, 1 m to 1 km, gravity or none, or altered."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.random_robots.altering import ALTERATIONS, altered
from benchmarks.random_robots.case import GRAVITY, Case
from cdpr_struct import Cable, Platform, Pose, Robot

_WEIGHTLESS = 0.08  # share of robots without gravity
_LEVEL = 0.35  # share of poses that are not turned
CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


@dataclass(frozen=True, slots=True, eq=False)
class _Anchors:
    """Platform (m, 3) and frame (m, 3) anchors, middle (3,) and half widths (3,) of where poses lie [m]."""

    platform: np.ndarray
    frame: np.ndarray
    middle: np.ndarray
    half: np.ndarray
    hanging: bool
    guided: tuple[str, ...] = ()


def drawn(seed: int) -> Case:
    """The case of a seed: of half of them as the first study drew it, of the others altered."""
    return altered(plain(seed))


def plain(seed: int) -> Case:
    """The case of a seed as the first study drew it."""
    rng = np.random.default_rng(seed)
    kind = str(rng.choice(list(_KINDS), p=[0.3, 0.25, 0.2, 0.125, 0.125]))
    size = 10.0 ** rng.uniform(0.0, 3.0)
    wide = size * 10.0 ** rng.uniform(-2.0, -0.5)
    anchors = _KINDS[kind](rng, size, wide)
    gravity = 0.0 if rng.random() < _WEIGHTLESS else GRAVITY
    pose = _pose(rng, kind, anchors)
    start = _nearby(rng, pose, anchors, wide) if rng.random() < 0.3 else None
    home = pose if rng.random() < 0.5 else _nearby(rng, pose, anchors, wide)
    robot = _robot(rng, kind, anchors, (size, wide, gravity), home)
    return Case(seed, kind, robot, pose, _free(rng, anchors) if gravity else None, start)


def _pose(rng: np.random.Generator, kind: str, anchors: _Anchors) -> Pose:
    share = rng.uniform(-1.0, 1.0, 3)
    level = _LEVEL
    if kind == "symmetric":  # on the axis, in a plane of symmetry, or anywhere
        share[: int(rng.choice([2, 1, 0], p=[0.5, 0.3, 0.2]))] = 0.0
        level = 0.8
    angles = np.zeros(3) if rng.random() < level else np.radians(rng.uniform(-15.0, 15.0, 3))
    if anchors.guided:
        angles *= [0.0, 1.0, 0.0]
    return Pose(anchors.middle + share * anchors.half, angles)


def _nearby(rng: np.random.Generator, pose: Pose, anchors: _Anchors, wide: float) -> Pose:
    moved, turned = rng.uniform(-1.0, 1.0, (2, 3))
    if anchors.guided:
        return Pose(pose.position + wide * moved * [1.0, 0.0, 1.0], pose.angles + 0.1 * turned * [0.0, 1.0, 0.0])
    return Pose(pose.position + wide * moved, pose.angles + 0.1 * turned)


def _robot(
    rng: np.random.Generator, kind: str, anchors: _Anchors, sizes: tuple[float, float, float], home: Pose
) -> Robot:
    size, wide, gravity = sizes
    mass = size * 10.0 ** rng.uniform(-0.5, 2.5)
    load = mass * GRAVITY
    stiff, weight = load * 10.0 ** rng.uniform(2.0, 4.0), load * 10.0 ** rng.uniform(-4.0, -0.3)
    low = 0.0 if anchors.hanging else load * 10.0 ** rng.uniform(-1.5, 0.0)
    high = np.inf if rng.random() < 0.6 else max(load, low) * 10.0 ** rng.uniform(0.3, 2.0)
    alike = kind == "symmetric" or rng.random() < 0.5
    factors = np.ones((2, len(anchors.frame))) if alike else 2.0 ** rng.uniform(-1.0, 1.0, (2, len(anchors.frame)))
    axes = wide * rng.uniform(0.4, 1.2, 3)
    center = wide * rng.uniform(-0.3, 0.3, 3) * (0.0 if rng.random() < 0.3 else 1.0)
    center = center * [0.0, 0.0, 1.0] if kind in ("symmetric", "one-point") and rng.random() < 0.7 else center
    center = center * [1.0, 0.0, 1.0] if anchors.guided else center
    return Robot(
        name=f"random {kind}",
        platform=Platform(mass, center, mass / 5.0 * np.diag((axes**2).sum() - axes**2)),
        cables=tuple(
            Cable(stiff * a, weight * b / (GRAVITY * size), force_min=low, force_max=high) for a, b in factors.T
        ),
        platform_anchors=anchors.platform,
        frame_anchors=anchors.frame,
        gravity=gravity,
        home=home,
        guided=anchors.guided,
    )


def _free(rng: np.random.Generator, anchors: _Anchors) -> str | None:
    """Angles left free: of hanging platforms, most often."""
    if not anchors.hanging or rng.random() < 0.2:
        return None
    if anchors.guided:
        return None
    return str(rng.choice(["rx,ry,rz", "rx,ry", "ry", "rx,rz"], p=[0.5, 0.3, 0.1, 0.1]))


def _ring(count: int, radius: float, height: float = 0.0, turn: float = 0.0) -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(count) / count + turn
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)], axis=1)


def _hanging(rng: np.random.Generator, size: float, wide: float) -> _Anchors:
    count, height = int(rng.integers(3, 9)), size * rng.uniform(0.3, 1.0)
    around = 2.0 * np.pi * (np.arange(count) + rng.uniform(-0.3, 0.3, count)) / count
    half = size * rng.uniform(0.3, 0.6, 2)
    frame = np.stack([half[0] * np.cos(around), half[1] * np.sin(around), np.full(count, height)], axis=1)
    frame[:, 2] += 0.05 * size * rng.uniform(-1.0, 1.0, count)
    inner = around + rng.uniform(0.0, 1.0, count) * np.where(np.arange(count) % 2, 1.0, -1.0)
    own = wide * rng.uniform(0.5, 1.0, 3)
    platform = np.stack([own[0] * np.cos(inner), own[1] * np.sin(inner), own[2] * rng.uniform(-1, 1, count)], axis=1)
    places = np.array([0.0, 0.0, 0.4 * height]), np.array([0.4 * half[0], 0.4 * half[1], 0.3 * height])
    return _Anchors(platform, frame, *places, True)


def _preloaded(rng: np.random.Generator, size: float, wide: float) -> _Anchors:
    above = _hanging(rng, size, wide)
    count = int(rng.integers(7, 17))
    around = 2.0 * np.pi * (np.arange(count) + rng.uniform(-0.3, 0.3, count)) / count
    half, height = size * rng.uniform(0.3, 0.6, 2), size * rng.uniform(0.3, 1.0)
    frame = np.stack([half[0] * np.cos(around), half[1] * np.sin(around), np.full(count, height)], axis=1)
    frame[1::2, 2] = 0.0
    frame += 0.05 * size * rng.uniform(-1.0, 1.0, (count, 3))
    inner = around + rng.uniform(0.3, 1.2, count) * np.where(np.arange(count) // 2 % 2, 1.0, -1.0)
    platform = wide * np.stack([np.cos(inner), np.sin(inner), rng.uniform(-1.0, 1.0, count)], axis=1)
    return _Anchors(platform, frame, np.array([0.0, 0.0, 0.45 * height]), 0.5 * above.half, False)


def _symmetric(rng: np.random.Generator, size: float, wide: float) -> _Anchors:
    """Rings of cables that run to the middle, across, turned, straight up, or from above and below."""
    style = str(rng.choice(["radial", "across", "turned", "vertical", "corners", "crossed", "double"]))
    high = np.array([0.0, 0.0, size])
    if style in ("corners", "crossed"):
        inner = wide * CORNERS * (rng.choice([-1.0, 1.0], 3) if style == "crossed" else 1.0)
        return _Anchors(inner, 0.5 * size * CORNERS, np.zeros(3), np.full(3, 0.2 * size), False)
    if style == "double":
        count, turn = int(rng.integers(3, 9)), rng.uniform(0.0, 1.0)
        inner = np.concatenate([_ring(count, wide, 0.3 * wide), _ring(count, wide, -0.3 * wide, turn)])
        outer = np.concatenate([_ring(count, 0.5 * size, size, turn), _ring(count, 0.5 * size)])
        return _Anchors(inner, outer, 0.5 * high, np.full(3, 0.15 * size), False)
    count = int(rng.integers(3, 17))
    radius = {"radial": wide, "across": -wide, "turned": wide, "vertical": wide}[style]
    inner = _ring(count, radius, 0.0, 0.5 if style == "turned" else 0.0)
    outer = _ring(count, wide if style == "vertical" else 0.5 * size, size)
    half = np.full(3, 0.1 * wide if style == "vertical" else 0.2 * size)
    return _Anchors(inner, outer, 0.5 * high, half, True)


def _one_point(rng: np.random.Generator, size: float, wide: float) -> _Anchors:
    """All cables end in one point of the platform: its origin, one above it, or any."""
    base = _hanging(rng, size, wide) if rng.random() < 0.6 else _preloaded(rng, size, wide)
    point = wide * rng.uniform(-0.5, 0.5, 3) * np.array([[0, 0, 0], [0, 0, 1], [1, 1, 1]])[int(rng.integers(3))]
    return _Anchors(np.tile(point, (len(base.frame), 1)), base.frame, base.middle, base.half, base.hanging)


def _planar(rng: np.random.Generator, size: float, wide: float) -> _Anchors:
    """A platform guided in the plane x, z."""
    base = _hanging(rng, size, wide) if rng.random() < 0.4 else _preloaded(rng, size, wide)
    flat = np.array([1.0, 0.0, 1.0])
    return _Anchors(
        base.platform * flat, base.frame * flat, base.middle * flat, base.half * flat, base.hanging, ("y", "rx", "rz")
    )


_KINDS: dict[str, Callable[[np.random.Generator, float, float], _Anchors]] = {
    "hanging": _hanging,
    "preloaded": _preloaded,
    "symmetric": _symmetric,
    "one-point": _one_point,
    "guided planar": _planar,
}
KINDS = (*_KINDS, *ALTERATIONS)
