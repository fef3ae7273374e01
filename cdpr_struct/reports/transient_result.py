"""result.json of a predicted vibration, and its columns as a table."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.ports import CablePort
from cdpr_struct.dynamics.vibration_record import VibrationRecord
from cdpr_struct.measurement.spectrogram import dominant_frequency
from cdpr_struct.robot.pose import angles_from_rotation


def transient_json(record: VibrationRecord, described: Mapping[str, Any]) -> dict[str, Any]:
    """The result under the keys that scripts rely on; `described` is what the command was told, as text.

    `dominant_hz` is the highest peak in the spectrum of the platform's translational acceleration,
    `dominant_displacement_hz` that of its displacement: slow motions count for more.
    """
    vibration, time = record.vibration, record.vibration.time
    angles = np.degrees(angles_from_rotation(record.point.rotation))
    silent = is_silent(record)
    moving = not silent[:3].all()

    def dominant(signal: np.ndarray) -> float:
        return dominant_frequency(time, signal[:, :3]) if moving else float("nan")

    return {
        "robot": record.point.entered.name,
        "pose": [*record.point.position, *angles],
        "model": record.model,
        **described,
        "duration_s": float(time[-1]),
        "sample_rate_hz": 1.0 / float(time[1] - time[0]),
        "highest_hz": record.highest_hertz,
        "dominant_hz": dominant(vibration.acceleration),
        "dominant_displacement_hz": dominant(vibration.displacement),
        "energy_share": vibration.energy_share,
        "energy_first_J": float(vibration.energy[0]),
        "energy_last_J": float(vibration.energy[-1]),
        "ports": [_port(record, column, bool(silent[column])) for column in range(len(record.ports))],
        "natural_frequencies_hz": record.modes.hertz,
        "kinds": record.modes.kinds,
        "count_certified": record.modes.certified,
        "damped_frequencies_hz": vibration.modes.damped_hertz,
        "damping_ratios": vibration.modes.damping_ratio,
    }


def _port(record: VibrationRecord, column: int, silent: bool) -> dict[str, Any]:
    port, vibration = record.ports[column], record.vibration
    length = "rad" if port.turns else "m"
    moved, signal = vibration.displacement[:, [column]], vibration.acceleration[:, [column]]
    return {
        "name": port.name,
        "on": f"cable {port.cable + 1}" if isinstance(port, CablePort) else "platform",
        f"largest_displacement_{length}": float(np.abs(moved).max()),
        f"largest_acceleration_{length}_s2": float(np.abs(signal).max()),
        "dominant_hz": float("nan") if silent else dominant_frequency(vibration.time, signal),
        "dominant_displacement_hz": float("nan") if silent else dominant_frequency(vibration.time, moved),
    }


def is_silent(record: VibrationRecord) -> np.ndarray:
    """(n,) of every port: it moves by nothing but rounding, 1e-9 of the largest motion or less than 1e-12 m."""
    body = record.point.entered.platform
    gyration = float(np.sqrt(np.trace(body.inertia) / 3.0 / body.mass))
    arms = np.array([gyration if port.turns else 1.0 for port in record.ports])
    moved = np.abs(record.vibration.displacement).max(axis=0) * arms
    return np.asarray(moved <= max(1e-12, 1e-9 * float(moved.max())))


def transient_columns(record: VibrationRecord) -> dict[str, Any]:
    """Columns of transient.csv: time_s, then of every port displacement, velocity and acceleration, then energy_J."""
    vibration = record.vibration
    columns: dict[str, Any] = {"time_s": vibration.time}
    for index, port in enumerate(record.ports):
        length = "rad" if port.turns else "m"
        columns[f"{port.name}_{length}"] = vibration.displacement[:, index]
        columns[f"{port.name}_{length}_s"] = vibration.velocity[:, index]
        columns[f"{port.name}_{length}_s2"] = vibration.acceleration[:, index]
    if np.abs(record.nominal).max() > 0.0:
        for index, name in enumerate(("x", "y", "z")):
            columns[f"nominal_{name}_m_s2"] = record.nominal[:, index]
    return {**columns, "energy_J": vibration.energy}
