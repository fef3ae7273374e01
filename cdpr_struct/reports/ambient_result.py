"""Modes of ambient records as JSON, text, table and trust."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.measurement.ambient_modes import BLOCKS
from cdpr_struct.measurement.ambient_records import AmbientRecord
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.reports.text import plain_table
from cdpr_struct.reports.trust import Check, Trust
from cdpr_struct.reports.trust_without_robot import with_trust

_PERIODS = 1000.0  # of the lowest mode in a record: a rule of operational modal analysis
_APART = 3.0  # sigmas between the halves of a record

HEAD = (
    "case",
    "frequency [Hz]",
    "sigma [Hz]",
    "sigma [%]",
    "damping [%]",
    "sigma [%]",
    "orders",
    "halves apart",
    "kind",
)
_MODE, _SINE = "mode", "periodic force"


def ambient_json(campaign: Campaign) -> dict[str, Any]:
    """The records of a campaign."""
    records = campaign.ambient
    told = {
        "campaign": campaign.source, "robot": campaign.robot.name, "blocks": BLOCKS,
        "records": [record_json(one) for one in records], "warnings": list(campaign.notes),
    }  # fmt: skip
    return with_trust(told, ambient_trust(records))


def record_json(one: AmbientRecord) -> dict[str, Any]:
    """One record and its modes."""
    modes, choice = one.modes, one.choice
    rows = zip(
        modes.hertz,
        one.sigma,
        modes.damping,
        modes.damping_sigma,
        modes.orders,
        modes.halves,
        modes.shape,
        modes.periodic,
        strict=True,
    )
    return {
        "case": one.case, "file": one.file, "channels": list(one.channels), "duration_s": one.duration,
        "rate_hz": one.rate, "analysed_rate_hz": one.analysed_rate, "band_hz": list(one.band),
        "order": choice.order, "wanted_hz": list(choice.frequencies),
        "modes": [
            {
                "frequency_hz": float(hertz), "sigma_hz": float(sigma), "damping_ratio": float(ratio),
                "damping_sigma": float(spread), "orders": int(orders), "halves_apart": float(halves),
                "shape_real": shape.real, "shape_imag": shape.imag, "periods": float(hertz * one.duration),
                "kind": _SINE if sine else _MODE,
            }
            for hertz, sigma, ratio, spread, orders, halves, shape, sine in rows
        ],
    }  # fmt: skip


def ambient_trust(records: Sequence[AmbientRecord]) -> Trust:
    """Whether records are long enough, and steady."""
    periods = min((float(r.modes.hertz[0] * r.duration) for r in records if len(r.modes)), default=0.0)
    apart = max((float(np.nan_to_num(np.abs(r.modes.halves)).max(initial=0.0)) for r in records), default=0.0)
    without = [r.case for r in records if not len(r.modes)]
    short = f"A record holds {periods:.0f} periods of its lowest mode, fewer than {_PERIODS:.0f}: measure longer."
    moved = f"A frequency differs by {apart:.1f} sigma between the halves of a record: the robot or its load changed."
    checks = (
        Check.of("records without a stable mode", len(without), 0.0, _none(without) if without else None),
        Check.of(
            "periods of the lowest mode", periods, _PERIODS, short if periods < _PERIODS else None, at_least=True,
            note=True,
        ),
        Check.of("change between halves of a record", apart, _APART, moved if apart > _APART else None, "sigma"),
    )  # fmt: skip
    return Trust(checks)


def _none(without: Sequence[str]) -> str:
    return f"No stable mode in {', '.join(without)}: record longer, or give another band_hz in the campaign file."


def mode_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of modes.csv, one row a mode of a record."""
    rows = [(one["case"], mode) for one in result["records"] for mode in one["modes"]]
    keys = ("frequency_hz", "sigma_hz", "damping_ratio", "damping_sigma", "orders", "halves_apart", "kind")
    return {"case": [case for case, _ in rows], **{key: [mode[key] for _, mode in rows] for key in keys}}


def frequency_columns(result: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of robot_frequency.csv, a file of measured data of that kind: cases need no pose of their own."""
    rows = [(one["case"], mode) for one in result["records"] for mode in one["modes"] if mode["kind"] == _MODE]
    return {
        "case": [case for case, _ in rows],
        "frequency_hz": [mode["frequency_hz"] for _, mode in rows],
        "sigma": [mode["sigma_hz"] for _, mode in rows],
    }


def mode_rows(result: Mapping[str, Any]) -> list[list[str]]:
    """Cells of the table of modes, under `HEAD`."""
    return [
        [
            one["case"], f"{mode['frequency_hz']:.4f}", f"{mode['sigma_hz']:.4f}",
            f"{100.0 * mode['sigma_hz'] / mode['frequency_hz']:.3f}", f"{100.0 * mode['damping_ratio']:.2f}",
            f"{100.0 * mode['damping_sigma']:.2f}", str(mode["orders"]),
            f"{mode['halves_apart']:+.1f}" if np.isfinite(mode["halves_apart"]) else "-", mode["kind"],
        ]
        for one in result["records"]
        for mode in one["modes"]
    ]  # fmt: skip


def ambient_text(result: Mapping[str, Any]) -> str:
    """Records and their modes."""
    return plain_table("\n".join(ambient_sentences(result)), HEAD, mode_rows(result))


def ambient_sentences(result: Mapping[str, Any]) -> list[str]:
    """One sentence a record."""
    return [_sentence(one) for one in result["records"]] or ["The campaign has no ambient record."]


def _sentence(one: Mapping[str, Any]) -> str:
    count, (low, high) = sum(mode["kind"] == _MODE for mode in one["modes"]), one["band_hz"]
    return (
        f"{one['case']}: {count} mode{'' if count == 1 else 's'} between {low:.3g} and {high:.3g} Hz in "
        f"{one['duration_s']:.0f} s of {len(one['channels'])} channels."
    )
