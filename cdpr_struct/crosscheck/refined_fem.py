"""Modes of the FEM on meshes that are refined until their limit is certain."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.compared_modes import SPARE_MODES
from cdpr_struct.crosscheck.fem_robot import fem_shapes, solve_in_fem, vibrating
from cdpr_struct.crosscheck.mode_pairing import modal_assurance, pair_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint

_ORDER = 2.0  # of the frequencies of two-node elements
_ROUNDING = 0.1 * float(np.finfo(float).eps)  # of an eigenvalue per n^2 EA / T, measured (`fem_reference/README.md`)


@dataclass(frozen=True, slots=True, eq=False)
class RefinedFem:
    """Modes of the FEM on e meshes, each mode followed by its shape up to the finest mesh.

    elements : (e,) per cable;  meshes : the robot at rest on each
    hertz, consistent_hertz : (e, k) with lumped and with consistent mass [Hz]
    limit    : of `hertz`, extrapolated
    shapes, platform_shapes : (k, ..) on the finest mesh, sampled at the first mesh's nodes
    """

    elements: tuple[int, ...]
    meshes: list[fem.RobotEquilibrium]
    hertz: np.ndarray
    consistent_hertz: np.ndarray
    limit: fem.Extrapolation
    shapes: np.ndarray
    platform_shapes: np.ndarray

    @property
    def uncertainty(self) -> float:
        """Largest relative uncertainty of a limit [-]."""
        return float(np.max(self.limit.error_estimate / self.limit.limit))


@dataclass(frozen=True, slots=True, eq=False)
class _Mesh:
    elements: int
    rest: fem.RobotEquilibrium
    lumped: fem.RobotModes
    consistent: fem.RobotModes


def refined_fem(
    point: OperatingPoint,
    elements: Sequence[int],
    most: int,
    modes: int,
    mass: np.ndarray,
    uncertainty: float,
    progress: Callable[[str], None],
) -> RefinedFem:
    """Refine by doubling beyond `elements` until every limit is certain, or more than `most` elements were needed.

    Parameters
    ----------
    elements : ascending element counts per cable, at least three, each a multiple of the first
    mass : of the samples of shapes, see `sampling_mass`
    uncertainty : largest relative one that is asked for [-]
    """

    def mesh(count: int) -> _Mesh:
        progress(f"FEM, {len(point.entered.cables)} x {count} elements")
        return _solved(point, count, modes)

    meshes = [mesh(n) for n in elements]
    found = _followed(point, meshes, modes, mass)
    while found.uncertainty > uncertainty and 2 * found.elements[-1] <= most:
        meshes.append(mesh(2 * found.elements[-1]))
        found = _followed(point, meshes, modes, mass)
    return found


def _solved(point: OperatingPoint, elements: int, modes: int) -> _Mesh:
    robot = point.entered
    every = 5 - len(robot.guided) + 3 * len(robot.cables) * (elements - 1)
    rest = solve_in_fem(point, elements)
    neutral = fem.neutral_freedoms(rest)
    count = min(neutral + modes + SPARE_MODES, every)
    lumped, consistent = fem.robot_modes(rest, count), fem.robot_modes(rest, count, "consistent")
    return _Mesh(elements, rest, vibrating(lumped, neutral), vibrating(consistent, neutral))


def _followed(point: OperatingPoint, meshes: list[_Mesh], modes: int, mass: np.ndarray) -> RefinedFem:
    stations, finest = meshes[0].elements, meshes[-1]
    shapes = fem_shapes(finest.lumped, stations)[:modes]
    hertz = finest.lumped.frequencies_hz[:modes]

    def partners(coarse: fem.RobotModes) -> np.ndarray:
        assurance = modal_assurance(shapes, fem_shapes(coarse, stations), mass)
        return coarse.frequencies_hz[pair_modes(assurance, hertz, coarse.frequencies_hz)]

    elements = tuple(mesh.elements for mesh in meshes)
    lumped = np.array([*(partners(mesh.lumped) for mesh in meshes[:-1]), hertz])
    consistent = np.array([partners(mesh.consistent) for mesh in meshes])
    limit = _limit(point, elements, lumped)
    rests = [mesh.rest for mesh in meshes]
    return RefinedFem(elements, rests, lumped, consistent, limit, shapes, finest.lumped.platform_shapes[:modes])


def _limit(point: OperatingPoint, elements: tuple[int, ...], hertz: np.ndarray) -> fem.Extrapolation:
    """The limit of each mode, from the finest meshes whose differences are above their rounding errors."""
    found = _extrapolated(point, elements, hertz)
    for count in range(len(elements) - 1, 2, -1):
        blurred = found.reason == "noise floor"
        if not blurred.any():
            break
        coarser = _extrapolated(point, elements[:count], hertz[:count])
        names = [part.name for part in fields(found)]
        found = fem.Extrapolation(*(np.where(blurred, getattr(coarser, n), getattr(found, n)) for n in names))
    return found


def _extrapolated(point: OperatingPoint, elements: tuple[int, ...], hertz: np.ndarray) -> fem.Extrapolation:
    """Limit with the observed order, at least as uncertain as it is far from that with the order of the elements.

    Where modes exchange their shapes as the mesh is refined, two wrong limits may agree by chance; the order then is
    not yet two.
    """
    found = fem.extrapolate(elements, hertz, _rounding(point, elements[-1]))
    gain = (elements[-1] / elements[-2]) ** _ORDER - 1.0
    nominal = hertz[-1] + (hertz[-1] - hertz[-2]) / gain
    apart = np.where(found.reason == "", np.abs(nominal - found.limit), 0.0)
    return replace(found, error_estimate=np.maximum(found.error_estimate, apart))


def _rounding(point: OperatingPoint, elements: int) -> float:
    """Relative rounding error of a frequency on a mesh."""
    ratio = point.cables.axial_stiffness / np.minimum(point.cables.tension_at_platform, point.cables.tension_at_frame)
    return 0.5 * _ROUNDING * elements**2 * float(ratio.max())
