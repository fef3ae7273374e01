"""A diagnosis as result.json."""

from dataclasses import asdict
from typing import Any

import numpy as np

from cdpr_struct.diagnosis.candidate_rows import candidate_rows
from cdpr_struct.diagnosis.causes.internal_mode import NAME
from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.heldout import groups_of
from cdpr_struct.diagnosis.plan import minimum_detectable
from cdpr_struct.diagnosis.prepared import SIGNIFICANT
from cdpr_struct.diagnosis.sigma_check import sigmas_used, warnings
from cdpr_struct.diagnosis.significance import NOISE_SHARE, STRAY_SHARE, p_of_noise
from cdpr_struct.diagnosis.simulation_error import rows_read, simulation_error
from cdpr_struct.diagnosis.stray_peaks import p_of_strays
from cdpr_struct.diagnosis.verdict import Verdict, confirmed, is_unknown, verdict
from cdpr_struct.reports.diagnosis_signals import with_signals


def diagnosis_json(found: Diagnosis) -> dict[str, Any]:
    """result.json of `diagnose`."""
    said = verdict(found)
    hidden = _hidden(found, said)
    result = {
        "campaign": found.campaign.source,
        "robot": found.campaign.robot_name,
        "model": found.campaign.model,
        "simulation_error": simulation_error(found),
        "significant": found.p_value < SIGNIFICANT,
        "p_value": found.p_value,
        "p_value_of": _decided_by(found),
        "p_adequate": found.p_adequate,
        "verdict": {
            "status": said.status, "causes": list(said.causes), "class": [list(c) for c in said.classes],
            "probability": said.probability, "location": said.location, "next_measurement": said.next_measurement,
            "sentence": said.sentence,
        },
        "set_aside": [
            {
                "kind": wrong.kind, "case": found.campaign.states.names[wrong.state], "cable": wrong.cable + 1,
                "off_sigmas": wrong.sigmas, "log_evidence_gain": wrong.gain,
            }
            for wrong in found.aside
        ],
        "noise_memory": found.campaign.memory,
        "candidates": candidate_rows(found),
        "outside_library": {"law": found.outside.words, "log_evidence_gain": _number(found.outside.gain)},
        "gain": _gain(found),
        "extended_model": "extended_robot.toml" if set(said.causes) - {NAME} else None,
        "not_testable": sorted(hidden),
        "why_not_testable": hidden,
        "minimum_detectable": minimum_detectable(found.ground.candidates),
        "tolerances": {
            name: {"value": getattr(found.campaign.tolerances, name), "stated": name in found.campaign.stated}
            for name in found.campaign.tolerances.__slots__
        },
        "sigmas": [asdict(used) for used in sigmas_used(found.campaign)],
        "warnings": [*map(_sentence, warnings(found)), *found.campaign.notes],
        "not_used": sorted({s.kind for s in found.campaign.series}),
    }  # fmt: skip
    return with_signals(result, found)


def _hidden(found: Diagnosis, said: Verdict) -> dict[str, str]:
    """Why these data cannot show a cause, of those that the verdict does not leave open: larger than usual it shows."""
    open_ones = {name for names in said.classes for name in names}
    return {name: why for name, why in found.not_testable.items() if name not in open_ones}


def _decided_by(found: Diagnosis) -> str:
    """Which of the three tests of the null gave its p-value: single laws, chi2 of all readings, or stray peaks."""
    setting = found.entered_setting
    strays = p_of_strays(setting.strays, len(setting.robot_log)) / STRAY_SHARE
    noise = p_of_noise(found.entered) / NOISE_SHARE
    if strays <= noise and strays <= 1.01 * found.p_value:
        return "strays"
    return "chi2" if noise <= 1.01 * found.p_value else "laws"


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _left_out(found: Diagnosis) -> str:
    """What was predicted from all the rest: each state, each kind of data, or nothing where there is no rest."""
    groups = groups_of(found.ground.setting)
    if len(np.unique(groups[rows_read(found)])) < 2:
        return ""
    return "state" if len(found.campaign.states.names) > 1 else "kind of data"


def _gain(found: Diagnosis) -> dict[str, Any]:
    if found.held is None or not (left_out := _left_out(found)):
        return {"heldout_rms_before": None, "heldout_rms_after": None, "ratio": None, "per_kind": {}, "transfer": {},
                "confirmed": False, "left_out": ""}  # fmt: skip
    held = found.held
    before, after = held.rms(held.concerned)
    return {
        "heldout_rms_before": before, "heldout_rms_after": after, "ratio": held.ratio(held.concerned),
        "unit": "standard deviations under the null, of the readings that the causes change by more than one",
        "ratio_of_all": held.ratio(), "per_kind": held.by_kind(rows_read(found)),
        "counted": int(held.concerned.sum()), "of": int(rows_read(found).sum()), "left_out": left_out,
        "confirmed": confirmed(found) and not is_unknown(found),
        "generic_fudge_ratio": None if found.fudge is None else found.fudge.ratio(), "transfer": found.transfer,
    }  # fmt: skip


def _sentence(text: str) -> str:
    return text if text.endswith(("?", ".")) else f"{text}."
