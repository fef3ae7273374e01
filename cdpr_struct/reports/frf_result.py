"""result.json of a frequency response."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.dynamics.frequency_sweep import ResponseSweep
from cdpr_struct.dynamics.ports import CablePort
from cdpr_struct.measurement.universal_file import response_unit
from cdpr_struct.robot.pose import angles_from_rotation

_ROUNDING = 1e-9


def frf_json(sweep: ResponseSweep, described: Mapping[str, Any]) -> dict[str, Any]:
    """The result under the keys that scripts rely on; `described` is what the command was told, as text.

    `peaks_hz` are the peaks of all responses together, ascending; `responses` has them one by one.
    """
    found, modes = sweep.response, sweep.modes
    responses: list[dict[str, Any]] = []
    for column, port in enumerate(found.respond):
        silent = is_silent(sweep, column)
        hertz, size = (np.empty(0), np.empty(0)) if silent else found.peaks(column)
        unit = response_unit(port, found.excite, found.quantity)
        found_here = {"peaks_hz": hertz, "peak_magnitudes": size}
        responses.append({"respond": port.name, "unit": unit, "silent": silent, **found_here})
    angles = np.degrees(angles_from_rotation(sweep.point.rotation))
    first = float(found.hertz[0])
    return {
        "robot": sweep.point.robot.name,
        "pose": [*sweep.point.position, *angles],
        "model": sweep.model,
        "quantity": found.quantity,
        "excite": found.excite.name,
        **described,
        "frequencies": len(found.hertz),
        "peaks_hz": _merged([r["peaks_hz"] for r in responses], float(found.hertz[1] - found.hertz[0])),
        "responses": responses,
        "natural_frequencies_hz": modes.hertz[modes.hertz >= first],
        "kinds": [kind for kind, hertz in zip(modes.kinds, modes.hertz, strict=True) if hertz >= first],
        "count_certified": modes.certified,
        "all_modes_of_the_band": modes.complete,
    }


def is_silent(sweep: ResponseSweep, column: int) -> bool:
    """Nothing but rounding: an acceleration below 1e-9 of the free platform's, which symmetry makes zero."""
    found, body = sweep.response, sweep.point.robot.platform
    if isinstance(found.excite, CablePort) or isinstance(found.respond[column], CablePort):
        return False
    gyration = float(np.sqrt(np.trace(body.inertia) / 3.0 / body.mass))
    free = 1.0 / body.mass / gyration ** (int(found.excite.turns) + int(found.respond[column].turns))
    omega = 2.0 * np.pi * found.hertz
    rate = omega ** {"displacement": 2, "velocity": 1, "acceleration": 0}[found.quantity]
    return bool((np.abs(found.response[:, column]) * rate).max() < _ROUNDING * free)


def _merged(lists: list[np.ndarray], step: float) -> list[float]:
    """All peaks ascending; those of several responses within a grid step are one."""
    merged: list[float] = []
    for hertz in np.sort(np.concatenate(lists)).tolist():
        if not merged or hertz - merged[-1] > step:
            merged.append(hertz)
    return merged
