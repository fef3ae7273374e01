"""A verification as text for a terminal."""

import math

import numpy as np

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.text import paragraphs, place, plain_table
from cdpr_struct.reports.verification_verdict import verdict_lines


def verification_text(v: Verification) -> str:
    """Tables of modes, convergence and cable parameters, then the verdicts."""
    return paragraphs(_headline(v), _modes(v), _convergence(v), _cables(v), "\n".join(verdict_lines(v)))


def _headline(v: Verification) -> str:
    return (
        f"{v.point.entered.name} at {place(v.point.position)}, platform {v.point.entered.platform.mass:g} kg, "
        f"assembly {v.assembly}; FEM with {', '.join(map(str, v.elements))} elements per cable, extrapolated"
    )


def _modes(v: Verification) -> str:
    rows = [
        [
            str(i + 1),
            f"{v.fem_limit_hertz[i]:.4f}",
            f"{v.fem_uncertainty_hertz[i]:.0e}",
            f"{v.exact_hertz[i]:.4f}",
            f"{100.0 * v.exact_error[i]:+.5f}",
            f"{v.dsm_hertz[i]:.4f}",
            f"{100.0 * v.relative_error[i]:+.3f}",
            _or_dash(v.static_hertz[i]),
            _or_dash(v.determinant_hertz[i], 2),
            f"{v.assurance[i]:.2f}",
            v.kinds[i],
        ]
        for i in range(len(v.dsm_hertz))
    ]
    columns = [
        "mode",
        "FEM [Hz]",
        "+-",
        "exact [Hz]",
        "off [%]",
        "DSM [Hz]",
        "off [%]",
        "static [Hz]",
        "det. min. [Hz]",
        "DSM shape",
        "kind",
    ]
    return plain_table("Eigenfrequencies, paired by mode shape", columns, rows)


def _convergence(v: Verification) -> str:
    each = zip(v.elements, v.mesh_error, v.consistent_mesh_error, strict=True)
    rows = [[str(n), _percent(e.max()), _percent(np.median(e)), _percent(c.max())] for n, e, c in each]
    for name, error in (("exact model", v.exact_error), ("closed-form DSM", v.relative_error)):
        size = np.abs(error)
        rows.append([name, _percent(size.max()), _percent(np.median(size)), ""])
    order = np.nanmedian(v.observed_order) if np.isfinite(v.observed_order).any() else math.nan
    title = (
        "Deviation from the FEM's limit, by elements per cable and by model: observed order "
        f"{order:.2f} (median over modes)"
    )
    return plain_table(title, ["elements", "largest [%]", "median [%]", "largest, consistent mass [%]"], rows)


def _percent(ratio: float) -> str:
    return f"{100.0 * ratio:.5f}"


def _cables(v: Verification) -> str:
    limits, cables = v.limits, v.point.cables
    rows = [
        [
            str(i + 1),
            f"{cables.tension_at_platform[i]:.2f}",
            f"{cables.length[i]:.4f}",
            f"{limits.lambda_squared[i]:.3f}",
            f"{limits.epsilon[i]:.4f}",
            f"{limits.inclination_deg[i]:.1f}",
            f"{limits.sag_ratio[i]:.4f}",
        ]
        for i in range(len(limits.epsilon))
    ]
    columns = ["cable", "tension [N]", "length [m]", "lambda^2", "epsilon", "alpha [deg]", "sag/chord"]
    return plain_table("Cables", columns, rows)


def _or_dash(value: float, digits: int = 4) -> str:
    return "-" if math.isnan(value) else f"{value:.{digits}f}"
