"""The DSM model on trial before the finite-element referee, at one pose of one robot."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.optimize import linear_sum_assignment

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.determinant_minima import DeterminantScan, match_minima, scan_determinant
from cdpr_struct.crosscheck.fem_robot import fem_shapes, sampling_mass, solve_in_fem, vibrating
from cdpr_struct.crosscheck.mode_pairing import modal_assurance, pair_modes, shared_subspace
from cdpr_struct.crosscheck.stiffness_convergence import StiffnessConvergence, stiffness_convergence
from cdpr_struct.crosscheck.validity_limits import ValidityLimits, check_limits
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.certified_modes import certified_frequencies, certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import (
    Assembly,
    platform_mass_matrix,
    platform_static_stiffness,
    stability_at,
)
from cdpr_struct.errors import CdprError
from cdpr_struct.statics.guides import free_axes, free_block

SCAN_STEPS_HERTZ = (0.05, 0.02, 0.01, 0.005)
_REPORTED_STEP = 0.01
_SPARE_MODES = 24
_ALIKE = 0.1  # of a mode's energy must be a static mode's motion for the one to stand for the other


@dataclass(frozen=True, slots=True)
class Criteria:
    """What must hold for the verdict.

    relative_error   : largest deviation of a DSM frequency from the extrapolated FEM [-]
    assurance        : smallest share of an FEM shape that must lie in the DSM's cluster it is paired with [-]
    fem_uncertainty  : largest relative uncertainty of an extrapolated FEM frequency [-]
    minimum_tolerance: a determinant minimum farther than this from a frequency does not stand for it [Hz]
    """

    relative_error: float = 0.01
    assurance: float = 0.5
    fem_uncertainty: float = 1e-3
    minimum_tolerance: float = 0.03


@dataclass(frozen=True, slots=True, eq=False)
class Verification:
    """What the referee says about the DSM model; arrays over k modes in the order of the FEM frequencies.

    fem_hertz         : (e, k) at each element count;  fem_limit_hertz, fem_uncertainty_hertz : (k,) extrapolated
    observed_order    : (k,) of the convergence with element count
    exact_hertz       : (k,) the paired frequency with the exact catenary's dynamic stiffness
    dsm_hertz         : (k,) the paired DSM frequency;  assurance : (k,) share of the FEM shape in its cluster
    static_hertz      : (k,) frequency on massless cables where this is the platform mode it stands for, else nan
    determinant_hertz : (k,) the minimum of the thesis's scan that stands for this mode, else nan
    missed, spurious  : per scan step [Hz], how many frequencies have no minimum, and how many minima no frequency
    consistent_hertz  : (e, k) the FEM with consistent instead of lumped mass;  stiffness : K(omega) itself
    geometric_effect  : largest relative change of a frequency if eq. (3.8) is assembled as printed [-]
    neutral, fem_neutral : directions in which nothing pushes the platform back, by model and referee; their frequency
                        is zero, and they are not among the modes
    """

    point: OperatingPoint
    assembly: Assembly
    criteria: Criteria
    elements: tuple[int, ...]
    fem_hertz: np.ndarray
    fem_limit_hertz: np.ndarray
    fem_uncertainty_hertz: np.ndarray
    observed_order: np.ndarray
    dsm_hertz: np.ndarray
    dsm_certified: bool
    exact_hertz: np.ndarray
    assurance: np.ndarray
    kinds: tuple[str, ...]
    static_hertz: np.ndarray
    determinant_hertz: np.ndarray
    scan: DeterminantScan
    missed: dict[float, int]
    spurious: dict[float, int]
    consistent_hertz: np.ndarray
    stiffness: StiffnessConvergence
    geometric_effect: float
    limits: ValidityLimits
    neutral: int
    fem_neutral: int

    @property
    def relative_error(self) -> np.ndarray:
        """(k,) DSM against the extrapolated FEM, signed [-]."""
        return self.dsm_hertz / self.fem_limit_hertz - 1.0

    @property
    def mesh_error(self) -> np.ndarray:
        """(e, k) |FEM at this element count / its limit - 1| [-]."""
        return np.abs(self.fem_hertz / self.fem_limit_hertz - 1.0)

    @property
    def consistent_mesh_error(self) -> np.ndarray:
        """(e, k) as `mesh_error`, with consistent mass [-]."""
        return np.abs(self.consistent_hertz / self.fem_limit_hertz - 1.0)

    @property
    def missed_by_scan(self) -> int:
        """Frequencies without a determinant minimum of their own, at the reported grid step."""
        return self.missed[_REPORTED_STEP]

    def objections(self) -> list[str]:
        """Sentences, one per criterion that is not met; empty when the model holds."""
        return [text for failed, text in _objections(self) if failed]


@dataclass(frozen=True, slots=True, eq=False)
class _FemSweep:
    meshes: list[fem.RobotEquilibrium]
    hertz: np.ndarray
    consistent_hertz: np.ndarray
    shapes: np.ndarray
    platform_shapes: np.ndarray


def verify(
    point: OperatingPoint,
    elements: Sequence[int],
    modes: int,
    assembly: Assembly = "consistent",
    criteria: Criteria | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Verification:
    """Compare `modes` eigenfrequencies of the DSM model with those of the FEM at the same unstrained lengths.

    Parameters
    ----------
    elements : ascending element counts per cable, at least three, each a multiple of the first
    progress : called with what is being computed
    """
    criteria = criteria or Criteria()
    stations = elements[0]
    platform_mass = platform_mass_matrix(point.entered, point.rotation)
    mass = sampling_mass(point.entered, point.cables.length, stations, platform_mass)
    sweep = _sweep_elements(point, elements, modes, mass, progress)
    progress("closed-form DSM and exact catenary")
    dsm, exact = (_model_modes(point, model, modes, assembly, stations) for model in ("dsm", "exact"))
    extrapolated = fem.extrapolate(elements, sweep.hertz)
    assurance = modal_assurance(sweep.shapes, dsm.shapes, mass)
    partner = pair_modes(assurance, sweep.hertz[-1], dsm.hertz)
    exact_partner = pair_modes(modal_assurance(sweep.shapes, exact.shapes, mass), sweep.hertz[-1], exact.hertz)
    dsm_hertz = dsm.hertz[partner]
    progress("determinant scan")
    scans = _scans(point, assembly, dsm_hertz.max())
    matched = {
        step: match_minima(scan.minima_hertz, dsm_hertz, criteria.minimum_tolerance) for step, scan in scans.items()
    }
    return Verification(
        point=point,
        assembly=assembly,
        criteria=criteria,
        elements=tuple(elements),
        fem_hertz=sweep.hertz,
        fem_limit_hertz=extrapolated.limit,
        fem_uncertainty_hertz=extrapolated.error_estimate,
        observed_order=extrapolated.order,
        dsm_hertz=dsm_hertz,
        dsm_certified=dsm.certified,
        exact_hertz=exact.hertz[exact_partner],
        assurance=shared_subspace(assurance, dsm.hertz, partner),
        kinds=tuple(dsm.kinds[j] for j in partner),
        static_hertz=_static_partners(point, assembly, sweep.platform_shapes, platform_mass),
        determinant_hertz=matched[_REPORTED_STEP],
        scan=scans[_REPORTED_STEP],
        missed={step: int(np.isnan(m).sum()) for step, m in matched.items()},
        spurious={step: len(scans[step].minima_hertz) - int(np.isfinite(m).sum()) for step, m in matched.items()},
        consistent_hertz=sweep.consistent_hertz,
        stiffness=stiffness_convergence(point, sweep.meshes, exact.hertz[:modes], assembly),
        geometric_effect=_geometric_effect(point, exact.hertz[:modes], exact.neutral, assembly),
        limits=check_limits(point),
        neutral=exact.neutral,
        fem_neutral=fem.neutral_freedoms(sweep.meshes[-1]),
    )


def _geometric_effect(point: OperatingPoint, hertz: np.ndarray, neutral: int, assembly: Assembly) -> float:
    """Largest relative change of the exact frequencies if the geometric term is left out; nan where that is unstable.

    hertz : (k,) those of `assembly` above zero, after so many `neutral` freedoms; the other assembly's are computed
    """
    try:
        way: Assembly = "thesis" if assembly == "consistent" else "consistent"
        other = certified_frequencies(point, "exact", len(hertz) + neutral, way).hertz[neutral:]
    except CdprError:
        return float("nan")
    ratio = other / hertz if assembly == "consistent" else hertz / other
    return float(np.abs(ratio - 1.0).max())


@dataclass(frozen=True, slots=True, eq=False)
class _ModelModes:
    """Modes above zero; neutral: number of those at zero before them."""

    neutral: int
    hertz: np.ndarray
    certified: bool
    shapes: np.ndarray
    kinds: list[str]


def _model_modes(
    point: OperatingPoint, model: CableModel, modes: int, assembly: Assembly, stations: int
) -> _ModelModes:
    """Frequencies of the model with shapes (k, 6 + 3 m (stations - 1)) sampled where the FEM's are."""
    neutral = int(stability_at(point, assembly).neutral)
    found = certified_modes(point, model, neutral + modes + _SPARE_MODES, assembly)
    motion = found.shapes.cable_motion(np.arange(1, stations) / stations)
    shapes = np.concatenate([found.shapes.platform, motion.reshape(len(motion), -1)], axis=1)
    hertz, kinds = found.frequencies.hertz[neutral:], found.shapes.kinds()[neutral:]
    return _ModelModes(neutral, hertz, found.frequencies.certified, shapes[neutral:], kinds)


