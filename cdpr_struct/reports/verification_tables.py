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
    outside = np.abs(trial.relative_error) > trial.criteria.relative_error
    lost = trial.assurance < trial.criteria.assurance
    blurred = trial.fem_uncertainty_hertz > trial.criteria.fem_uncertainty * trial.fem_limit_hertz
    return HtmlTable(
        "Eigenfrequencies, paired by mode shape",
        ["mode", "kind", "FEM [Hz]", "± [Hz]", "DSM [Hz]", "error [%]", "exact [Hz]", "static [Hz]",
         "det. min. [Hz]", "shape share [-]", "order [-]"],
        [_mode(trial, i) for i in range(len(trial.kinds))],
        "FEM: extrapolated to infinitely many elements, ± its uncertainty. Exact: dynamic stiffness of the elastic "
        "catenary itself. Static: cables as massless springs, which know six platform modes only. Det. min.: the "
        "minimum of the scan that stands for this mode; a dash where there is none. Shape share: part of the FEM "
        "shape that its DSM partners reproduce. Red rows break a criterion of the verdict.",
        frozenset(np.flatnonzero(outside | lost | blurred).tolist()),
    )  # fmt: skip


def _mode(trial: Verification, i: int) -> list[str]:
    fem, spread = trial.fem_limit_hertz[i], trial.fem_uncertainty_hertz[i]
    return [
        str(i + 1),
        trial.kinds[i],
        uncertain(fem, spread),
        f"{spread:.0e}",
        f"{trial.dsm_hertz[i]:.4f}",
        f"{100.0 * trial.relative_error[i]:+.3f}",
        f"{trial.exact_hertz[i]:.4f}",
        _dash(trial.static_hertz[i], 4),
        _dash(trial.determinant_hertz[i], 2),
        f"{trial.assurance[i]:.2f}",
        _dash(trial.observed_order[i], 2),
    ]


def _convergence(trial: Verification) -> HtmlTable:
    model = 100.0 * np.abs(trial.relative_error)
    rows = []
    each = zip(trial.elements, trial.mesh_error, trial.consistent_mesh_error, trial.stiffness.fem_error, strict=True)
    for count, lumped, consistent, stiffness in each:
        errors = [lumped.max(), np.median(lumped), consistent.max(), stiffness.max()]
        resolved = f"{int((100.0 * lumped < model).sum())} of {len(model)}"
        rows.append([str(count), *(f"{100.0 * error:.4f}" for error in errors), resolved])
    rows.append(
        [
            "DSM",
            f"{model.max():.4f}",
            f"{np.median(model):.4f}",
            "",
            f"{100.0 * trial.stiffness.dsm_error.max():.4f}",
            "",
        ]
    )
    return HtmlTable(
        "Convergence of the FEM",
        [
            "elements per cable",
            "largest error [%]",
            "median error [%]",
            "largest, consistent mass [%]",
            "K(ω) against exact [%]",
            "modes whose mesh error is below the DSM's",
        ],
        rows,
    )


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
