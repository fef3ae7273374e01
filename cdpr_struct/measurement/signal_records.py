"""Rows of signal files become records: one per case, all its channels over one time axis or one set of lines."""

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.ambient_columns import ambient_channels
from cdpr_struct.measurement.campaign import AMBIENT, Series
from cdpr_struct.measurement.campaign_rows import POSE, length_columns
from cdpr_struct.measurement.lost_samples import FEWEST, common_lines, even_samples

ACCELERATION = ("ax", "ay", "az")
MOTION = ("x", "y", "z", "rx", "ry", "rz")


@dataclass(frozen=True, slots=True, eq=False)
class SignalRecord:
    """One vibration record.

    axis     : (n,) time [s], or frequency [Hz] of an FRF
    signal   : (n, c) accelerations [m/s^2]; or motion about the rest [m, rad]; or complex accelerances [(m/s^2)/N]
    channels : names of the channels; an FRF's are (respond, excite) as "z/fz"
    position, angles : (3,) [m], (3,) [rad] of the rest, nan if the file has no pose;  payload [kg]
    lengths  : (m,) unstrained as the encoder says [m], nan if absent
    lost     : (n,) bool, samples that were not recorded, filled in; of an FRF lines are left out: (0,)
    missing  : how many samples or lines were not recorded
    """

    kind: str
    case: str
    file: str
    axis: np.ndarray
    signal: np.ndarray
    channels: tuple[str, ...]
    position: np.ndarray
    angles: np.ndarray
    payload: float
    lengths: np.ndarray
    lost: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=bool))
    missing: int = 0


def records(series: Series, cables: int) -> list[SignalRecord]:
    """Records of a signal file.

    Raises
    ------
    InputError : uneven or too few instants, FRFs of one case on different lines, a pose that changes within a case.
    """
    names = np.array(series.case, dtype=object)
    return [_record(series, np.flatnonzero(names == case), str(case), cables) for case in dict.fromkeys(series.case)]


def _record(series: Series, rows: np.ndarray, case: str, cables: int) -> SignalRecord:
    columns = {name: values[rows] for name, values in series.columns.items()}
    lost, missing = np.zeros(0, dtype=bool), 0
    if series.kind == "frf":
        axis, signal, channels, missing = _responses(series, rows, columns, case)
    else:
        columns, lost = even_samples(
            series.file, case, columns, _measured(series.kind, columns), series.kind != AMBIENT
        )
        axis, missing = columns["time_s"], int(lost.sum())
        signal, channels = _samples(series.kind, columns)
    position, angles = _rest(series, columns, case)
    lengths = np.full(cables, np.nan)
    if all(name in columns for name in length_columns(cables)):
        lengths = np.array([np.median(columns[name]) for name in length_columns(cables)])
    payload = float(columns["payload_kg"][0]) if "payload_kg" in columns else 0.0
    return SignalRecord(
        series.kind, case, series.file, axis, signal, channels, position, angles, payload, lengths, lost, missing
    )


def _measured(kind: str, columns: dict[str, np.ndarray]) -> list[str]:
    """Columns of what was measured over time."""
    if kind == "free_decay":
        return list(ACCELERATION)
    return list(ambient_channels(list(columns))) if kind == AMBIENT else [name for name in POSE if name in columns]


def _samples(kind: str, columns: dict[str, np.ndarray]) -> tuple[np.ndarray, tuple[str, ...]]:
    """Samples (n, c) and the names of their channels."""
    if kind in ("free_decay", AMBIENT):
        names = ACCELERATION if kind == "free_decay" else tuple(ambient_channels(list(columns)))
        return np.stack([columns[name] for name in names], axis=1), names
    position = np.stack([columns[name] for name in POSE[:3]], axis=1)
    turn = _turns(columns)
    away = (turn * turn.mean().inv()).as_rotvec()
    return np.concatenate([position - position.mean(axis=0), away], axis=1), MOTION


def _turns(columns: dict[str, np.ndarray]) -> Rotation:
    zero = np.zeros(len(columns["time_s"]))
    angles = np.stack([columns.get(name, zero) for name in POSE[3:]], axis=1)
    return Rotation.from_euler("ZYX", angles[:, ::-1], degrees=True)


def _rest(series: Series, columns: dict[str, np.ndarray], case: str) -> tuple[np.ndarray, np.ndarray]:
    """Position [m] and angles rx, ry, rz [rad] of the rest."""
    if not all(name in columns for name in POSE[:3]):
        return np.full(3, np.nan), np.full(3, np.nan)
    position = np.stack([columns[name] for name in POSE[:3]], axis=1)
    if series.kind == "platform_motion":
        turn = _turns(columns).mean().as_euler("ZYX")
        return position.mean(axis=0), turn[::-1]
    zero = np.zeros(len(position))
    whole = np.column_stack([position, *(columns.get(name, zero) for name in POSE[3:])])
    moved = np.flatnonzero(np.abs(whole - whole[0]).max(axis=1) > 1e-9)
    if moved.size:
        raise InputError(
            series.file, f"case {case}", whole[moved[0]].tolist(), f"one pose a case, {whole[0].tolist()} before"
        )
    return position[0], np.radians(whole[0, 3:])


def _responses(
    series: Series, rows: np.ndarray, columns: dict[str, np.ndarray], case: str
) -> tuple[np.ndarray, np.ndarray, tuple[str, ...], int]:
    """Lines (f,), responses (f, c) and names of the channels of one case, and how many lines are missing."""
    pairs = [f"{series.labels['respond'][i]}/{series.labels['excite'][i]}" for i in rows]
    found: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    for name in dict.fromkeys(pairs):
        own = np.flatnonzero(np.array(pairs, dtype=object) == name)
        own = own[np.argsort(columns["frequency_hz"][own], kind="stable")]
        hertz = columns["frequency_hz"][own]
        place = f"case {case}, response {name}"
        if len(hertz) < FEWEST:
            raise InputError(series.file, place, f"{len(hertz)} lines", f"at least {FEWEST} lines of one response")
        if not (np.diff(hertz) > 0.0).all():
            twice = float(hertz[1:][np.diff(hertz) <= 0.0][0])
            raise InputError(series.file, place, f"{twice:g} Hz twice", "each line once")
        found[name] = hertz, columns["real"][own] + 1j * columns["imag"][own]
    lines, signal, missing = common_lines(series.file, case, found)
    return lines, signal, tuple(found), missing
