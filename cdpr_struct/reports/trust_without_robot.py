"""Can results be trusted that are not of one robot: a single cable, the built-in robots, the thesis, its limits?"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.crosscheck.limits_trial import LimitsTrial
from cdpr_struct.crosscheck.single_cable import CableCertainty, cable_certainty
from cdpr_struct.reports.trust import Check, Trust
from cdpr_struct.robot.plausibility import BREAKING_STRAIN, implausible, odd_ratio
from cdpr_struct.robot.robot import Robot
from cdpr_struct.thesis.reproduction import Reproduction

_CLOSED = 1e-7  # of a cable's force, as for the balance of robots
_SETTLED = 1e-6  # of a natural frequency
_BY_FEM = 1e-3  # of a natural frequency
_SHARE = 0.25  # of a tolerance: what is to judge by it must be surer than this


def with_trust(result: Mapping[str, Any], trust: Trust) -> dict[str, Any]:
    """The result with its `trust`, and with what that raises among its warnings."""
    return {**result, "trust": trust.json(), "warnings": [*result.get("warnings", ()), *trust.warnings]}


def cable_trust(result: Mapping[str, Any]) -> Trust:
    """Of the result of one cable under an end force."""
    given, sure = result["input"], cable_certainty(result)
    odd = odd_ratio(given["axial_stiffness_N"], given["linear_density_kg_m"], "the cable")
    broken = [one["parameter"] for one in result["validity"]["violations"]]
    outside = f"frequencies_hz are those of the closed form outside its limits ({', '.join(broken)})"
    strain, breaks = 100.0 * sure.strain, 100.0 * BREAKING_STRAIN
    torn = f"The cable is stretched by {strain:.3g} %: steel breaks near 2 %, fibres near 3.5 %. Check EA (N, not kN)."
    return Trust(
        (
            Check.of("implausible numbers of the cable", bool(odd), 0.0, odd),
            *_computed(sure),
            Check.of("strain", strain, breaks, torn if strain > breaks else None, "%"),
            Check.of(
                "printed limits broken", len(broken), 0.0,
                f"{outside}; exact_frequencies_hz have no such limits." if broken else None, note=True,
            ),
        )
    )  # fmt: skip


def _computed(sure: CableCertainty) -> list[Check]:
    """Whether shape and frequencies are found."""
    left, moved = sure.force_missed, sure.frequency_moved
    open_ = f"a cable with this end point has a force that differs by {left:.2g}: its shape is not found."
    rough = f"more polynomials change exact_frequencies_hz by up to {moved:.2g}: they have not converged."
    checks = [
        Check.of("force that the shape misses", left, _CLOSED, open_ if not left <= _CLOSED else None),
        Check.of(
            "change of frequencies by more polynomials", moved, _SETTLED, rough if not moved <= _SETTLED else None
        ),
    ]
    apart = sure.fem_apart
    if apart is not None:
        differ = (
            f"exact_frequencies_hz and fem_frequencies_hz differ by up to {apart:.2g}: one of them is not converged."
        )
        checks.append(Check.of("difference from the FEM", apart, _BY_FEM, differ if not apart <= _BY_FEM else None))
    return checks


def robots_trust(robots: Sequence[Robot]) -> Trust:
    """Of the list of built-in robots."""
    said = [f"{robot.name}: {doubt}" for robot in robots for doubt in implausible(robot)]
    return Trust((Check.of("implausible numbers of the robots", len(said), 0.0, said),))


def reproduction_trust(items: Sequence[Reproduction]) -> Trust:
    """Of items of the thesis that were recomputed; deviations from the print are the result and raise no doubt."""
    ours = np.array([cell.ours for item in items for cell in item.cells])
    lost = int((~np.isfinite(ours)).sum())
    off = sum(not cell.within for item in items for cell in item.cells)
    missed = f"{lost} numbers could not be computed."
    known = f"{off} of {len(ours)} numbers lie outside their tolerance of the print; the notes say why."
    return Trust(
        (
            Check.of("numbers that are not computed", lost, 0.0, missed if lost else None),
            Check.of("numbers outside their tolerance", off, 0.0, known if off else None, note=True),
        )
    )


def limits_trust(trial: LimitsTrial) -> Trust:
    """Of the trial of the printed limits: its judges, the FEM and the exact cable, must be surer than the tolerance."""
    most = _SHARE * trial.tolerance
    checks = []
    for what, name in (
        ("uncertainty of the FEM", "uncertainty"),
        ("frequency error of the exact cable", "catenary"),
        ("stiffness error of the exact cable", "stiffness"),
    ):
        worst = max((float(getattr(one, name)) for one in trial.verdicts), default=float("inf"))
        unsure = f"the {what} is up to {worst:.2g}, over a quarter of the tolerance: errors near it cannot be judged."
        checks.append(Check.of(what, worst, most, unsure if not worst <= most else None))
    return Trust(tuple(checks))
