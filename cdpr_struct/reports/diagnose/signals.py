"""What the signals of a campaign gave: identified peaks and the damping law, as JSON, sentence, table and figures."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.damped import Damped
from cdpr_struct.diagnosis.damping_law import SCATTER, UNITS, DampingFinding, LawFit
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.reports.diagnose.amplitudes import amplitude_plates
from cdpr_struct.reports.diagnose.words import listed, plain
from cdpr_struct.reports.figures import signals as figures
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Plate

LAWS = ("viscous_damping", "hysteretic_damping", "coulomb_damping")
MOST_ROWS = 4  # laws among the candidates
_MOST_PLATES = 6


def signal_json(item: Identified) -> dict[str, Any]:
    """One record."""
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


def damping_json(found: Damped) -> dict[str, Any]:
    """The damping finding."""
    finding, rows = found.finding, found.finding.rows
    return {
        "status": finding.status, "causes": list(finding.causes), "reason": finding.reason,
        "sentence": damping_sentence(finding), "candidates": [law_row(fit) for fit in finding.fits],
        "measured": [
            {
                "case": rows.case[i], "frequency_hz": float(rows.hertz[i]), "damping_ratio": float(rows.ratio[i]),
                "sigma": float(rows.sigma[i]), "entered": float(rows.entered[i]),
                "amplitude_m": float(rows.amplitude[i]) if np.isfinite(rows.amplitude[i]) else None,
            }
            for i in range(len(rows))
        ],
        "left_out": [{"case": case, "frequency_hz": hertz, "reason": why} for case, hertz, why in found.left_out],
    }  # fmt: skip


def law_row(fit: LawFit) -> dict[str, Any]:
    """A law as a row of the candidates."""
    return {
        "cause": fit.causes[0], "with": list(fit.causes[1:]), "pattern": fit.pattern, "heldout_rms": None,
        "explained_fraction": None, "log_evidence_gain": fit.gain, "p_adequate": fit.p_adequate,
        "parameters": {
            name: {"value": middle, "sigma": 0.25 * (high - low), "low": low, "high": high, "unit": UNITS[name]}
            for name, (middle, low, high) in fit.sizes.items()
        },
    }  # fmt: skip


def silent(item: Identified) -> str:
    """Why a record adds no frequency."""
    why = (
        item.note
        or f"none of its {len(item.modes)} peaks is both clear and a mode of the robot (see the table of peaks)"
    )
    return f"{item.record.kind} {item.record.case} adds no frequency: {why.rstrip('.')}."


def untestable(finding: DampingFinding) -> dict[str, str]:
    """Laws of damping that these data cannot show, and why."""
    if finding.reason:
        return dict.fromkeys(LAWS, finding.reason)
    if not np.isfinite(finding.rows.amplitude).all():
        return {"coulomb_damping": "needs decays at two or more amplitudes; FRFs have none"}
    return {}


def damping_sentence(finding: DampingFinding) -> str:
    """What the damping says, in one sentence; nothing if nothing stands out."""
    if finding.reason == SCATTER:
        return f"No statement on the damping: {SCATTER}."
    if finding.status in ("adequate", "not testable"):
        return ""
    best = finding.fits[0]
    sizes = ", ".join(
        f"{plain(name)} {middle:.2g} ({low:.2g} to {high:.2g}) {UNITS[name]}".strip()
        for name, (middle, low, high) in best.sizes.items()
    )
    words = listed(best.causes)
    if finding.status == "unknown":
        lead = "The damping differs from the entered one, and no law fits it"
        return f"{lead}; the best law, {words}, leaves residuals beyond noise."
    if finding.status == "class":
        return f"The damping differs from the entered one; these data do not distinguish {listed(finding.causes)}."
    return f"The damping follows the law of {words}: {sizes}."


def signal_plates(found: Damped | None, entered: tuple[Identified, ...]) -> list[Plate]:
    """Spectra with identified peaks, and damping ratios over amplitude."""
    plates = [_plate(f"signal-{i + 1}", item) for i, item in enumerate(entered[:_MOST_PLATES])]
    if found is not None and np.isfinite(found.finding.rows.amplitude).any():
        plates.append(
            Plate(
                "damping",
                "Damping ratio over amplitude",
                Drawing("damping", figures.DAMPING_SIZE, lambda f: figures.draw_damping(f, found.finding.rows)),
                "One line per mode and record, one point per window of the decay, or one for the whole record where "
                "that is more accurate. Bars: two sigma; dashes: the entered law. Level lines indicate viscous or "
                "structural damping, lines that rise towards small amplitudes indicate friction.",
            )
        )
    return [*plates, *([] if found is None else amplitude_plates(found.amplitude))]


def _plate(name: str, item: Identified) -> Plate:
    return Plate(
        name,
        f"Peaks in {item.record.case} ({plain(item.record.kind)})",
        Drawing(name, figures.SPECTRUM_SIZE, lambda f: figures.draw_spectrum(f, item)),
        "Measured spectrum. Blue dots: peaks used as robot frequencies. Orange rings: peaks not used, because they are "
        "weak, have no matching mode, or are combination tones of a large motion. Triangles: peaks without a fitted "
        "mode, for example where several lie closer than their widths. Vertical lines: modes of the model, black where "
        "the platform moves. Compare each black line with the nearest blue dot: the distance is the frequency error.",
    )


def signal_table(result: Mapping[str, Any]) -> HtmlTable | None:
    """Identified peaks, with what became of each."""
    rows = [
        [
            signal["case"], f"{m['frequency_hz']:.4f} ± {m['sigma_hz']:.2g}",
            f"{100.0 * m['damping_ratio']:.2f} ± {100.0 * m['damping_sigma']:.2g}",
            "" if m["model_hz"] is None else f"{m['model_hz']:.4f}", "used" if m["used"] else m["reason"],
        ]
        for signal in result["signals"]
        for m in signal["modes"]
    ]  # fmt: skip
    notes = [[s["case"], "", "", "", s["note"]] for s in result["signals"] if s["note"]]
    head = ["case", "frequency [Hz]", "damping ratio [%]", "model [Hz]", "result"]
    return HtmlTable("Peaks identified in the signals", head, rows + notes) if rows + notes else None