def _sweep_elements(
    point: OperatingPoint, elements: Sequence[int], modes: int, mass: np.ndarray, progress: Callable[[str], None]
) -> _FemSweep:
    """FEM frequencies at every element count, each mode followed by its shape up to the finest mesh."""
    meshes, lumped, consistent = [], [], []
    for n in elements:
        progress(f"FEM, {len(point.entered.cables)} x {n} elements")
        spare = 0 if n == elements[-1] else _SPARE_MODES
        every = 5 - len(point.entered.guided) + 3 * len(point.entered.cables) * (n - 1)
        meshes.append(solve_in_fem(point, n))
        neutral = fem.neutral_freedoms(meshes[-1])
        count = min(neutral + modes + spare, every)
        lumped.append(vibrating(fem.robot_modes(meshes[-1], count), neutral))
        consistent.append(vibrating(fem.robot_modes(meshes[-1], count, "consistent"), neutral))
    finest = lumped[-1]
    shapes = fem_shapes(finest, elements[0])

    def followed(found: list[fem.RobotModes]) -> np.ndarray:
        return np.array([_followed(finest, shapes, coarse, elements[0], mass) for coarse in found])

    return _FemSweep(meshes, followed(lumped), followed(consistent), shapes, finest.platform_shapes)


def _followed(
    finest: fem.RobotModes, shapes: np.ndarray, coarse: fem.RobotModes, stations: int, mass: np.ndarray
) -> np.ndarray:
    """(k,) frequencies [Hz] of another mesh or mass model, in the order of the finest mesh's modes."""
    assurance = modal_assurance(shapes, fem_shapes(coarse, stations), mass)
    return coarse.frequencies_hz[pair_modes(assurance, finest.frequencies_hz, coarse.frequencies_hz)]


