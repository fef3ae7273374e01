"""What a recording of a motion says, as JSON, sentences and tables."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.recording import LengthErrors, Recording
from cdpr_struct.reports.diagnose.words import listed
from cdpr_struct.reports.html import HtmlTable

Row = Mapping[str, Any]
_MM = 1e3


def recording_json(found: Recording | None) -> dict[str, Any] | None:
    """Frames and what they count as, stretches, held-out lengths, and what is left beside a named cause."""
    if found is None:
        return None
    blocks, kept, rest = found.blocks, found.held_out, found.remainder
    return {
        "frames": found.frames, "states": found.states, "independent_frames": found.worth,
        "cause": None if blocks is None else blocks.cause,
        "stretches": [] if blocks is None else [
            {"start_s": start, "end_s": end, "estimate": own.tolist(), "sigma": sigma.tolist(), "gain_nats": gain}
            for start, end, own, sigma, gain in zip(
                blocks.start.tolist(), blocks.end.tolist(), blocks.estimate, blocks.sigma, blocks.gain.tolist(),
                strict=True,
            )
        ],
        "stretches_chi2_per_dof": None if blocks is None else blocks.chi2_per_dof,
        "sigma_factor": 1.0 if blocks is None else float(np.sqrt(blocks.dispersion)),
        "held_out_lengths": [] if kept is None else _lengths(kept),
        "explained_by_speed": _shares(found.speed_share),
        "explained_by_acceleration": _shares(found.acceleration_share),
        "p_of_speed": found.p_of_speed,
        "bend_of_speed": None if found.bend is None else {"size": found.bend.size, "p_value": found.bend.p},
        "remainder": None if rest is None else {
            "law": rest.law, "causes": list(rest.causes), "log_evidence_gain": rest.gain,
            "ahead_nats": rest.ahead, "rms_mm": (_MM * rest.size).tolist(),
        },
    }  # fmt: skip


def later_json(source: str, found: LengthErrors) -> dict[str, Any]:
    """Lengths of a campaign that nothing was fitted to."""
    return {"campaign": source, "states": found.frames, "cables": _lengths(found)}


def _lengths(found: LengthErrors) -> list[dict[str, Any]]:
    """Rms errors, cable by cable."""
    rows = zip(found.entered.tolist(), found.refitted.tolist(), found.named.tolist(), strict=True)
    return [
        {"cable": i, "as_entered_mm": _MM * a, "tolerances_fitted_mm": _MM * b, "with_causes_mm": _MM * c}
        for i, (a, b, c) in enumerate(rows, start=1)
    ]


def _shares(pair: tuple[float | None, float | None]) -> dict[str, float | None]:
    return {"before": pair[0], "after": pair[1]}


def condensed_sentence(found: Recording | None) -> str:
    """How many frames counted as how many states."""
    if found is None or found.states >= found.frames:
        return ""
    return (
        f"{found.frames} frames were condensed to {found.states} states; by the correlation of their errors they are "
        f"worth {found.worth:.0f} independent ones."
    )


def remainder_sentence(found: Recording | None) -> str:
    """What is left beside the named cause."""
    rest = None if found is None else found.remainder
    if found is None or rest is None:
        return ""
    low, high, share = _MM * rest.size.min(), _MM * rest.size.max(), found.speed_share[1]
    also = f" ({listed(rest.causes)} may have a part in it)" if rest.causes else ""
    speed = "" if share is None else f"; speed explains {max(0.0, 100.0 * share):.0f} % of its variance"
    return (
        f"A smaller error remains that no cause in the library explains{also}: it looks like {rest.law}. It leaves "
        f"{low:.1f} to {high:.1f} mm rms in the lengths{speed}."
    )


def gain_sentence(found: Recording | None) -> str:
    """How far the error of lengths falls in stretches that were not fitted."""
    kept = None if found is None else found.held_out
    if kept is None:
        return ""
    before, middle, after = (_MM * float(np.sqrt(np.mean(own**2))) for own in (kept.entered, kept.refitted, kept.named))
    return (
        f"In stretches of the recording that were not fitted the lengths are off by {after:.1f} mm rms, against "
        f"{before:.1f} mm as entered and {middle:.1f} mm with the tolerances fitted alone."
    )


def unnamed_motion_sentence(found: Recording | None) -> str:
    """Why no cause is named although one was fitted."""
    if found is None or not found.unnamed_motion:
        return ""
    if found.bend is not None and found.bend.matters:
        return (
            "The errors of the lengths change with speed, but not in proportion to it, as those of a delay would: what "
            f"bends is {100.0 * found.bend.size:.0f} % of it (p = {found.bend.p:.2g}). This is a law of motion that is "
            "not in the library."
        )
    if found.speed_share[1] is None:
        return ""
    return (
        f"What the best cause leaves of the lengths is a function of speed ({100.0 * found.speed_share[1]:.0f} % of "
        f"its variance, p = {found.p_of_speed:.2g}): a law of motion that is not in the library."
    )


def stretch_table(result: Row) -> HtmlTable | None:
    """Estimates of each stretch."""
    said = result["recording"]
    if said is None or not said["stretches"]:
        return None
    rows = [
        [f"{one['start_s']:.0f} to {one['end_s']:.0f}", _numbers(one["estimate"]), _numbers(one["sigma"]),
         f"{one['gain_nats']:.0f}"]
        for one in said["stretches"]
    ]  # fmt: skip
    note = f"Each stretch on its own; chi2/dof about the common mean: {said['stretches_chi2_per_dof']:.1f}. The sigma "
    note += f"of the whole is widened by {said['sigma_factor']:.2f}. Evidence: what the stretch adds."
    title = f"{said['cause'].replace('_', ' ').capitalize()} by stretch"
    return HtmlTable(title, ["time [s]", "estimate", "sigma", "evidence [nats]"], rows, note)


def length_tables(result: Row) -> list[HtmlTable]:
    """Held-out lengths, and those of a later campaign, cable by cable."""
    said, later = result["recording"], result.get("later_lengths")
    found = []
    if said is not None and said["held_out_lengths"]:
        found.append(_length_table("Cable lengths in stretches that were not fitted", said["held_out_lengths"]))
    if later is not None:
        found.append(_length_table(f"Cable lengths of {later['campaign']}, {later['states']} states", later["cables"]))
    return found


def _length_table(title: str, rows: Sequence[Row]) -> HtmlTable:
    keys = ("as_entered_mm", "tolerances_fitted_mm", "with_causes_mm")
    shown = [[str(row["cable"]), *(f"{row[key]:.2f}" for key in keys)] for row in rows]
    note = "Rms of measured less predicted at the measured poses, in mm."
    return HtmlTable(title, ["cable", "as entered", "tolerances fitted", "with the causes"], shown, note)


def _numbers(values: Sequence[float]) -> str:
    return " ".join(f"{value:.4f}" for value in values)
