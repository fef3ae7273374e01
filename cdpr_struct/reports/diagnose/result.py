"""A diagnosis as result.json: names are fixed, scripts read them."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.decision import fits
from cdpr_struct.diagnosis.diagnosis import Candidate, Diagnosis, Tried
from cdpr_struct.diagnosis.left_out import LeftOut
from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.drift import CELLS, ENCODERS, TRACKER
from cdpr_struct.hypotheses.judge import NEAR
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.planning.recommendations import Recommendation
from cdpr_struct.reports.ambient_result import record_json
from cdpr_struct.reports.diagnose import signals
from cdpr_struct.reports.diagnose.amplitudes import amplitude_json
from cdpr_struct.reports.diagnose.corrected_columns import corrected
from cdpr_struct.reports.diagnose.recordings import recording_json
from cdpr_struct.reports.diagnose.sentences import finite, sentence
from cdpr_struct.reports.diagnose.state_errors import state_errors
from cdpr_struct.reports.diagnose.words import doubt, place, recommendation
from cdpr_struct.reports.plan.measurements import recommendation_text
from cdpr_struct.reports.tolerances_told import tolerances_told
from cdpr_struct.reports.trust import Check, Trust

RADIAN = 57.29577951308232  # deg
KINDS = {
    "EQ": ("static_state (wrench balance)", 1.0, "N"), "CO": ("static_state (cable lengths)", 1e3, "mm"),
    "CF": ("cable_frequency", 100.0, "%"), "RF": ("robot_frequency", 100.0, "%"),
    "FA": ("frf (modal constants)", 100.0, "%"), "SW": ("static_state (swivel angles)", RADIAN, "deg"),
}  # fmt: skip
"""Of each kind of rows: name, factor from what is computed with, unit that is shown."""


MOST_REPEATED = 4  # readings that are proposed to be read again


def result_json(found: Diagnosis, simulated: Sequence[Recommendation] = ()) -> dict[str, Any]:
    """result.json of `diagnose`; simulated measurements stand before those that the library names."""
    hidden, law = _hidden(found), found.outside
    steps = list(map(recommendation_text, simulated))
    steps += [step for step in _next(found) if not _is_among(step, steps)]
    return {
        "campaign": found.campaign.source,
        "robot": found.campaign.robot_name,
        "model": found.campaign.model,
        "simulation_error": [_error(found, i) for i in range(len(found.errors))],
        "errors_by_state": state_errors(found),
        "significant": found.decision.status != "adequate",
        "p_value": found.p_value,
        "p_value_of": "evidence",
        "p_adequate": found.p_adequate,
        "verdict": _verdict(found, steps),
        "next_measurements": steps,
        "probabilities": [{"causes": list(b.names), "probability": b.probability} for b in found.beliefs],
        "set_aside": [
            {"kind": row.kind, "case": row.case, "cable": row.cable + 1, "off_sigmas": row.sigmas,
             "log_evidence_gain": row.gain, "frequency_hz": row.hertz or None}
            for row in found.set_aside
        ],
        "noise": [
            {"kind": row.kind, "factor": row.factor, "readings": row.readings, "outliers": row.outliers}
            for row in found.noise
        ],
        "noise_memory": found.noise_correlation,
        "load_cell_drift_N": _drift(found, CELLS),
        "tracker_drift_m": _drift(found, TRACKER),
        "encoder_drift_m": _drift(found, ENCODERS),
        "unassigned_peaks": [asdict(peak) for peak in found.peaks.uncertain],
        "candidates": candidate_rows(found),
        "outside_library": {"law": law[0], "log_evidence_gain": finite(law[1])},
        "gain": _gain(found),
        "extended_model": None if found.extended is None else "extended_robot.toml",
        "unexplained": found.left_at_random and asdict(found.left_at_random),
        "not_testable": sorted(hidden),
        "why_not_testable": hidden,
        "minimum_detectable": found.minimum_detectable,
        "detectable_by_pattern": found.detectable_by_pattern,
        "tolerances": tolerances_told(found.campaign.tolerances, found.campaign.stated),
        "loss": asdict(found.campaign.loss),
        "sigmas": [asdict(used) for used in found.sigmas],
        "trust": Trust((_sigmas(found), *_settled(found))),
        "warnings": _warnings(found),
        "not_used": _not_used(found),
        "signals": [signals.signal_json(item) for item in found.campaign.identified],
        "recording": recording_json(found.recording),
        "ambient": [record_json(one) for one in found.campaign.ambient],
        "peaks_apart": _apart(found),
        "internal_force": _forces(found),
        "damping": None if found.damped is None else signals.damping_json(found.damped),
        "amplitude": None if found.damped is None else amplitude_json(found.damped.amplitude),
    }  # fmt: skip


def _drift(found: Diagnosis, sensor: str) -> float:
    return found.drift.size if found.drift is not None and found.drift.sensor == sensor else 0.0


def _verdict(found: Diagnosis, steps: Sequence[str]) -> dict[str, Any]:
    decision = found.decision
    return {
        "status": decision.status, "causes": likeliest(found), "class": [list(names) for names in decision.classes],
        "probability": float(decision.probability), "location": place(found.location),
        "next_measurement": "; ".join(steps), "sentence": sentence(found),
    }  # fmt: skip


def _forces(found: Diagnosis) -> dict[str, Any] | None:
    """Measured against simulated tensions, split into internal force and what has to balance."""
    forces = found.forces
    if forces is None:
        return None
    split, names = forces.split, found.campaign.states.names
    rows = zip(split.state.tolist(), split.rms, split.internal_rms, split.share, strict=True)
    return {
        "found": forces.found, "log_evidence_gain": forces.gain, "rms_N": forces.size,
        "states": [
            {"case": names[k], "rms_N": float(rms), "internal_rms_N": float(own),
             "balance_rms_N": float(np.sqrt(max(rms**2 - own**2, 0.0))), "internal_percent": 100.0 * float(share)}
            for k, rms, own, share in rows
        ],
    }  # fmt: skip


def _apart(found: Diagnosis) -> dict[str, Any] | None:
    """The common factor between peaks and the modes that a sensor on the platform can see."""
    apart = found.apart
    if apart is None:
        return None
    return {
        "found": apart.found, "factor": apart.factor, "stiffness_per_mass": apart.stiffness_per_mass,
        "p_value": apart.p, "causes": list(apart.names),
        "states": [
            {"case": one.case, "measured_Hz": one.measured.tolist(), "predicted_Hz": one.predicted.tolist()}
            for one in apart.lists
        ],
    }  # fmt: skip


def _next(found: Diagnosis) -> list[str]:
    """What to measure next; of readings to repeat the worst, all of which are in `set_aside`."""
    again = [one for one in found.recommendations if one.purpose == "repeat"]
    shown = [one for one in found.recommendations if one not in again[MOST_REPEATED:]]
    more = len(again) - MOST_REPEATED
    return [*map(recommendation, shown), *([f"measure {more} more contradicting readings again"] if more > 0 else [])]


def _is_among(step: str, simulated: Sequence[str]) -> bool:
    """Whether a proposal of the library is one of the simulated measurements, which say more of it."""
    named = step.split(" (")[0].removeprefix("a ")
    return any(one.startswith(named) for one in simulated)


def likeliest(found: Diagnosis) -> list[str]:
    """Of each class the cause that was chosen, in the order of the classes."""
    if found.by_damping:
        more = [internal_force.CAUSE.name] if found.decision != found.fitted else []
        return [*(found.damped.finding.causes if found.damped is not None else ()), *more]
    own = [] if found.correction is None else [found.correction.cause]
    names = [*own, *found.chosen.hypothesis.names]
    order = []
    for own_class in found.decision.classes:
        name = next((n for n in names if n in own_class and n not in order), own_class[0])
        order.append(name)
    return order


def _error(found: Diagnosis, i: int) -> dict[str, Any]:
    row = found.errors[i]
    worst: dict[str, Any] = {"case": row.case} | ({"cable": row.cable + 1} if row.cable >= 0 else {})
    return {"kind": row.kind, "rms": row.rms, "expected": row.expected, "unit": row.unit,
            "chi2_per_n": finite(row.chi2_per_n), "worst": worst}  # fmt: skip


def candidate_rows(found: Diagnosis) -> list[dict[str, Any]]:
    """Corrections of the data, then every cause that was fitted, best first.

    A cause without a size, or less likely than none, is left out unless the verdict leaves it open. Corrections that
    are not believed stand last.
    """
    believed = [_of_correction(found, one) for one in found.tried if one.correction is found.correction]
    others = [
        _of_correction(found, one) for one in found.tried if one.correction is not found.correction and one.gain > 0.0
    ]
    shown = [one for one in found.candidates if UNKNOWN not in one.names and (one.has_size or _left_open(found, one))]
    shown.sort(key=lambda one: one.best is not found.chosen)
    laws = [] if found.damped is None or not found.damped.finding.causes else list(found.damped.finding.fits)
    fitted = [row for one in shown for row in _of_candidate(found, one)]
    known = [*fitted, *believed] if found.decision.status == UNKNOWN else [*believed, *fitted]
    return [
        *known, *others, *map(signals.law_row, laws[: signals.MOST_ROWS]),
    ]  # fmt: skip


def _left_open(found: Diagnosis, one: Candidate) -> bool:
    """Whether the verdict speaks of just these causes."""
    own = None if found.correction is None else found.correction.cause
    classes = tuple(names for names in found.fitted.classes if own not in names)
    return bool(classes) and not found.by_peaks and len(one.names) == len(classes) and fits(classes, one.names)


def _of_correction(found: Diagnosis, one: Tried) -> dict[str, Any]:
    return {
        "cause": one.correction.cause, "with": [], "pattern": "", "parameters": {},
        "description": corrected(found.campaign, one.correction), "log_evidence_gain": float(one.gain),
        "heldout_rms": None, "explained_fraction": one.explained,
    }  # fmt: skip


def _of_candidate(found: Diagnosis, one: Candidate) -> Iterator[dict[str, Any]]:
    """One row for each cause of a fit."""
    left = found.left_out if one.best is found.chosen else None
    after = None if left is None else left.rms(np.ones(len(left.kind), dtype=bool))[1]
    for size in found.sizes if left is not None else one.sizes:
        name = size.part.cause.name
        yield {
            "cause": name, "with": [other for other in one.names if other != name],
            "pattern": size.part.pattern.label, "parameters": size.parameters, "log_evidence_gain": float(one.gain),
            "heldout_rms": after, "explained_fraction": one.explained,
        }  # fmt: skip


def _gain(found: Diagnosis) -> dict[str, Any]:
    left = found.left_out
    if left is None:
        return {"heldout_rms_before": None, "heldout_rms_after": None, "ratio": None, "per_kind": {}, "transfer": {},
                "confirmed": False, "left_out": "", "added_mode_nats": found.added}  # fmt: skip
    rows, every = left.concerned, np.ones(len(left.kind), dtype=bool)
    before, after = left.rms(rows)
    return {
        "heldout_rms_before": before, "heldout_rms_after": after, "ratio": left.ratio(rows),
        "unit": "standard deviations under the null, of the readings that the causes change by more than one",
        "ratio_of_all": left.ratio(every), "per_kind": _by_kind(left), "counted": int(rows.sum()), "of": len(rows),
        "left_out": "state", "confirmed": found.confirmed, "generic_fudge_ratio": found.generic, "transfer": {},
        "added_mode_nats": found.added,
    }  # fmt: skip


def _by_kind(left: LeftOut) -> dict[str, dict[str, Any]]:
    """Root mean squares of the readings of each kind that the causes concern, in its unit and in sigmas."""
    table: dict[str, dict[str, Any]] = {}
    for kind, (name, factor, unit) in KINDS.items():
        own = left.kind == kind
        rows = own & left.concerned
        if rows.any():
            before, after = (factor * float(np.sqrt(np.mean(r[rows] ** 2))) for r in (left.before, left.after))
            sigmas = left.rms(rows)
            table[name] = {
                "before": before, "after": after, "unit": unit, "ratio": left.ratio(rows),
                "counted": int(rows.sum()), "of": int(own.sum()), "before_sigmas": sigmas[0],
                "after_sigmas": sigmas[1],
            }  # fmt: skip
    return table


def _hidden(found: Diagnosis) -> dict[str, str]:
    """Why these data cannot show a cause, of those that the verdict does not leave open: larger than usual it shows."""
    open_ones = {name for names in found.decision.classes for name in names}
    hidden = {name: why for name, why in found.not_testable.items() if name not in open_ones}
    return hidden | ({} if found.damped is None else signals.untestable(found.damped.finding))


def _warnings(found: Diagnosis) -> list[str]:
    silent = [signals.silent(item) for item in found.campaign.identified if not item.used.any()]
    return [*found.campaign.notes, *silent]


def _settled(found: Diagnosis) -> list[Check]:
    """Whether the fit of the likeliest hypothesis has converged, in its numbers and in its evidence."""
    moved, open_ = float(found.chosen.moved), not found.chosen.fit.converged
    far = (
        f"the likeliest fit had not settled when it ended: its numbers still move by {moved:.2g} sigma when it is "
        "linearised about them. Sizes and evidence of the cause are rough."
    )
    loose = "the evidence of the likeliest fit had not settled when its search ended: probabilities are rough."
    return [
        Check.of("distance of the fit from its linearisation", moved, NEAR, far if moved > NEAR else None, "sigma"),
        Check.of("evidences not settled", open_, 0.0, loose if open_ else None),
    ]


def _sigmas(found: Diagnosis) -> Check:
    said = _unique([doubt(one) for one in found.doubts])
    return Check.of("improbable sigmas and tolerances", len(said), 0.0, said)


def _not_used(found: Diagnosis) -> list[str]:
    """Kinds of signals that added no frequency."""
    if not found.campaign.identified:
        return sorted({series.kind for series in found.campaign.series})
    return sorted({item.record.kind for item in found.campaign.identified if not item.used.any()})


def _unique(lines: Sequence[str]) -> list[str]:
    return [line if line.endswith(("?", ".")) else f"{line}." for line in dict.fromkeys(lines)]
