"""What the signals of a campaign gave: identified peaks and the damping law, joined to a diagnosis' result."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.damping_law import SCATTER, UNITS, DampingFinding, LawFit, damping_finding
from cdpr_struct.diagnosis.damping_rows import damping_rows, left_out
from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.extended_model import extended_robot
from cdpr_struct.diagnosis.wording import listed
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.signal_states import held_against
from cdpr_struct.reports.figures import signals as figures
from cdpr_struct.reports.figures.style import svg
from cdpr_struct.reports.html import HtmlTable, Plate

_LAWS = ("viscous_damping", "hysteretic_damping", "coulomb_damping")
_MOST_PLATES = 6
"""Figures that only signals have."""


def with_signals(result: dict[str, Any], found: Diagnosis) -> dict[str, Any]:
    """The result with `signals` and `damping`; damping that stands out speaks up where nothing else does."""
    campaign = found.campaign
    if not campaign.identified:
        return result | {"signals": [], "damping": None}
    judged = judged_signals(found, result)
    finding = damping_finding(damping_rows(judged), campaign.tolerances.damping)
    silent = [item for item in campaign.identified if not item.used.any()]
    why = {k: v for k, v in result["why_not_testable"].items() if k not in _LAWS} | _untestable(finding)
    more = {
        "signals": [_signal(item) for item in campaign.identified],
        "damping": _damping(finding) | {"left_out": _left_out(judged)},
        "why_not_testable": why,
        "not_testable": sorted(why),
        "not_used": sorted({item.record.kind for item in silent}),
        "warnings": [*result["warnings"], *map(_silent, silent)],
        "verdict": _spoken(result["verdict"], finding),
    }
    if finding.causes:
        more["candidates"] = [*result["candidates"], *(_candidate(f) for f in finding.fits[:4])]
    return result | more


def judged_signals(found: Diagnosis, result: Mapping[str, Any]) -> tuple[Identified, ...]:
    """The signals held against the fitted robot where a cause is known, whose modes are damped otherwise."""
    campaign = found.campaign
    if result["verdict"]["status"] not in ("named", "class") or found.selection.fit is None:
        return campaign.identified
    robot = extended_robot(found)
    return tuple(held_against(item, robot, campaign.model) for item in campaign.identified)


def _silent(item: Identified) -> str:
    """Why a record adds no frequency."""
    why = item.note or f"{len(item.modes)} peaks, none of them clear and the robot's own (see the table of peaks)"
    return f"{item.record.kind} {item.record.case} adds no frequency: {why.rstrip('.')}."


def _left_out(judged: tuple[Identified, ...]) -> list[dict[str, Any]]:
    return [{"case": case, "frequency_hz": hertz, "reason": why} for case, hertz, why in left_out(judged)]


def _untestable(finding: DampingFinding) -> dict[str, str]:
    if finding.reason:
        return dict.fromkeys(_LAWS, finding.reason)
    if not np.isfinite(finding.rows.amplitude).all():
        return {"coulomb_damping": "needs decays at two or more amplitudes; FRFs have none"}
    return {}


def _signal(item: Identified) -> dict[str, Any]:
    """One record as JSON."""
    modes, state = item.modes, item.state
    rows = []
    for i in range(len(modes)):
        partner = int(item.partner[i])
        rows.append(
            {
                "frequency_hz": float(modes.hertz[i]), "sigma_hz": float(item.sigma[i]),
                "damping_ratio": float(modes.damping[i]), "damping_sigma": float(modes.damping_sigma[i]),
                "strength": float(modes.strength[i]), "kind": item.kinds[i],
                "model_hz": float(state.hertz[partner]) if state is not None and partner >= 0 else None,
                "used": bool(item.used[i]), "reason": item.reason[i],
            }
        )  # fmt: skip
    return {"kind": item.record.kind, "case": item.record.case, "note": item.note, "modes": rows}


def _candidate(fit: LawFit) -> dict[str, Any]:
    return {
        "cause": fit.causes[0], "with": list(fit.causes[1:]), "pattern": fit.pattern, "heldout_rms": None,
        "explained_fraction": None, "log_evidence_gain": fit.gain, "p_adequate": fit.p_adequate,
        "parameters": {
            name: {"value": middle, "sigma": 0.25 * (high - low), "low": low, "high": high, "unit": UNITS[name]}
            for name, (middle, low, high) in fit.sizes.items()
        },
    }  # fmt: skip


def _damping(finding: DampingFinding) -> dict[str, Any]:
    rows = finding.rows
    return {
        "status": finding.status, "causes": list(finding.causes), "reason": finding.reason,
        "sentence": damping_sentence(finding), "candidates": [_candidate(f) for f in finding.fits],
        "measured": [
            {
                "case": rows.case[i], "frequency_hz": float(rows.hertz[i]), "damping_ratio": float(rows.ratio[i]),
                "sigma": float(rows.sigma[i]), "entered": float(rows.entered[i]),
                "amplitude_m": float(rows.amplitude[i]) if np.isfinite(rows.amplitude[i]) else None,
            }
            for i in range(len(rows))
        ],
    }  # fmt: skip


def damping_sentence(finding: DampingFinding) -> str:
    """What the damping says, in one sentence; nothing if nothing stands out."""
    if finding.reason == SCATTER:
        return f"No statement on the damping: {SCATTER}."
    if finding.status in ("adequate", "not testable"):
        return ""
    best = finding.fits[0]
    sizes = ", ".join(
        f"{name.replace('_', ' ')} {middle:.2g} ({low:.2g} to {high:.2g}) {UNITS[name]}".strip()
        for name, (middle, low, high) in best.sizes.items()
    )
    words = listed(best.causes)
    if finding.status == "unknown":
        return f"The damping is not the entered one, and no law fits it; the best, {words}, leaves more than noise."
    if finding.status == "class":
        return f"The damping is not the entered one; these data do not tell {listed(finding.causes)} apart."
    return f"The damping is that of {words}: {sizes}."


def _spoken(verdict: dict[str, Any], finding: DampingFinding) -> dict[str, Any]:
    """The verdict with the damping's sentence; where nothing else is wrong, the damping is the verdict."""
    text = damping_sentence(finding)
    if not text or finding.status == "not testable":
        return verdict
    if verdict["status"] != "adequate" or finding.status == "unknown":
        return verdict | {"sentence": f"{verdict['sentence']} {text}"}
    return verdict | {
        "status": finding.status, "causes": list(finding.causes), "class": [list(finding.causes)],
        "sentence": f"{text} Nothing else is significant.", "location": "the damping ratios",
        "next_measurement": "decays from two or more amplitudes, four or more modes",
    }  # fmt: skip


