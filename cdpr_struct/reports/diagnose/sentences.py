"""The verdict in plain sentences."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.diagnosis.decision import fits
from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.drift import CELLS, ENCODERS, TRACKER
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.reports.diagnose.amplitudes import amplitude_sentence
from cdpr_struct.reports.diagnose.corrected_columns import corrected
from cdpr_struct.reports.diagnose.recordings import (
    condensed_sentence,
    gain_sentence,
    remainder_sentence,
    unnamed_motion_sentence,
)
from cdpr_struct.reports.diagnose.signals import damping_sentence
from cdpr_struct.reports.diagnose.words import described, listed, place, plain, reading
from cdpr_struct.reports.text import with_sigma

LARGEST_CLASS = 4  # causes beyond which a sentence leads with none of them
_NULL_SPACE = internal_force.CAUSE.name
_LISTS = 2  # of peaks that one sentence shows
_MOST = 4  # readings that one sentence lists
_NEAR = 3.0  # nats, a factor of twenty in probability
_BETTER = 1.05  # times smaller error from which a prediction is better
_FAR = 30.0  # times its stated sigma from which the scatter of a sensor means another robot or unit


def sentence(found: Diagnosis) -> str:
    """What was found, for a person."""
    status = found.fitted.status
    if found.by_damping:
        parts = [_damping(found), _forces(found) or "No other error is significant."]
    elif found.by_peaks:
        parts = [_apart(found)]
    elif status == "adequate":
        parts = [_forces(found) or agreement(found)]
    elif status == UNKNOWN:
        parts = _unknown(found)
    else:
        parts = _named(found)
    parts += [condensed_sentence(found.recording)]
    parts += ["" if found.by_peaks else _peaks(found), _line(found), _aside(found), _drift(found)]
    if not found.by_damping:
        parts += [_forces(found) if status != "adequate" else "", _damping(found)]
    if found.damped is not None:
        parts.append(amplitude_sentence(found.damped.amplitude))
    return " ".join(filter(None, parts))


def _forces(found: Diagnosis) -> str:
    """Internal forces that lengths and load cells show together."""
    forces = found.forces
    if forces is None or not forces.found or _NULL_SPACE in sum(found.fitted.classes, ()):
        return ""
    share = 100.0 * forces.split.share
    lead = "The forces balance; the" if found.fitted.status == "adequate" else "In addition, the"
    return (
        f"{lead} robot holds other internal forces than the simulation commands: {forces.size:.2g} N rms over the "
        f"cables and states. Of the squared difference between measured and simulated tensions, {share.min():.0f} to "
        f"{share.max():.0f} % is internal force."
    )


def _apart(found: Diagnosis) -> str:
    """Peaks far from all modes: measured, predicted, the factor, and what would do it."""
    apart = found.apart
    if apart is None:
        return ""
    lists = [
        f"{' '.join(f'{f:.3g}' for f in one.measured)} Hz are measured in case {one.case}, where the modes that move "
        f"the platform are predicted at {' '.join(f'{f:.3g}' for f in one.predicted)} Hz"
        for one in apart.lists[:_LISTS]
    ]
    shares = {"axial_stiffness": apart.stiffness_per_mass, "platform_mass": 1.0 / apart.stiffness_per_mass}
    could = [plain(n) + (f" (about {shares[n]:.2g} times as entered)" if n in shares else "") for n in apart.names]
    side = "above" if apart.factor > 1.0 else "below"
    return (
        f"The measured robot frequencies lie far {side} those of the simulation, by a factor of about "
        f"{apart.factor:.2f} (p = {apart.p:.2g}): {'; '.join(lists)}. That is {apart.stiffness_per_mass:.2g} times the "
        f"stiffness per mass. Possible causes: {', '.join(could)}. Which peak is which mode is not certain, so none of "
        "them is fitted."
    )


def _line(found: Diagnosis) -> str:
    """A line of constant frequency among the peaks."""
    for part, z in zip(found.chosen.hypothesis.parts, found.chosen.sizes, strict=True):
        if part.cause.outside:
            hertz = float(z[0] * part.term.sigma[0])
            return (
                f"Peaks near {hertz:.3g} Hz at all poses belong to no mode of the robot: a disturbance of constant "
                "frequency, or a light part of the platform on an elastic mount."
            )
    return ""


def agreement(found: Diagnosis) -> str:
    """Where nothing is significant; peaks that cannot be assigned to a mode are reported as no evidence."""
    p = f"(p = {found.p_value:.2g})."
    wrong = [one.kind for one in found.noise if 2 * one.outliers > one.readings]
    if wrong:
        return (
            f"No cause is significant {p} However, most of the {listed(wrong)} readings differ from the simulation by "
            "far more than their sigmas and count as outliers, so they are no evidence for or against any cause."
        )
    uncertain, count = found.peaks.uncertain, found.peaks.count
    if not uncertain:
        rest = "the other measurements" if found.set_aside else "measurements"
        return f"No significant error: simulation and {rest} agree within their uncertainty {p}"
    some = ", ".join(f"{peak.hertz:g}" for peak in uncertain[:6]) + (", ..." if len(uncertain) > 6 else "")
    text = f"No significant error {p} However, {len(uncertain)} of {count} robot frequencies ({some} Hz) cannot be"
    text += " assigned to a mode with certainty, which is no evidence for or against the simulation."
    return text + (" The other readings agree within their uncertainty." if len(uncertain) < count else "")


def _named(found: Diagnosis) -> list[str]:
    """Corrections and causes with their sizes, what is not told apart, what they explain."""
    parts = [] if found.correction is None else [corrected(found.campaign, found.correction)]
    own = [names for names in found.fitted.classes if not _of_correction(found, names)]
    if any(len(names) > LARGEST_CLASS for names in own):
        lead = [f"{said[:1].upper()}{said[1:]}." for said in parts]
        left = " and, in addition, ".join(_many(names) for names in own)
        return [*lead, f"There is a significant error in {place(found.location)}. Possible causes: {left}."]
    for size in found.sizes:
        names = next((n for n in own if size.part.cause.name in n), ())
        doubted = found.fitted.doubted or not found.confirmed
        lead_of = "best candidate of its class: " if len(names) > 1 else "best candidate: " if doubted else ""
        parts.append(lead_of + described(size))
    text = "; ".join(parts)
    said = [f"{text[:1].upper()}{text[1:]}."]
    said += [f"These data do not distinguish {listed(names)}." for names in found.fitted.classes if len(names) > 1]
    said += _without_change(found, own)
    return [*said, _other_corrections(found), _standing(found)]


def _without_change(found: Diagnosis, classes: Sequence[tuple[str, ...]]) -> list[str]:
    """Causes that the verdict speaks of although their fitted size is none."""
    fitted = [one for one in found.candidates if len(one.names) == len(classes) and fits(tuple(classes), one.names)]
    none: dict[str, str] = {}
    for size in (size for one in fitted for size in one.sizes if not size.is_change):
        cause, (name, first) = size.part.cause.name, next(iter(size.parameters.items()))
        value = with_sigma(float(first["value"]), float(first["sigma"]))
        none.setdefault(cause, f"{plain(cause)} ({name} {value} {first['unit']})")
    told = ", ".join(none.values())
    return [f"Fitted without a change, and possible only since these data hardly show it: {told}."] if none else []


def _other_corrections(found: Diagnosis) -> str:
    """Corrections of the same kind that are nearly as likely."""
    if found.correction is None:
        return ""
    own, *others = found.tried
    near = [
        one.correction.sentence
        for one in others
        if one.correction.cause == found.correction.cause and one.gain > own.gain - _NEAR
    ]
    return f"Nearly as likely: {'; or '.join(near[:_MOST])}." if near else ""


def _of_correction(found: Diagnosis, names: tuple[str, ...]) -> bool:
    return found.correction is not None and found.correction.cause in names


def _many(names: tuple[str, ...]) -> str:
    """The causes of a class too large to lead with one of them, or the only one."""
    return f"{len(names)} causes ({', '.join(map(plain, names))})" if len(names) > 1 else plain(names[0])


def _standing(found: Diagnosis) -> str:
    """What the chosen causes account for, and whether what was left out agrees."""
    if not found.sizes:
        return "With this correction all readings agree within their uncertainty."
    chosen = next((one for one in found.candidates if one.best is found.chosen), None)
    share = 0.0 if chosen is None else 100.0 * chosen.explained
    rest, left = remainder_sentence(found.recording), found.left_out
    said = [f"This accounts for {share:.0f} % of the error beyond noise."] if share >= 0.5 and not rest else []
    if left is None and found.added is None:
        return " ".join([*said, "A single state leaves no held-out data to confirm it."])
    if not found.confirmed:
        return " ".join([*said, "It rests on one part of the data; held-out data do not confirm it."])
    if found.added is not None:
        said.append(f"Without the peaks of any one state the evidence for the mode is still {found.added:.0f} nats.")
    if left is not None:
        ratio = left.ratio(left.concerned)
        fall = f"falls by a factor of {ratio:.1f}" if ratio > _BETTER else "is no smaller"
        kept = gain_sentence(found.recording)
        said.append(kept or f"In held-out states the prediction error of the affected readings {fall}.")
    return " ".join(filter(None, [*said, rest]))


def _unknown(found: Diagnosis) -> list[str]:
    """What no cause explains: where it is, what comes nearest, through what it acts."""
    parts = [f"There is a significant error in {place(found.location)}, and no cause in the library explains it."]
    parts += [unnamed_motion_sentence(found.recording)]
    pile = found.piled_up
    if pile is not None:
        parts.append(
            f"{pile.outliers} of {pile.readings} {pile.kind} readings of cable {pile.cable + 1} are outliers, and few "
            "of the other cables: this sensor or this cable has an error of its own."
        )
    if found.correction is not None:
        parts.append(f"A correction of the data ({found.correction.sentence}) accounts for part of it only.")
    best = next((one for one in found.candidates if one.has_size), None)
    if best is not None:
        parts.append(f"The best candidate, {listed(best.names, 'with')}, leaves residuals beyond noise.")
    law, gain = found.outside
    if law and gain > 0.0:
        parts.append(f"The best description of the error is {law}.")
    parts += _left_at_random(found)
    if any(one.factor > _FAR for one in found.noise):
        parts.append(
            "The scatter is far larger than wear or slip can cause. Check that the campaign names the robot that was "
            "measured, and that all files use its axes and units."
        )
    return parts


def _rms(parts: Sequence[float]) -> str:
    return ", ".join(f"{part:.2g}" for part in parts)


def _left_at_random(found: Diagnosis) -> list[str]:
    """How large what is left is, for predictions."""
    left = found.left_at_random
    if left is None:
        return []
    peaks = f", and frequencies scatter by {100.0 * left.frequency:.2g} %" if left.frequency else ""
    return [
        f"For predictions it counts as random, new at every rest: a force of {_rms(left.force_N)} N and a moment of "
        f"{_rms(left.moment_Nm)} N m (rms along x, y, z), lengths off by {1e3 * left.length_m:.2g} mm each and "
        f"{1e3 * left.common_length_m:.2g} mm all alike{peaks}. Bands of the extended robot hold it."
    ]


def _peaks(found: Diagnosis) -> str:
    """Peaks that are no mode of the chosen model, where something is wrong."""
    none = [peak for peak in found.peaks.uncertain if peak.none > 0.5]
    if found.fitted.status == "adequate" or not none:
        return ""
    some = ", ".join(f"{peak.hertz:g}" for peak in none[:_MOST]) + (", ..." if len(none) > _MOST else "")
    return f"{len(none)} of {found.peaks.count} robot frequencies match no mode of the model ({some} Hz)."


def _aside(found: Diagnosis) -> str:
    """Which readings contradict all others."""
    rows = found.set_aside
    if not rows:
        return ""
    places = [
        f"{reading(row.kind, row.case, row.cable, row.hertz)} (off by {row.sigmas:.0f} sigma)" for row in rows[:_MOST]
    ]
    more = f"; {len(rows) - _MOST} more" if len(rows) > _MOST else ""
    lead = "One reading contradicts all others" if len(rows) == 1 else f"{len(rows)} readings contradict all others"
    return f"{lead}: {'; '.join(places)}{more}."


def _drift(found: Diagnosis) -> str:
    """Which sensors drift, and how far; or that readings of one sensor are off alike."""
    if found.noise_correlation:
        return (
            f"The noise of the sensors is correlated from one reading to the next (by {found.noise_correlation:.1f}), "
            "so that readings in a row count as fewer."
        )
    if found.drift is None:
        return ""
    size, turn = found.drift.size, found.drift.turn
    return {
        CELLS: f"The zeros of the load cells drift by {size:.2g} N (rms over the cells) during the campaign.",
        TRACKER: f"The tracker drifts by {1e3 * size:.2g} mm and {1e3 * turn:.2g} mrad (rms over the axes) "
        "during the campaign.",
        ENCODERS: f"The encoders drift by {1e3 * size:.2g} mm (rms over the cables) during the campaign.",
    }[found.drift.sensor]


def _damping(found: Diagnosis) -> str:
    return "" if found.damped is None else damping_sentence(found.damped.finding)


def finite(value: float) -> float | None:
    """A number as JSON may hold it."""
    return float(value) if np.isfinite(value) else None
