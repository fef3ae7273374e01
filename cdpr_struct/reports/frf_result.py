"""result.json of a frequency response, and its columns as a table."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.frequency_sweep import ResponseSweep
from cdpr_struct.measurement.universal_file import response_unit
from cdpr_struct.robot.pose import angles_from_rotation


def frf_json(sweep: ResponseSweep, described: Mapping[str, Any]) -> dict[str, Any]:
    """The result under the keys that scripts rely on; `described` is what the command was told, as text.

    `peaks_hz` are the peaks of all responses together, ascending; `responses` has them one by one. Infinite magnitudes
    and widths that cannot be told become null.
    """
    found, modes = sweep.response, sweep.modes
    angles = np.degrees(angles_from_rotation(sweep.point.rotation))
    listed = modes.hertz >= found.hertz[0]
    return {
        "robot": sweep.point.entered.name,
        "pose": [*sweep.point.position, *angles],
        "model": sweep.model,
        "quantity": found.quantity,
        "excite": found.excite.name,
        **described,
        "frequencies": int(sweep.even.sum()),
        "lines": len(found.hertz),
        "peaks_hz": _merged(sweep),
        "responses": [_response(sweep, column) for column in range(len(found.respond))],
        "natural_frequencies_hz": modes.hertz[listed],
        "natural_damping_ratios": sweep.ratios[listed],
        "kinds": [kind for kind, here in zip(modes.kinds, listed, strict=True) if here],
        "count_certified": modes.certified,
        "all_modes_of_the_band": modes.complete,
    }


def _response(sweep: ResponseSweep, column: int) -> dict[str, Any]:
    found, peaks = sweep.response, sweep.peaks[column]
    return {
        "respond": found.respond[column].name,
        "unit": response_unit(found.respond[column], found.excite, found.quantity),
        "silent": bool(sweep.silent[column]),
        "peaks_hz": peaks.hertz,
        "peak_magnitudes": peaks.magnitude,
        "half_power_widths_hz": peaks.half_power_width,
        "damping_ratios": peaks.damping_ratio,
    }


def _merged(sweep: ResponseSweep) -> list[float]:
    """All peaks ascending; those of several responses within a mode's half-power width are one."""
    modes = sweep.modes.hertz
    merged: list[float] = []
    for hertz in np.sort(np.concatenate([peaks.hertz for peaks in sweep.peaks])).tolist():
        width = 0.0
        if len(modes):
            near = int(np.abs(modes - hertz).argmin())
            width = 2.0 * float(sweep.ratios[near] * modes[near])
        if not merged or hertz - merged[-1] > width:
            merged.append(hertz)
    return merged


def frf_columns(sweep: ResponseSweep) -> dict[str, Any]:
    """Columns of frf.csv, one row a line and response: the form in which measured responses are read, SI units."""
    found = sweep.response
    count = len(found.respond)
    return {
        "frequency_hz": np.tile(found.hertz, count),
        "real": found.response.real.T.ravel(),
        "imag": found.response.imag.T.ravel(),
        "respond": np.repeat([port.name for port in found.respond], len(found.hertz)),
        "excite": [found.excite.name] * (count * len(found.hertz)),
    }
