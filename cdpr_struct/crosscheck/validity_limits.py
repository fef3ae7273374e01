"""The thesis's validity limits of the closed-form DSM, per cable (eqs 2.40-2.41, section 2.2.1).

The print of (2.41) has eps <= 0.01 beside d/l_c <= 1/80; since eps = 8 d/l_c that is eps <= 0.1.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.taut_cables import taut_cables

LAMBDA_SQUARED_LIMIT = 24.0
CROSSOVER_DISTANCE = 0.2
SAG_RATIO_LIMIT = 1.0 / 20.0
INCLINATION_EPSILON_PAIRS = ((30.0, 0.24), (60.0, 0.1))


@dataclass(frozen=True, slots=True)
class Violation:
    """One cable parameter outside one printed limit."""

    cable: int
    parameter: str
    value: float
    limit: float


@dataclass(frozen=True, slots=True, eq=False)
class ValidityLimits:
    """Parameters of every cable at one pose, and which printed limits they break.

    lambda_squared, epsilon, sag_ratio : (m,) [-];  inclination_deg : (m,) unsigned;
    crossover_distance : (m,) relative distance to the nearest 4 n^2 pi^2 [-];  violations : may be empty
    """

    lambda_squared: np.ndarray
    epsilon: np.ndarray
    inclination_deg: np.ndarray
    sag_ratio: np.ndarray
    crossover_distance: np.ndarray
    violations: tuple[Violation, ...]


def check_limits(point: OperatingPoint) -> ValidityLimits:
    """Audit of the cables at one pose."""
    cables = taut_cables(point)
    inclination = np.abs(np.degrees(point.cables.inclination))
    sag_ratio = point.cables.sag / point.cables.chord
    violations = [
        violation
        for i in range(len(inclination))
        for violation in limit_violations(
            i + 1, cables.lambda_squared[i], inclination[i], cables.epsilon[i], sag_ratio[i]
        )
    ]
    return ValidityLimits(
        lambda_squared=cables.lambda_squared,
        epsilon=cables.epsilon,
        inclination_deg=inclination,
        sag_ratio=sag_ratio,
        crossover_distance=crossover_distance(cables.lambda_squared),
        violations=tuple(violations),
    )


def crossover_distance(lambda_squared: np.ndarray) -> np.ndarray:
    """Relative distance of lambda^2 to the nearest crossover 4 n^2 pi^2, n >= 1 [-]."""
    n = np.maximum(np.round(np.sqrt(lambda_squared) / (2.0 * np.pi)), 1.0)
    nearest = np.stack([4.0 * k**2 * np.pi**2 for k in (n, n + 1.0, np.maximum(n - 1.0, 1.0))])
    return np.min(np.abs(lambda_squared / nearest - 1.0), axis=0)


def epsilon_limit(inclination_deg: float) -> float:
    """Largest eps that (2.41) admits at this inclination [deg]; 0 above 60 deg."""
    return next((eps for angle, eps in INCLINATION_EPSILON_PAIRS if inclination_deg <= angle), 0.0)


def epsilon_limits(inclination_deg: np.ndarray) -> np.ndarray:
    """`epsilon_limit` of each inclination of an array; nan stays nan."""
    limits = np.where(np.isnan(inclination_deg), np.nan, 0.0)
    for angle, largest in reversed(INCLINATION_EPSILON_PAIRS):
        limits = np.where(inclination_deg <= angle, largest, limits)
    return limits


def limit_violations(
    cable: int, lambda2: float, inclination: float, epsilon: float, sag_ratio: float
) -> list[Violation]:
    """Printed limits that one cable breaks; inclination unsigned [deg], the others [-]."""
    found = []
    distance = float(crossover_distance(np.asarray(lambda2)))
    if lambda2 > LAMBDA_SQUARED_LIMIT:
        found.append(Violation(cable, "lambda2", float(lambda2), LAMBDA_SQUARED_LIMIT))
    if distance < CROSSOVER_DISTANCE:
        found.append(Violation(cable, "crossover_distance", distance, CROSSOVER_DISTANCE))
    largest_angle = INCLINATION_EPSILON_PAIRS[-1][0]
    if inclination > largest_angle:
        found.append(Violation(cable, "alpha_deg", float(inclination), largest_angle))
    elif epsilon > epsilon_limit(inclination):
        found.append(Violation(cable, "epsilon", float(epsilon), epsilon_limit(inclination)))
    if sag_ratio > SAG_RATIO_LIMIT:
        found.append(Violation(cable, "sag_ratio", float(sag_ratio), SAG_RATIO_LIMIT))
    return found
