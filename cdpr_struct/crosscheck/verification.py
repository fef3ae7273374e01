"""The exact model and the closed-form DSM before the finite-element referee, at one pose of one robot."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.compared_modes import ComparedModes, model_modes, static_partners
from cdpr_struct.crosscheck.determinant_minima import DeterminantScan, match_minima, scan_determinant
from cdpr_struct.crosscheck.fem_robot import sampling_mass
from cdpr_struct.crosscheck.mode_pairing import modal_assurance, pair_modes, shared_subspace
from cdpr_struct.crosscheck.neglected_effects import neglected
from cdpr_struct.crosscheck.refined_fem import RefinedFem, refined_fem
from cdpr_struct.crosscheck.stiffness_convergence import StiffnessConvergence, stiffness_convergence
from cdpr_struct.crosscheck.validity_limits import ValidityLimits, check_limits
from cdpr_struct.crosscheck.verdict_causes import Cause, find_causes
from cdpr_struct.crosscheck.verdicts import JUDGED, Agreement, Criteria, Judged
from cdpr_struct.dynamics.certified_modes import certified_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly, platform_mass_matrix
from cdpr_struct.errors import CdprError

SCAN_STEPS_HERTZ = (0.05, 0.02, 0.01, 0.005)
_REPORTED_STEP = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Verification:
    """What the referee says about both models; arrays over k modes in the order of the FEM frequencies.

    judged            : the models that get a verdict, the one that decides first

    fem_hertz         : (e, k) at each element count;  fem_limit_hertz, fem_uncertainty_hertz : (k,) extrapolated
    observed_order    : (k,) of the convergence with element count
    exact_hertz       : (k,) the paired frequency with the exact catenary's dynamic stiffness
    dsm_hertz         : (k,) the paired DSM frequency
    exact_assurance, assurance : (k,) share of the FEM shape in the cluster of the exact model's, of the DSM's mode
    exact_mac, dsm_mac : (k, k) modal assurance criterion of FEM modes (rows) and the model's paired ones
    causes            : which effects the failing modes of a judged model lack
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
    judged: tuple[Judged, ...]
    elements: tuple[int, ...]
    fem_hertz: np.ndarray
    fem_limit_hertz: np.ndarray
    fem_uncertainty_hertz: np.ndarray
    observed_order: np.ndarray
    dsm_hertz: np.ndarray
    dsm_certified: bool
    exact_hertz: np.ndarray
    exact_certified: bool
    exact_assurance: np.ndarray
    assurance: np.ndarray
    exact_mac: np.ndarray
    dsm_mac: np.ndarray
    causes: dict[Judged, tuple[Cause, ...]]
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
        return self.agreement("dsm").error

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

    @property
    def exact_error(self) -> np.ndarray:
        """(k,) exact model against the extrapolated FEM, signed [-]."""
        return self.agreement("exact").error

    @property
    def fem_uncertainty(self) -> float:
        """Largest relative uncertainty of an extrapolated FEM frequency [-]."""
        return float(np.max(self.fem_uncertainty_hertz / self.fem_limit_hertz))

    def agreement(self, model: Judged) -> Agreement:
        """Whether the FEM confirms the model."""
        exact = model == "exact"
        return Agreement(
            model,
            self.criteria,
            self.exact_hertz if exact else self.dsm_hertz,
            self.fem_limit_hertz,
            self.fem_uncertainty_hertz,
            self.exact_assurance if exact else self.assurance,
            self.exact_certified if exact else self.dsm_certified,
            self.elements[-1],
            self.neutral,
            self.fem_neutral,
        )

    def mac(self, model: Judged) -> np.ndarray:
        """(k, k) modal assurance criterion of FEM modes (rows) and the modes of the model that are their partners."""
        return self.exact_mac if model == "exact" else self.dsm_mac

    def objections(self, model: Judged | None = None) -> list[str]:
        """One sentence per criterion that the model does not meet; None: the first of `judged`."""
        return self.agreement(model or self.judged[0]).objections


