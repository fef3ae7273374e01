"""The tables of a verification's report page."""

import math

import numpy as np

from cdpr_struct.crosscheck.validity_limits import (
    CROSSOVER_DISTANCE,
    LAMBDA_SQUARED_LIMIT,
    SAG_RATIO_LIMIT,
    epsilon_limit,
)
from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.html import HtmlTable


def verification_tables(trial: Verification) -> list[HtmlTable]:
    """Modes, convergence, determinant scan and cables."""
    return [_modes(trial), _convergence(trial), _scan(trial), _cables(trial)]


def uncertain(value: float, uncertainty: float) -> str:
    """A value with only the digits its uncertainty allows, at most six after the point."""
    digits = 6 if not 0.0 < uncertainty < math.inf else min(max(-math.floor(math.log10(uncertainty)), 0), 6)
    return f"{value:.{digits}f}"


def _modes(trial: Verification) -> HtmlTable:
    return HtmlTable(
        "Eigenfrequencies, paired by mode shape",
        ["mode", "kind", "FEM [Hz]", "± [Hz]", "exact [Hz]", "off [%]", "DSM [Hz]", "off [%]", "static [Hz]",
         "det. min. [Hz]", "DSM shape share [-]", "order [-]"],
        [_mode(trial, i) for i in range(len(trial.kinds))],
        "FEM: extrapolated to infinitely many elements, ± its uncertainty. Exact: dynamic stiffness of the elastic "
        "catenary itself. DSM: the closed form. Static: cables as massless springs, which know six platform modes "
        "only. Det. min.: the minimum of the scan that stands for this mode; a dash where there is none. Shape share: "
        "part of the FEM shape that its DSM partners reproduce. Red rows break a criterion of a verdict.",
        frozenset(np.flatnonzero(_breaks(trial)).tolist()),
    )  # fmt: skip


def _breaks(trial: Verification) -> np.ndarray:
    """(k,) whether a judged model or the FEM fails a criterion at the mode."""
    broken = np.zeros(len(trial.kinds), dtype=bool)
    for model in trial.judged:
        found, criteria = trial.agreement(model), trial.criteria
        broken |= found.failing | (found.assurance < criteria.assurance)
        broken |= found.uncertainty > criteria.fem_uncertainty(model) * found.limit
    return broken


def _mode(trial: Verification, i: int) -> list[str]:
    fem, spread = trial.fem_limit_hertz[i], trial.fem_uncertainty_hertz[i]
    return [
        str(i + 1),
        trial.kinds[i],
        uncertain(fem, spread),
        f"{spread:.0e}",
        f"{trial.exact_hertz[i]:.4f}",
        f"{100.0 * trial.exact_error[i]:+.5f}",
        f"{trial.dsm_hertz[i]:.4f}",
        f"{100.0 * trial.relative_error[i]:+.3f}",
        _dash(trial.static_hertz[i], 4),
        _dash(trial.determinant_hertz[i], 2),
        f"{trial.assurance[i]:.2f}",
        _dash(trial.observed_order[i], 2),
    ]


def _convergence(trial: Verification) -> HtmlTable:
    rows = []
    each = zip(trial.elements, trial.mesh_error, trial.consistent_mesh_error, strict=True)
    for count, lumped, consistent in each:
        rows.append([str(count), *(_percent(error) for error in (lumped.max(), np.median(lumped), consistent.max()))])
    for name, error in (("exact model", trial.exact_error), ("closed-form DSM", trial.relative_error)):
        size = np.abs(error)
        rows.append([name, _percent(size.max()), _percent(np.median(size)), ""])
    return HtmlTable(
        "Deviation from the FEM's limit, by elements per cable and by model",
        ["elements per cable", "largest [%]", "median [%]", "largest, consistent mass [%]"],
        rows,
        "Meshes are refined until the extrapolated limit is certain to a tenth of the smallest tolerance.",
    )


def _percent(ratio: float) -> str:
    return f"{100.0 * ratio:.5f}"


def _scan(trial: Verification) -> HtmlTable:
    count = len(trial.kinds)
    rows = [
        [f"{step:g}", f"{missed}", f"{count - missed}", f"{trial.spurious[step]}"]
        for step, missed in trial.missed.items()
    ]
    columns = ["step [Hz]", "modes missed", "modes seen", "minima that stand for no mode"]
    return HtmlTable("Determinant scan", columns, rows)


def _cables(trial: Verification) -> HtmlTable:
    cables, limits = trial.point.cables, trial.limits
    rows = [
        [
            str(i + 1),
            f"{cables.tension_at_platform[i]:.2f}",
            f"{cables.length[i]:.4f}",
            f"{1000.0 * cables.sag[i]:.1f}",
            f"{limits.inclination_deg[i]:.1f}",
            f"{limits.lambda_squared[i]:.3f}",
            f"{limits.epsilon[i]:.4f}",
            f"{epsilon_limit(limits.inclination_deg[i]):g}",
            f"{limits.sag_ratio[i]:.4f}",
            f"{limits.crossover_distance[i]:.2f}",
            ", ".join(v.parameter for v in limits.violations if v.cable == i + 1) or "–",
        ]
        for i in range(len(limits.epsilon))
    ]
    return HtmlTable(
        "Cables against the printed limits",
        ["cable", "tension [N]", "length [m]", "sag [mm]", "|α| [deg]", "λ² [-]", "ε [-]", "ε limit [-]",
         "sag/chord [-]", "crossover distance [-]", "violates"],
        rows,
        f"Limits: λ² ≤ {LAMBDA_SQUARED_LIMIT:g}; ε as listed, by inclination; sag/chord ≤ {SAG_RATIO_LIMIT:g}; "
        f"relative distance of λ² from a crossover 4n²π² ≥ {CROSSOVER_DISTANCE:g}. Tension at the platform; length "
        "unstrained.",
        frozenset(v.cable - 1 for v in limits.violations),
    )  # fmt: skip


def _dash(value: float, digits: int) -> str:
    return "–" if math.isnan(value) else f"{value:.{digits}f}"
