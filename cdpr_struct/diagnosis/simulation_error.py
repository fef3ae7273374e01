"""What the user sees: simulated minus measured, in his units, and how significant it is."""

from typing import Any

import numpy as np

from cdpr_struct.diagnosis.commanded import simulated
from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.null_model import NullModel
from cdpr_struct.diagnosis.readings import Readings, cell_reading, exit_turns
from cdpr_struct.diagnosis.residuals import Setting

UNIT = {"static_state": "N", "loaded_pose": "mm", "cable_frequency": "Hz", "robot_frequency": "Hz", "frf": "%"}


def tension_errors(setting: Setting) -> np.ndarray:
    """(S, m) measured tensions minus those of the simulation's distribution at the measured pose [N]; nan if none."""
    campaign = setting.campaign
    readings, errors = Readings.of(campaign.states), np.full(campaign.states.tension.shape, np.nan)
    for i in np.flatnonzero(campaign.states.has_tension & campaign.states.static):
        robot = campaign.robot.with_load(float(campaign.states.payload[i]))
        held = simulated(campaign, campaign.states.payload[i], readings.position[i], readings.rotation[i])
        turns = exit_turns(robot, readings.position[i], readings.rotation[i])
        said = cell_reading(robot, held.tensions, campaign.states.approach[i], turns)
        errors[i] = campaign.states.tension[i] - said
    return errors


def rows_read(found: Diagnosis) -> np.ndarray:
    """(n,) residuals that hold a reading: where no tension was read, the simulation's own balance by construction."""
    labels, states = found.entered_setting.labels, found.campaign.states
    tensions = np.isin(labels.block.astype(str), ("EQ", "CO", "NS"))
    read: np.ndarray = ~tensions | np.isfinite(states.tension).any(axis=1)[labels.state]
    return read


def simulation_error(found: Diagnosis) -> list[dict[str, Any]]:
    """Per kind of data that was read: root mean square, unit, chi^2 over its count, and the worst reading.

    expected : root mean square that noise and tolerances let expect; None of tensions held against the simulation's
    """
    null, setting, read = found.entered, found.entered_setting, rows_read(found)
    labels, rows = setting.labels, []
    for kind in dict.fromkeys(labels.kind[read].tolist()):
        own = np.flatnonzero((labels.kind == kind) & read)
        values, sigma, worst = _in_units(kind, setting, null, own)
        expected = None if sigma is None else float(np.sqrt(np.mean(sigma**2)))
        rows.append(
            {"kind": kind, "rms": float(np.sqrt(np.nanmean(values**2))), "expected": expected, "unit": UNIT[kind],
             "chi2_per_n": _chi2_per_n(null, own), "worst": worst}
        )  # fmt: skip
    return rows


def _in_units(
    kind: str, setting: Setting, null: NullModel, own: np.ndarray
) -> tuple[np.ndarray, np.ndarray | None, dict[str, Any]]:
    """Errors, their sigmas, and where the worst is."""
    labels, names = setting.labels, setting.campaign.states.names
    if kind == "static_state":
        errors = tension_errors(setting)
        if np.isfinite(errors).any():
            state, cable = np.unravel_index(int(np.nanargmax(np.abs(errors))), errors.shape)
            return errors, None, {"case": names[state], "cable": int(cable) + 1}
        return null.r[own], None, {"case": names[labels.state[own[np.abs(null.r[own]).argmax()]]]}
    values, sigma = null.r[own], np.sqrt(np.diagonal(null.covariance)[own])
    if kind.endswith("_frequency"):
        campaign = setting.campaign
        rows = campaign.cable_frequencies if kind == "cable_frequency" else campaign.robot_frequencies
        values, sigma = rows.hertz * -np.expm1(-values / 100.0), 0.01 * rows.hertz * sigma
    worst = own[np.abs(values).argmax()]
    found: dict[str, Any] = {"case": names[labels.state[worst]]}
    if labels.cable[worst] >= 0:
        found["cable"] = int(labels.cable[worst]) + 1
    return values, sigma, found


def _chi2_per_n(null: NullModel, rows: np.ndarray) -> float:
    z = null.white_among(rows, null.r)
    return float(z @ z) / len(z)
