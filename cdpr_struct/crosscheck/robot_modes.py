"""Modes of the whole robot by any of the four models, in one form."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import fem_cable_motion, solve_in_fem
from cdpr_struct.crosscheck.validity_limits import check_limits
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import kind_of_mode
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import CdprError

Model = Literal["static", "dsm", "exact", "fem"]
MODELS: tuple[Model, ...] = get_args(Model)


class OutsideValidityError(CdprError):
    """The closed-form DSM is asked for cables outside its printed limits."""


@dataclass(frozen=True, slots=True, eq=False)
class RobotModes:
    """The first k modes of a robot at rest.

    hertz           : (k,) ascending, multiplicities repeated
    platform        : (k, 6) motion of the platform origin and rotation, world axes, unit modal mass
    platform_energy : (k,) and cable_energy (k, m): shares of the kinetic energy [-]
    count_certified : an exact count proves that no frequency is missing
    cable_motion    : at fractions (s,) of each cable from the frame, 0 and 1 included: its motion (k, m, s, 3) in world
                      axes, in the units of `platform`
    """

    hertz: np.ndarray
    platform: np.ndarray
    platform_energy: np.ndarray
    cable_energy: np.ndarray
    count_certified: bool
    cable_motion: Callable[[np.ndarray], np.ndarray]

    def kinds(self) -> list[str]:
        """Per mode "platform", "cable i", "cables" or "mixed", by the kinetic energy."""
        return [kind_of_mode(p, c) for p, c in zip(self.platform_energy, self.cable_energy, strict=True)]


def robot_modes(
    point: OperatingPoint, model: Model, count: int, assembly: Assembly = "consistent", elements: int = 80
) -> RobotModes:
    """First `count` modes by the named model.

    elements : per cable, used by "fem" only

    Raises
    ------
    CdprError : the equilibrium is unstable, or the model has fewer modes (massless cables: six).
    """
    if model == "fem":
        return _fem_modes(point, count, elements)
    found = certified_modes(point, model, count, assembly)
    shapes = found.shapes
    return RobotModes(
        found.frequencies.hertz,
        shapes.platform,
        shapes.platform_energy,
        shapes.cable_energy,
        found.frequencies.certified,
        shapes.cable_motion,
    )


def require_validity(point: OperatingPoint) -> None:
    """Raise OutsideValidityError if a cable breaks a printed limit of the closed-form DSM."""
    violations = check_limits(point).violations
    if violations:
        worst = "; ".join(f"cable {v.cable}: {v.parameter} {v.value:.4g} (limit {v.limit:.4g})" for v in violations[:4])
        more = f" and {len(violations) - 4} more" if len(violations) > 4 else ""
        raise OutsideValidityError(
            f"outside the printed limits of the closed-form DSM: {worst}{more}. Use --model exact, or --force."
        )


def _fem_modes(point: OperatingPoint, count: int, elements: int) -> RobotModes:
    equilibrium = solve_in_fem(point, elements)
    available = 6 + 3 * len(point.entered.cables) * (elements - 1)
    if count >= available:
        raise CdprError(f"{elements} elements per cable have {available} modes only; ask for fewer or raise --elements")
    found = fem.robot_modes(equilibrium, count)
    below = fem.count_below(equilibrium, 2.0 * np.pi * found.frequencies_hz[-1] * (1.0 + 1e-9))
    return RobotModes(
        found.frequencies_hz, found.platform_shapes, found.platform_energy, found.cable_energy, below >= count,
        lambda stations: fem_cable_motion(point, found, stations),
    )  # fmt: skip
