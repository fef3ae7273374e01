"""Bodies that hang on two or three parallel cables: textbook frequencies of massless cables that do not stretch."""

from collections.abc import Callable
from functools import cache

import numpy as np
from scipy.linalg import eigh

import cdpr_struct as cs
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from tests.published.case import Case

GRAVITY, MASS, DROP, RADIUS = 9.81, 20.0, 2.0, 0.4
INERTIA = (0.9, 1.1, 1.6)
BELOW = 0.25  # of the centre of mass under the anchors of the bifilar pendulum [m]
MASSLESS = "cables of 1e-6 kg/m and EA = 1e9 N against none and infinite"


def hanging(angles: np.ndarray, center: float) -> Robot:
    """A body on vertical cables of DROP metres, at `angles` on a circle of RADIUS about its vertical axis."""
    anchors = RADIUS * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    return Robot(
        "on parallel cables",
        Platform(MASS, np.array([0.0, 0.0, center]), np.diag(INERTIA)),
        (Cable(1e9, 1e-6),) * len(angles),
        anchors,
        anchors + np.array([0.0, 0.0, DROP]),
        gravity=GRAVITY,
        home=Pose(np.zeros(3), np.zeros(3)),
    )


TRIFILAR = hanging(2.0 * np.pi / 3.0 * np.arange(3), 0.0)
BIFILAR = hanging(np.pi * np.arange(2), -BELOW)


@cache
def frequencies(robot: Robot, model: str) -> np.ndarray:
    """The lowest four frequencies [Hz] where the body hangs."""
    return cs.modes(robot, model=model, count=4, elements=8).modes.hertz


def nearest(robot: Robot, model: str, told: float) -> Callable[[], float]:
    """The frequency next to the one told."""
    return lambda: float(min(frequencies(robot, model), key=lambda hertz: abs(hertz - told)))


def pendulum_case(robot: Robot, title: str, quantity: str, omega_squared: float) -> Case:
    """One textbook frequency."""
    told = float(np.sqrt(omega_squared)) / (2.0 * np.pi)
    model, referee = nearest(robot, "exact", told), nearest(robot, "fem", told)
    return Case(title, "textbook", quantity, "Hz", told, 1e-5, MASSLESS, model, referee)


def double_pendulum() -> np.ndarray:
    """omega^2 (2,) of a body with its centre of mass BELOW links of DROP metres, both swinging."""
    mass = np.array([[MASS * DROP**2, MASS * DROP * BELOW], [MASS * DROP * BELOW, MASS * BELOW**2 + INERTIA[0]]])
    return np.asarray(eigh(np.diag([MASS * GRAVITY * DROP, MASS * GRAVITY * BELOW]), mass, eigvals_only=True))


SLOW, FAST = double_pendulum()
TWIST = MASS * GRAVITY * RADIUS**2 / (INERTIA[2] * DROP)
CASES = (
    pendulum_case(TRIFILAR, "trifilar pendulum", "twist", TWIST),
    pendulum_case(TRIFILAR, "trifilar pendulum", "swing", GRAVITY / DROP),
    pendulum_case(BIFILAR, "bifilar pendulum", "twist", TWIST),
    pendulum_case(BIFILAR, "bifilar pendulum", "swing along its anchors", GRAVITY / DROP),
    pendulum_case(BIFILAR, "bifilar double pendulum", "across, slow", SLOW),
    pendulum_case(BIFILAR, "bifilar double pendulum", "across, fast", FAST),
)
