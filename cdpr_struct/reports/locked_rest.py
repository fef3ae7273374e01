"""How the rest at locked lengths was found, and which other stable poses these lengths have."""

from typing import Any

import numpy as np

from cdpr_struct.reports.text import paragraphs, plain_table, rounded
from cdpr_struct.reports.trust import Check
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.statics.equilibria import Equilibria
from cdpr_struct.statics.locked_rest import UPSET, LockedRest
from cdpr_struct.statics.slack_cables import hangs_slack


def locked_json(found: LockedRest) -> dict[str, Any]:
    """The result's `locked`: start, way, other stable poses, and sentences for screen and page."""
    return {
        "pose": _pose(found.solution.position, found.solution.rotation),
        "start": found.start.in_degrees(),
        "way": found.way,
        "steps": found.steps,
        "jumps": found.jumps,
        "turned_deg": float(np.degrees(found.turned)),
        "slack_cables": int(hangs_slack(found.solution.cables).sum()),
        "descents": found.others.starts,
        "other_equilibria": _listed(found.others),
        "sentences": [_way(found), _others(found)],
    }


def locked_checks(found: LockedRest) -> list[Check]:
    """Whether the pose may not be the one that was meant."""
    times = "once" if found.jumps == 1 else f"{found.jumps} times"
    fell = (
        f"on the way from home the equilibrium ended {times} and the platform fell into another one; "
        "if another pose is meant, give --start near it."
    )
    lower, upset = int((found.others.energy < 0.0).sum()), bool(found.turned > UPSET and found.others.count)
    turned = (
        f"the platform is turned by {np.degrees(found.turned):.0f} deg against its start, and has other stable "
        "poses at these lengths; if another pose is meant, give --start near it."
    )
    less = None
    if lower:
        less = (
            f"another stable pose at these lengths has {-found.others.energy[0]:.3g} J less energy, "
            f"{_where(found.others, 0)}; if another pose is meant, give --start near it."
        )
    checks = [Check.of("jumps on the way from home", found.jumps, 0.0, fell if found.jumps else None)]
    if upset:
        limit = float(np.degrees(UPSET))
        return [*checks, Check.of("turned since the start", float(np.degrees(found.turned)), limit, turned, "deg")]
    return [*checks, Check.of("stable poses of less energy", lower, 0.0, less)]


def equilibria_text(result: dict[str, Any]) -> str:
    """Table of the stable poses at the same lengths, the answer first."""
    locked = result["locked"]
    answer = {"pose": locked["pose"], "energy_J": 0.0, "slack_cables": locked["slack_cables"]}
    answer |= {"least_stiffness_N_m": result["least_stiffness_N_m"]}
    rows = [
        [
            str(i),
            *(f"{v:.4f}" for v in rounded(each["pose"][:3], 4)),
            *(f"{v:.2f}" for v in rounded(each["pose"][3:], 2)),
            f"{each['energy_J']:.4g}" if np.isfinite(each["energy_J"]) else "-",
            f"{each['least_stiffness_N_m']:.4g}",
            str(each["slack_cables"]),
        ]
        for i, each in enumerate([answer, *locked["other_equilibria"]], start=1)
    ]
    title = f"Stable poses at these lengths, found by {locked['descents']} descents; the first is the answer"
    body = plain_table(title, _COLUMNS, rows)
    return paragraphs(body, "Cables may cross each other or the platform at some of them; this is not checked.")


_COLUMNS = ["pose", "x [m]", "y [m]", "z [m]", "rx [deg]", "ry [deg]", "rz [deg]"]
_COLUMNS += ["energy [J]", "stiffness [N/m]", "slack cables"]


def _listed(others: Equilibria) -> list[dict[str, Any]]:
    return [
        {
            "pose": _pose(others.position[i], others.rotation[i]),
            "energy_J": float(others.energy[i]),
            "least_stiffness_N_m": float(others.least_stiffness[i]),
            "slack_cables": int(others.slack[i]),
        }
        for i in range(others.count)
    ]


def _way(found: LockedRest) -> str:
    rest = _words(found.solution.position, found.solution.rotation)
    begin = _words(found.start.position, found.start.rotation)
    if found.way == "continued":
        steps = f"{found.steps} step" + ("s" if found.steps > 1 else "")
        return f"Locked lengths: followed from the home pose {begin} in {steps}, the platform rests at {rest}."
    return f"Locked lengths: sought from {begin}, the platform rests at {rest}."


def _others(found: LockedRest) -> str:
    count = found.others.count
    if not count:
        return f"No other stable pose was found at these lengths by {found.others.starts} descents."
    poses = "1 other stable pose exists" if count == 1 else f"{count} other stable poses exist"
    if not np.isfinite(found.others.energy).all():
        return f"{poses} at these lengths. Energies are not compared: drag on cables has no potential."
    return f"{poses} at these lengths; the lowest has {found.others.energy[0]:+.3g} J, {_where(found.others, 0)}."


def _where(others: Equilibria, i: int) -> str:
    return f"at {_words(others.position[i], others.rotation[i])}"


def _words(position: np.ndarray, rotation: np.ndarray) -> str:
    x, y, z = rounded(position, 4)
    rx, ry, rz = rounded(np.degrees(angles_from_rotation(rotation)), 2)
    return f"({x:g}, {y:g}, {z:g}) m, ({rx:g}, {ry:g}, {rz:g}) deg"


def _pose(position: np.ndarray, rotation: np.ndarray) -> list[float]:
    return [*position.tolist(), *np.degrees(angles_from_rotation(rotation)).tolist()]
