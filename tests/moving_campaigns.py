"""SIMULATED recordings of a moving platform on four cables: where the finite-element model rests at paid-out lengths.

A suspended platform of 4.4 kg follows a curve of metres at up to a metre a second, filmed four times a second. The
measured robot is off within the tolerances that the campaign states. What else is wrong is drawn from outside.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.spatial.transform import Rotation

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.measurement.campaign import Campaign, States
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.tolerances import Tolerances
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.laws.written_campaigns import NO_CABLES, NO_PEAKS

STEP = 0.25  # s between frames
ANCHOR, ZERO = 0.003, 0.003  # m, tolerances
POSITION, ROTATION, LENGTH = 1e-3, 2e-3, 1e-3  # m, rad, m: sigmas
ELEMENTS = 10  # bars a cable
Error = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Error of the encoders (F, m) [m] at positions (F, 3) and rates (F, m) [m/s]."""


def robot() -> Robot:
    """Four cables above a square platform."""
    corner = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    frame = corner * [2.2, 6.5, 0.0] + [0.3, -1.8, 8.4]
    platform = Platform(4.4, np.array([0.0, 0.0, -0.12]), 0.1 * np.eye(3))
    return Robot("four", platform, (Cable(1e5, 0.01055),) * 4, corner * 0.21 - [0.0, 0.0, 0.011], frame)


def path(time: np.ndarray) -> np.ndarray:
    """(F, 3) where the platform is sent [m]."""
    waves = np.stack([0.3 * np.sin(0.55 * time), 1.6 * np.sin(0.31 * time + 0.4), 1.1 * np.sin(0.43 * time)], axis=1)
    return np.asarray(waves + np.array([0.35, -2.2, 3.6]))


def paid_out(time: np.ndarray) -> np.ndarray:
    """(F, m) lengths that the winches have paid out [m]: what the entered robot asks for."""
    return inverse(robot(), path(time), np.broadcast_to(np.eye(3), (len(time), 3, 3)), allow_unheld=True).lengths


@cache
def rests(seed: int, frames: int, anchors: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions (F, 3) [m] and rotations (F, 3, 3) at which the measured robot rests, its frame anchors off [m]."""
    noise, entered, time = np.random.default_rng(seed), robot(), STEP * np.arange(frames)
    off = [noise.normal(0.0, anchors, entered.frame_anchors.shape), noise.normal(0.0, ANCHOR, (4, 3))]
    real = replace(
        entered, frame_anchors=entered.frame_anchors + off[0], platform_anchors=entered.platform_anchors + off[1]
    )
    found = [
        fem.solve_robot(to_fem(real, own), place, np.eye(3), ELEMENTS)
        for own, place in zip(paid_out(time), path(time), strict=True)
    ]
    return np.array([rest.position for rest in found]), np.array([rest.rotation for rest in found])


def filmed(
    seed: int, frames: int = 160, delay: float = 0.0, error: Error | None = None, anchors: float = ANCHOR,
    still: int = 0,
) -> Campaign:  # fmt: skip
    """A recording whose lengths are older than the poses by a delay [s], with an error of the encoders besides.

    still : frames at the start in which the platform hangs where it begins
    """
    time = STEP * np.arange(frames)
    clock = np.maximum(time - STEP * still, 0.0)
    position, rotation = (part[np.maximum(np.arange(frames) - still, 0)] for part in rests(seed, frames, anchors))
    noise = np.random.default_rng([seed, frames])
    length = paid_out(np.maximum(clock - delay, 0.0) if still else clock - delay)
    if error is not None:
        length = length + error(position, np.gradient(paid_out(clock), STEP, axis=0))
    length = length + noise.normal(0.0, ZERO, 4)
    turned = Rotation.from_rotvec(noise.normal(0.0, ROTATION, (frames, 3))) * Rotation.from_matrix(rotation)
    blank, full = np.full((frames, 4), np.nan), np.full(frames, np.nan)
    states = States(
        names=tuple(f"frame {k}" for k in range(frames)),
        position=position + noise.normal(0.0, POSITION, position.shape), angles=turned.as_euler("xyz"),
        sigma_position=np.full(frames, POSITION), sigma_rotation=np.full(frames, ROTATION), payload=np.zeros(frames),
        tension=blank, tension_sigma=blank, length=length + noise.normal(0.0, LENGTH, length.shape),
        length_sigma=np.full((frames, 4), LENGTH), lock=np.arange(frames), loaded=np.zeros(frames, dtype=bool),
        static=np.ones(frames, dtype=bool), temperature=full, approach=blank, time=time,
    )  # fmt: skip
    tolerances = Tolerances(anchor_m=ANCHOR, length_m=ZERO)
    return Campaign("filmed", robot(), "four", "static", tolerances, frozenset(), states, NO_CABLES, NO_PEAKS)


def of_the_place(seed: int, size: float) -> Error:
    """A smooth error of each encoder over the place, of a size [m] rms: waves of 2 to 5 m in random directions."""
    draw = np.random.default_rng([seed, 7])
    waves, phase = draw.normal(0.0, 1.0, (4, 3, 3)), draw.uniform(0.0, 2.0 * np.pi, (4, 3))

    def error(position: np.ndarray, rate: np.ndarray) -> np.ndarray:
        found = np.sin(np.einsum("fx,mwx->fmw", position - position.mean(axis=0), waves) + phase).sum(axis=-1)
        return np.asarray(size * found / np.sqrt(np.mean((found - found.mean(axis=0)) ** 2)))

    return error
