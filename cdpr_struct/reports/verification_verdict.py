"""The verdicts of a verification in sentences: which model holds, why one does not, and what to do."""

import math

from cdpr_struct.crosscheck.verdict_causes import SAG
from cdpr_struct.crosscheck.verdicts import Agreement, Judged
from cdpr_struct.crosscheck.verification import Verification

MODEL_WORDS = {"exact": "exact model", "dsm": "closed-form DSM"}
EFFECT_WORDS = {
    "pulleys": "pulleys",
    "static_strain": "elastic stretch of the cables at rest",
    "axial_inertia": "inertia along the chord",
    "along_weight": "weight along the chord",
    SAG: "sag beyond the parabola of the closed form",
    "geometric_term": "geometric term of the attachments, which the assembly thesis lacks",
}


def verdict_lines(v: Verification) -> list[str]:
    """One sentence a judged model, what else was found, and at the end what to do."""
    scanned = (
        f"A scan for determinant minima at {v.scan.step_hertz:g} Hz misses {v.missed_by_scan} of {len(v.dsm_hertz)} "
        f"eigenfrequencies ({', '.join(f'{n} at {step:g} Hz' for step, n in v.missed.items())})."
    )
    limits = (
        "All cables are within the printed validity limits of the closed form."
        if not v.limits.violations
        else f"Outside the printed validity limits of the closed form: {violations_text(v)}."
    )
    judged = [model_sentence(v, model) for model in v.judged]
    return [*judged, scanned, geometric_text(v), limits, f"What to do: {what_to_do(v)}"]


def model_sentence(v: Verification, model: Judged) -> str:
    """Whether the FEM confirms the model, and if not, the cause."""
    found = v.agreement(model)
    name = MODEL_WORDS[model].replace("exact model", "EXACT MODEL").replace("closed-form", "CLOSED-FORM")
    if not found.objections:
        return (
            f"{name} HOLDS: all {len(found.hertz)} FEM eigenfrequencies have their partner, largest deviation "
            f"{percent(worst(found))} (the FEM is certain to {percent(v.fem_uncertainty)})."
        )
    cause = cause_sentence(v, model)
    return f"{name} {found.status}: {'; '.join(found.objections)}.{' ' if cause else ''}{cause}"


def cause_sentence(v: Verification, model: Judged) -> str:
    """What makes the frequencies of a model deviate; "" where none does."""
    found = v.agreement(model)
    if not found.failing.any():
        return ""
    causes = v.causes.get(model, ())
    if not causes:
        return "No effect that it leaves out accounts for this."
    named = [cause for cause in causes if cause.effect != SAG]
    sag = EFFECT_WORDS[SAG]
    if not named:
        return (
            f"Cause: {sag}: with all other effects left out of the exact model, too, {percent(causes[-1].error)} "
            f"remain of {percent(worst(found))}."
        )
    names = ", then ".join(EFFECT_WORDS[cause.effect] for cause in named)
    steps = ", ".join(percent(cause.error) for cause in named)
    rest = f" The rest is {sag}." if len(named) < len(causes) else ""
    return (
        f"Cause: {names}. Left out of the exact model, too, the largest deviation falls from {percent(worst(found))} "
        f"to {steps}.{rest}"
    )


def what_to_do(v: Verification) -> str:
    """One or two sentences for the engineer: which model to use, and what to change."""
    exact, closed = v.agreement("exact"), v.agreement("dsm")
    if exact.status == "NOT DECIDED" and "exact" in v.judged:
        return "let the FEM refine further (--most-elements), or compare fewer modes (--modes)."
    if exact.failing.any() or (exact.objections and "exact" in v.judged):
        if v.assembly == "thesis":
            return "use --assembly consistent, the default, which has the geometric term."
        return (
            "use --model fem for this robot, and report its file: the exact model and the FEM have the same "
            "assumptions and must agree."
        )
    if closed.status != "DOES NOT HOLD":
        return "use the exact model, the default of all commands; the closed form (--model dsm) serves as well here."
    return f"use the exact model, the default of all commands, and not --model dsm. {_change(v)}".rstrip()


def _change(v: Verification) -> str:
    effects = {cause.effect for cause in v.causes.get("dsm", ())}
    if SAG in effects or "along_weight" in effects:
        return "A larger --lower-bound (or force_min) would tighten the cables and bring the two together."
    if "pulleys" in effects:
        return "Nothing is wrong with the robot file: the closed form has no pulleys."
    if effects:
        return "Nothing is wrong with the robot file."
    return ""


def geometric_text(v: Verification) -> str:
    """What eq. (3.8) as printed would change."""
    if math.isnan(v.geometric_effect):
        return "Without the geometric term of the attachments, which eq. (3.8) lacks, this equilibrium is unstable."
    if v.geometric_effect > 1.0 - 1e-3:
        return "Without the geometric term of the attachments, which eq. (3.8) lacks, a frequency falls to zero."
    return (
        "The geometric term of the rotating attachments, which eq. (3.8) lacks, changes frequencies by up to "
        f"{percent(v.geometric_effect)}."
    )


def violations_text(v: Verification) -> str:
    """Violated limits, grouped by parameter."""
    groups: dict[str, list[str]] = {}
    for item in v.limits.violations:
        key = f"{item.parameter} (limit {item.limit:.3g})"
        groups.setdefault(key, []).append(f"{item.cable}: {item.value:.3g}")
    return "; ".join(f"{key} cable {', '.join(values)}" for key, values in groups.items())


def worst(found: Agreement) -> float:
    """Largest relative deviation of the model [-]."""
    return float(abs(found.error).max())


def percent(ratio: float) -> str:
    """A ratio as percent with the digits that matter: three above 0.1 %, two below."""
    size = 100.0 * ratio
    if size >= 100.0:
        return f"{size:.0f} %"
    return f"{size:.3g} %" if size >= 0.1 else f"{size:.2g} %"
