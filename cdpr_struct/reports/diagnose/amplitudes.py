"""Why frequencies change with the amplitude of a decay, as JSON, sentence and figure."""

import math
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.amplitude_law import AmplitudeFinding, FrictionFit, Sized, changes, held_out_rms
from cdpr_struct.diagnosis.amplitude_rows import BOTH, FRAME, PLATFORM_ENDS
from cdpr_struct.reports.figures import amplitudes as figures
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import Plate

_WORDS = {
    BOTH: "both ends of the cables", FRAME: "the frame ends of the cables",
    PLATFORM_ENDS: "the platform ends of the cables",
}  # fmt: skip


def amplitude_json(found: AmplitudeFinding | None) -> dict[str, Any] | None:
    """The finding; null where no decay was read in windows."""
    if found is None:
        return None
    told = {"status": found.status, "p_value": found.p_still, "sentence": amplitude_sentence(found)}
    rows = found.rows
    if rows is None:
        return {**told, "large_motion_gain": None, "friction": [], "measured": [], "held_out_error": {}}
    best = found.fits[0]
    return {
        **told,
        "large_motion_gain": found.large_gain,
        "friction": [_friction(fit) for fit in found.fits],
        "held_out_error": {
            "nothing": held_out_rms(rows, 0.0), "large_motion": held_out_rms(rows, rows.large),
            "friction": held_out_rms(rows, rows.large + best.held_out),
        },
        "measured": [
            {
                "case": rows.case[i], "frequency_hz": math.exp(rows.log_hertz[i]), "sigma": float(rows.hertz_sigma[i]),
                "amplitude_m": float(rows.amplitude[i]), "large_motion": float(rows.large[i]),
                "friction": float(best.shift[i]), "friction_held_out": float(best.held_out[i]),
            }
            for i in range(len(rows))
        ],
    }  # fmt: skip


def _friction(fit: FrictionFit) -> dict[str, Any]:
    return {
        "log_evidence_gain": fit.gain,
        "ends": [
            {
                "where": part.ends,
                "friction_radius": _sized(part.radius, "m"),
                "presliding_angle": _sized(part.angle, "rad"),
            }
            for part in fit.parts
        ],
    }


def _sized(value: Sized, unit: str) -> dict[str, Any]:
    return {"value": value[0], "low": value[1], "high": value[2], "unit": unit}


def amplitude_sentence(found: AmplitudeFinding | None) -> str:
    """What changes the frequencies of decays; nothing where they do not change."""
    if found is None or found.status == "adequate":
        return ""
    rows = found.rows
    if rows is None:
        return "Frequencies change with the amplitude of the decays, for a reason that was not looked for."
    recorded, large = (100.0 * float(np.median(changes(rows, v))) for v in (rows.log_hertz, rows.large))
    lead = (
        f"From the first to the last window of the decays frequencies change by {recorded:+.2f} % in the median; "
        f"large motion alone predicts {large:+.2f} %"
    )
    if found.status == "large_motion":
        return f"{lead}, and no friction is needed for the rest."
    if found.status == "unknown":
        return f"{lead}, and no friction at the ends of the cables explains the rest."
    best = found.fits[0]
    both = 100.0 * float(np.median(changes(rows, rows.large + best.held_out)))
    error = [100.0 * held_out_rms(rows, shift) for shift in (rows.large, rows.large + best.held_out)]
    sizes = " and ".join(
        f"at {_WORDS[part.ends]} (moment over tension {1e3 * part.radius[0]:.2g} mm, built up over "
        f"{math.degrees(part.angle[0]):.2g} deg)"
        for part in best.parts
    )
    return (
        f"{lead}, and {both:+.2f} % with dry friction {sizes}, each record predicted by the others. The error of these "
        f"predictions falls from {error[0]:.2f} to {error[1]:.2f} %.{_elsewhere(found)}"
    )


def _elsewhere(found: AmplitudeFinding) -> str:
    """At which other ends friction would do as well."""
    others = [" and ".join(_WORDS[part.ends] for part in fit.parts) for fit in found.rivals[1:]]
    return f" Friction at {', or at '.join(others)} explains it as well." if others else ""


def amplitude_plates(found: AmplitudeFinding | None) -> list[Plate]:
    """Frequency over amplitude, where it changes."""
    if found is None or found.rows is None:
        return []
    return [
        Plate(
            "amplitudes",
            "Frequency over amplitude",
            Drawing("amplitudes", figures.SIZE, lambda f: figures.draw_amplitudes(f, found)),
            figures.CAPTION,
        )
    ]
