"""What decides whether a map can be trusted: poses whose search was cut short, slack and sag, strain."""

from typing import Any

import numpy as np

from cdpr_struct.reports.trust import Check, Trust
from cdpr_struct.robot.plausibility import BREAKING_STRAIN
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.bound_advice import shared_cure
from cdpr_struct.statics.slack_cables import DEEP
from cdpr_struct.statics.strained_cables import torn_sentence
from cdpr_struct.statics.sufficient_bound import shared_bound_of_pose_errors, shared_lower_bound
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.work_list import Columns

_MOST_HELD, _MOST_RELEASED = 64, 16  # poses with slack cables at which a cure is searched; a release takes longer


def trust_over_poses(robot: Robot, grid: Grid, columns: Columns, released: bool = False) -> Trust:
    """Whether a map can be trusted, as far as its columns say.

    released : the platform is let go at ideal lengths (pose errors), not held at the poses
    """
    checks = [
        _cut_short(grid, columns), _slack(robot, grid, columns, released), _sag(grid, columns), _strain(grid, columns)
    ]  # fmt: skip
    return Trust(tuple(check for check in checks if check is not None))


def slack_poses(columns: Columns) -> np.ndarray:
    """Numbers of the poses at which a cable hangs slack."""
    return np.flatnonzero(columns.get("slack_cables", np.zeros(0)) > 0.0)


def deep_sag(columns: Columns) -> dict[str, Any]:
    """At how many poses a cable sags by a tenth of its chord, and the largest sag; nothing where it is not known."""
    sag = columns.get("sag_over_chord_max")
    if sag is None or not np.isfinite(sag).any():
        return {}
    return {"deep_sag_poses": int((sag >= DEEP).sum()), "sag_over_chord_max": float(np.nanmax(sag))}


def _cut_short(grid: Grid, columns: Columns) -> Check | None:
    if "cut_short" not in columns:
        return None
    count = int(columns["cut_short"].sum())
    said = (
        f"at {_where(count, grid)} the search for tensions ended before it had converged; the map counts them as not "
        "held. Raise the lower bound: the tensions may lie where cable weight and tension balance."
    )
    return Check.of("searches cut short", count, 0.0, said if count else None)


def _slack(robot: Robot, grid: Grid, columns: Columns, released: bool) -> Check:
    """Slack cables, and the lower bound that would cure them."""
    slack = slack_poses(columns)
    what = "poses with slack cables"
    if not slack.size:
        return Check.of(what, 0, 0.0, None)
    most = _MOST_RELEASED if released else _MOST_HELD
    when = " once the platform is let go" if released else ""
    said = f"Cables hang slack at {_where(len(slack), grid)}{when} (they pull with less than their own weight)"
    if "rx_deg" in columns:  # a bound would turn the platform, too
        return Check.of(what, len(slack), 0.0, f"{said}.")
    tried = slack[np.unique(np.linspace(0, len(slack) - 1, min(most, len(slack))).astype(int))]
    search = shared_bound_of_pose_errors if released else shared_lower_bound
    cure = shared_cure(search(robot, grid.positions[tried], grid.rotation), len(slack))
    return Check.of(what, len(slack), 0.0, f"{said}; {cure}.")


def _sag(grid: Grid, columns: Columns) -> Check | None:
    told = deep_sag(columns)
    if not told:
        return None
    count, most = told["deep_sag_poses"], told["sag_over_chord_max"]
    said = (
        f"Deep sag: at {_where(count, grid)} a cable sags by a tenth of its chord or more, at most by {most:.2g} of it."
    )
    return Check.of("largest sag over chord", most, DEEP, said if count else None)


def _strain(grid: Grid, columns: Columns) -> Check | None:
    strain = columns.get("strain_max")
    if strain is None or not np.isfinite(strain).any():
        return None
    most, count = float(np.nanmax(strain)), int((strain > BREAKING_STRAIN).sum())
    beyond = f"At {_where(count, grid)} a cable is stretched beyond {100.0 * BREAKING_STRAIN:g} %, at most"
    return largest_strain(most, beyond)


def largest_strain(most: float, stretched: str) -> Check:
    """The largest strain of many states; `stretched` begins the sentence that is said where ropes break."""
    said = torn_sentence(stretched, most) if most > BREAKING_STRAIN else None
    return Check.of("largest strain", 100.0 * most, 100.0 * BREAKING_STRAIN, said, "%")


def _where(count: int, grid: Grid) -> str:
    return f"{count} of {grid.size} poses" if grid.size > 1 else "the pose"
