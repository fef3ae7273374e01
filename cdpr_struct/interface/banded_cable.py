"""Bands of one cable's frequencies: its tolerances, and what the result says."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.bands.cable_bands import HELD, Held, UncertainCable
from cdpr_struct.errors import InputError
from cdpr_struct.interface.arguments import one_of, real
from cdpr_struct.interface.bands import AskedBand
from cdpr_struct.reports.cable_bands_told import CABLE_TOLERANCES, cable_band_checks, cable_bands_told
from cdpr_struct.reports.tolerances_told import tolerances_told
from cdpr_struct.reports.trust import Check
from cdpr_struct.robot.tolerances import Tolerances

TolerancesLike = str | Mapping[str, float]
_EXPECTED = f"give NAME=VALUE,.. with names of {', '.join(CABLE_TOLERANCES)}, each zero or more"


def read_cable_tolerances(given: TolerancesLike | None) -> dict[str, float]:
    """Tolerances of one cable by name; those not given keep their defaults.

    Raises
    ------
    InputError : an unknown name, or a value that is no size.
    """
    if given is None:
        return {}
    if isinstance(given, str):
        pairs = [part.partition("=") for part in given.split(",")]
        given = {name.strip(): _number(value, given) for name, _, value in pairs}
    for name, value in given.items():
        if name not in CABLE_TOLERANCES:
            raise InputError("tolerances", "", name, _EXPECTED)
        real(value, "tolerances", _EXPECTED, -1e-300)
    return dict(given)


def _number(text: str, given: object) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise InputError("tolerances", "", given, _EXPECTED) from error


def read_held(held: str) -> Held:
    """What stays as entered.

    Raises
    ------
    InputError : neither force nor ends.
    """
    return one_of(held, "held", HELD)


def banded_cable(
    told: Mapping[str, Any], asked: AskedBand, tolerances: Mapping[str, float], held: Held
) -> tuple[dict[str, Any], list[Check]]:
    """Key `bands` of one cable that `describe_cable` told of, and what is to be doubted."""
    given, count = told["input"], len(told["exact_frequencies_hz"]["in_plane"])
    cable = UncertainCable(
        np.array(given["force_N"]), given["length_m"], given["axial_stiffness_N"], given["linear_density_kg_m"],
        given["gravity_m_s2"], Tolerances(**tolerances), held,
    )  # fmt: skip
    found = cable.bands(count, asked.level)
    drawn = cable.drawn(asked.samples, count) if asked.samples else None
    left_out = [name for name in Tolerances.__slots__ if name not in CABLE_TOLERANCES]
    head = {
        "level": 100.0 * asked.level,
        "held": held,
        "known_from": "tolerances",
        "tolerances": tolerances_told(cable.tolerances, tolerances, left_out),
    }
    return head | cable_bands_told(found, drawn, asked.level), cable_band_checks(found)
