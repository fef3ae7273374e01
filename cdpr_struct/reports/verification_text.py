"""A verification as text for a terminal."""

import math

import numpy as np

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.reports.text import paragraphs, place, plain_table


def verification_text(v: Verification) -> str:
    """Tables of modes, convergence and cable parameters, then the verdict."""
    return paragraphs(_headline(v), _modes(v), _convergence(v), _cables(v), verdict(v))


def verdict(v: Verification) -> str:
    """The outcome in plain sentences."""
    k = len(v.dsm_hertz)
    worst = 100.0 * float(np.abs(v.relative_error).max())
    doubled = (
        f"A scan for determinant minima at {v.scan.step_hertz:g} Hz misses {v.missed_by_scan} of {k} eigenfrequencies "
        f"({', '.join(f'{n} at {step:g} Hz' for step, n in v.missed.items())})."
    )
    limits = (
        "All cables are within the printed validity limits."
        if not v.limits.violations
        else f"Outside the printed validity limits: {violations_text(v)}."
    )
    objections = v.objections()
    holds = (
        f"HOLDS: all {k} FEM eigenfrequencies have their DSM partner, largest deviation {worst:.3f} %."
        if not objections
        else "DOES NOT HOLD: " + "; ".join(objections) + "."
    )
    whose = [exact_text(v)] if objections else []
    return "\n".join([holds, *whose, doubled, geometric_text(v), limits])


def exact_text(v: Verification) -> str:
    """Whether the exact model holds where the closed form does not."""
    worst = float(np.abs(v.exact_hertz / v.fem_limit_hertz - 1.0).max())
    if not worst <= v.criteria.relative_error:
        return f"The exact model deviates from the FEM, too, by up to {100.0 * worst:.2g} %: check the robot file."
    return (
        f"The exact model, which the other commands use, agrees with the FEM within {100.0 * worst:.1g} %: the closed "
        "form is in error here, not the robot file."
    )


def geometric_text(v: Verification) -> str:
    """What eq. (3.8) as printed would change."""
    if math.isnan(v.geometric_effect):
        return "Without the geometric term of the attachments, which eq. (3.8) lacks, this equilibrium is unstable."
    if v.geometric_effect > 1.0 - 1e-3:
        return "Without the geometric term of the attachments, which eq. (3.8) lacks, a frequency falls to zero."
    return (
        "The geometric term of the rotating attachments, which eq. (3.8) lacks, changes frequencies by up to "
        f"{100.0 * v.geometric_effect:.2g} %."
    )


def violations_text(v: Verification) -> str:
    """Violated limits, grouped by parameter."""
    groups: dict[str, list[str]] = {}
    for item in v.limits.violations:
        key = f"{item.parameter} (limit {item.limit:.3g})"
        groups.setdefault(key, []).append(f"{item.cable}: {item.value:.3g}")
    return "; ".join(f"{key} cable {', '.join(values)}" for key, values in groups.items())


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
            f"{v.dsm_hertz[i]:.4f}",
            f"{100.0 * v.relative_error[i]:+.3f}",
            f"{v.exact_hertz[i]:.4f}",
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
        "DSM [Hz]",
        "error [%]",
        "exact [Hz]",
        "static [Hz]",
        "det. min. [Hz]",
        "shape",
        "kind",
    ]
    return plain_table("Eigenfrequencies, paired by mode shape", columns, rows)


def _convergence(v: Verification) -> str:
    rows = [
        [
            str(n),
            f"{100.0 * e.max():.4f}",
            f"{100.0 * np.median(e):.4f}",
            f"{100.0 * c.max():.4f}",
            f"{100.0 * k.max():.4f}",
        ]
        for n, e, c, k in zip(v.elements, v.mesh_error, v.consistent_mesh_error, v.stiffness.fem_error, strict=True)
    ]
    rows.append(
        ["DSM", f"{100.0 * np.abs(v.relative_error).max():.4f}", "", "", f"{100.0 * v.stiffness.dsm_error.max():.4f}"]
    )
    title = f"Convergence of the FEM: observed order {np.nanmedian(v.observed_order):.2f} (median over modes)"
    columns = [
        "elements",
        "largest error [%]",
        "median [%]",
        "largest, consistent mass [%]",
        "K(omega) against exact [%]",
    ]
    return plain_table(title, columns, rows)


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