def _scans(point: OperatingPoint, assembly: Assembly, last: float) -> dict[float, DeterminantScan]:
    return {step: scan_determinant(point, step, 1.05 * last, step, assembly) for step in SCAN_STEPS_HERTZ}


def _static_partners(
    point: OperatingPoint, assembly: Assembly, platform_shapes: np.ndarray, mass: np.ndarray
) -> np.ndarray:
    """For each FEM mode the frequency of the static mode it stands for; at most six modes get one, the others nan.

    platform_shapes carry unit modal mass, so the overlap with a static shape is the share of the FEM mode's energy
    that is this platform motion.
    """
    free = free_axes(point.arrays)
    stiffness, own = (free_block(part, point.arrays) for part in (platform_static_stiffness(point, assembly), mass))
    squared, static_shapes = scipy.linalg.eigh(stiffness, own)
    overlap = (platform_shapes[:, free] @ own @ static_shapes) ** 2
    result = np.full(len(platform_shapes), np.nan)
    rows, columns = linear_sum_assignment(-overlap)
    for i, j in zip(rows, columns, strict=True):
        if squared[j] > 0.0 and overlap[i, j] > _ALIKE:
            result[i] = np.sqrt(squared[j]) / (2.0 * np.pi)
    return result


def _objections(v: Verification) -> list[tuple[bool, str]]:
    worst = int(np.argmax(np.abs(v.relative_error)))
    lost = int(np.argmin(v.assurance))
    blurred = v.fem_uncertainty_hertz / v.fem_limit_hertz
    return [
        (
            abs(v.relative_error[worst]) > v.criteria.relative_error,
            f"mode {worst + 1}: DSM {v.dsm_hertz[worst]:.4f} Hz is off by {100 * v.relative_error[worst]:+.2f} % from "
            f"the FEM's {v.fem_limit_hertz[worst]:.4f} Hz, over {100 * v.criteria.relative_error:g} %",
        ),
        (
            v.assurance[lost] < v.criteria.assurance,
            f"mode {lost + 1} at {v.fem_limit_hertz[lost]:.4f} Hz has no DSM partner of its shape "
            f"(best share {v.assurance[lost]:.2f})",
        ),
        (
            float(np.max(blurred)) > v.criteria.fem_uncertainty,
            f"the FEM has not converged: its limit is uncertain by {100 * np.max(blurred):.2g} %; use more elements",
        ),
        (v.neutral != v.fem_neutral, f"the model has {v.neutral} neutral freedoms, the FEM {v.fem_neutral}"),
        (not v.dsm_certified, "the count of the DSM's natural frequencies could not be certified"),
    ]