def signal_plates(found: Diagnosis, result: Mapping[str, Any]) -> list[Plate]:
    """Spectra with identified peaks, and damping ratios over amplitude."""
    identified = found.campaign.identified
    plates = [_plate(f"signal-{i + 1}", item) for i, item in enumerate(identified[:_MOST_PLATES])]
    rows = damping_rows(judged_signals(found, result))
    if np.isfinite(rows.amplitude).any():
        plates.append(
            Plate(
                "damping",
                "Damping ratio over amplitude",
                svg("damping", figures.DAMPING_SIZE, lambda f: figures.draw_damping(f, rows)),
                "One line per mode and record, one point per window of the decay, or one for the whole where that says "
                "more; bars are two sigma, dashes what the entered law gives. Level lines mean viscous or "
                "structural damping; lines that rise towards small amplitudes mean friction.",
            )
        )
    return plates


def _plate(name: str, item: Identified) -> Plate:
    return Plate(
        name,
        f"Peaks in {item.record.case} ({item.record.kind.replace('_', ' ')})",
        svg(name, figures.SPECTRUM_SIZE, lambda f: figures.draw_spectrum(f, item)),
        "Measured spectrum. Blue dots: peaks that joined the campaign as robot frequencies; orange rings: peaks that "
        "did not, being combination tones of a motion that is not small, weak, or without partner; triangles: peaks "
        "to which no mode was fitted, as where several lie closer than their widths. Upright lines: the model's modes, "
        "black where the platform moves. See whether each black line has a blue dot on it, and to which side it "
        "misses.",
    )


def signal_tables(result: dict[str, Any]) -> list[HtmlTable]:
    """Identified peaks, with what became of each."""
    rows = [
        [
            signal["case"], f"{m['frequency_hz']:.4f} ± {m['sigma_hz']:.2g}",
            f"{100.0 * m['damping_ratio']:.2f} ± {100.0 * m['damping_sigma']:.2g}",
            "" if m["model_hz"] is None else f"{m['model_hz']:.4f}", "used" if m["used"] else m["reason"],
        ]
        for signal in result.get("signals", ())
        for m in signal["modes"]
    ]  # fmt: skip
    notes = [[s["case"], "", "", "", s["note"]] for s in result.get("signals", ()) if s["note"]]
    if not rows + notes:
        return []
    head = ["case", "frequency [Hz]", "damping ratio [%]", "model [Hz]", "what became of it"]
    return [HtmlTable("Peaks identified in the signals", head, rows + notes)]