def verify(
    point: OperatingPoint,
    elements: Sequence[int],
    modes: int,
    assembly: Assembly = "consistent",
    criteria: Criteria | None = None,
    progress: Callable[[str], None] = lambda _: None,
    most_elements: int = 0,
    judged: tuple[Judged, ...] = JUDGED,
) -> Verification:
    """Compare `modes` eigenfrequencies of both models with those of the FEM at the same unstrained lengths.

    Parameters
    ----------
    elements : ascending element counts per cable, at least three, each a multiple of the first
    most_elements : the FEM is refined up to this many per cable, until it is certain enough for the criteria
    judged : models that get a verdict, with causes where they fail; both are computed in any case
    progress : called with what is being computed
    """
    criteria = criteria or Criteria()
    stations = elements[0]
    platform_mass = platform_mass_matrix(point.entered, point.rotation)
    mass = sampling_mass(point.entered, point.cables.length, stations, platform_mass)
    certain = min(criteria.fem_uncertainty(model) for model in judged)
    sweep = refined_fem(point, elements, most_elements, modes, mass, certain, progress)
    progress("closed-form DSM and exact catenary")
    first = model_modes(point, "exact", modes, assembly, stations)
    exact, exact_assurance, exact_mac = _paired(sweep, first, mass)
    dsm, assurance, dsm_mac = _paired(sweep, model_modes(point, "dsm", modes, assembly, stations), mass)
    progress("determinant scan")
    scans = _scans(point, assembly, dsm.hertz.max())
    matched = {
        step: match_minima(scan.minima_hertz, dsm.hertz, criteria.minimum_tolerance) for step, scan in scans.items()
    }
    found = Verification(
        point=point,
        assembly=assembly,
        criteria=criteria,
        judged=judged,
        elements=sweep.elements,
        fem_hertz=sweep.hertz,
        fem_limit_hertz=sweep.limit.limit,
        fem_uncertainty_hertz=sweep.limit.error_estimate,
        observed_order=sweep.limit.order,
        dsm_hertz=dsm.hertz,
        dsm_certified=dsm.certified,
        exact_hertz=exact.hertz,
        exact_certified=exact.certified,
        exact_assurance=exact_assurance,
        assurance=assurance,
        exact_mac=exact_mac,
        dsm_mac=dsm_mac,
        causes={},
        kinds=tuple(exact.kinds),
        static_hertz=static_partners(point, assembly, sweep.platform_shapes, platform_mass),
        determinant_hertz=matched[_REPORTED_STEP],
        scan=scans[_REPORTED_STEP],
        missed={step: int(np.isnan(m).sum()) for step, m in matched.items()},
        spurious={step: len(scans[step].minima_hertz) - int(np.isfinite(m).sum()) for step, m in matched.items()},
        consistent_hertz=sweep.consistent_hertz,
        stiffness=stiffness_convergence(point, sweep.meshes, first.hertz[:modes], assembly),
        geometric_effect=_geometric_effect(point, first.hertz[:modes], exact.neutral, assembly),
        limits=check_limits(point),
        neutral=exact.neutral,
        fem_neutral=fem.neutral_freedoms(sweep.meshes[-1]),
    )
    return replace(found, causes=_causes(found, {"exact": exact, "dsm": dsm}, mass, stations))


def _paired(sweep: RefinedFem, modes: ComparedModes, mass: np.ndarray) -> tuple[ComparedModes, np.ndarray, np.ndarray]:
    """The model's modes that stand for those of the FEM, how much of each shape (k,) they share, and the MAC (k, k)."""
    assurance = modal_assurance(sweep.shapes, modes.shapes, mass)
    partner = pair_modes(assurance, sweep.hertz[-1], modes.hertz)
    shared = shared_subspace(assurance, modes.hertz, partner)
    kinds = [modes.kinds[j] for j in partner]
    found = replace(modes, hertz=modes.hertz[partner], shapes=modes.shapes[partner], kinds=kinds)
    return found, shared, assurance[:, partner]


def _causes(
    found: Verification, modes: dict[Judged, ComparedModes], mass: np.ndarray, stations: int
) -> dict[Judged, tuple[Cause, ...]]:
    """Causes of the judged models of which a frequency is off."""
    causes: dict[Judged, tuple[Cause, ...]] = {}
    for model in found.judged:
        failing = found.agreement(model).failing
        if failing.any():
            effects = neglected(found.point, model, found.assembly)
            tolerance, closed = found.criteria.tolerance(model), model == "dsm"
            causes[model] = find_causes(found.point, modes[model], effects, failing, tolerance, mass, stations, closed)
    return causes


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


def _scans(point: OperatingPoint, assembly: Assembly, last: float) -> dict[float, DeterminantScan]:
    return {step: scan_determinant(point, step, 1.05 * last, step, assembly) for step in SCAN_STEPS_HERTZ}
