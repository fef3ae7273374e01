"""result.json, table and words of an audit of a robot's cables against the printed limits."""

from typing import Any

import numpy as np

from cdpr_struct.crosscheck.limits_poses import CUT_SHORT, PARAMETERS, PoseAudit
from cdpr_struct.crosscheck.validity_limits import (
    CROSSOVER_DISTANCE,
    INCLINATION_EPSILON_PAIRS,
    LAMBDA_SQUARED_LIMIT,
    SAG_RATIO_LIMIT,
)
from cdpr_struct.measurement.campaign_rows import POSE
from cdpr_struct.reports.text import paragraphs, place, plain_table
from cdpr_struct.reports.trust import Check
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import anchors_in_world
from cdpr_struct.robot.robot_arrays import RobotArrays

_TIGHTENED = ("lambda2", "epsilon", "sag_ratio")
_WHEN_UNHELD = "choose poses that the cables can hold; `map --quantity workspace` shows where these are."


def audit_json(audit: PoseAudit, time: np.ndarray | None = None) -> dict[str, Any]:
    """The result under the keys that scripts rely on; poses as [x, y, z, rx, ry, rz] in m and deg."""
    poses = poses_in_degrees(audit)
    return {
        "robot": audit.robot.name,
        "platform_mass_kg": audit.robot.platform.mass,
        "poses": len(poses),
        "poses_held": int(audit.held.sum()),
        "poses_violated": int((audit.count > 0).sum()),
        "valid": bool(audit.held.any() and not (audit.count > 0).any()),
        "violations": _violations(audit, poses, time),
        "counts": {name: int(audit.broken[name].sum()) for name in PARAMETERS},
        "counts_by_cable": np.sum([audit.broken[name].sum(axis=0) for name in PARAMETERS], axis=0),
        "extremes": {name: _extreme(audit, name, poses) for name in PARAMETERS} if audit.held.any() else {},
        "unheld": [{"pose": poses[i], **_at(time, i), "reason": audit.reason[i]} for i in np.flatnonzero(~audit.held)],
        "printed_limits": {
            "lambda2": LAMBDA_SQUARED_LIMIT,
            "crossover_distance": CROSSOVER_DISTANCE,
            "alpha_deg_and_epsilon": [list(pair) for pair in INCLINATION_EPSILON_PAIRS],
            "sag_ratio": SAG_RATIO_LIMIT,
        },
        "verdict": sentences(audit),
    }


def poses_in_degrees(audit: PoseAudit) -> list[list[float]]:
    """[x, y, z, rx, ry, rz] of every pose, m and deg."""
    degrees = np.degrees(angles_from_rotation(audit.rotation)) + 0.0
    return np.concatenate([audit.position, degrees], axis=1).tolist()


def audit_columns(audit: PoseAudit, time: np.ndarray | None = None) -> dict[str, Any]:
    """Columns of audit.csv, one row a pose and cable."""
    m = audit.tension.shape[1]
    poses = np.repeat(poses_in_degrees(audit), m, axis=0)
    when = {} if time is None else {"time_s": np.repeat(time, m)}
    broken = np.stack([audit.broken[name].ravel() for name in PARAMETERS], axis=1)
    return {
        **when,
        **dict(zip(POSE, poses.T, strict=True)),
        "cable": np.tile(np.arange(1, m + 1), len(audit.held)),
        "held": np.repeat(audit.held.astype(int), m),
        "tension_N": audit.tension.ravel(),
        **{name: audit.value[name].ravel() for name in PARAMETERS},
        "epsilon_limit": audit.limit["epsilon"].ravel(),
        "violates": [";".join(n for n, b in zip(PARAMETERS, row, strict=True) if b) for row in broken],
    }


def audit_text(audit: PoseAudit) -> str:
    """Verdict, with the cables of a single pose or the counts over many."""
    table = _cables(audit) if len(audit.held) == 1 else _counts(audit)
    return paragraphs(table, "\n".join(sentences(audit)))


def sentences(audit: PoseAudit) -> list[str]:
    """The outcome in plain words."""
    total, held, bad = len(audit.held), int(audit.held.sum()), int((audit.count > 0).sum())
    where = "the pose" if total == 1 else f"{held} poses"
    unheld = [f"{total - held} of {total} poses cannot be held by the cables and were not checked."]
    found = unheld if held < total else []
    if not held:
        return [f"NOT CHECKED: {unheld[0]}", f"What to do: {_WHEN_UNHELD}"]
    found.append(f"What to do: {what_to_do(audit)}")
    if not bad:
        return [f"WITHIN THE PRINTED LIMITS: every cable at {where}.", *found]
    share = "" if total == 1 else f" {bad} of {held} poses are affected."
    parts = [f"{WORDS[name]} {_whose(b)} ({_worst(audit, name)})" for name, b in audit.broken.items() if b.any()]
    means = "; ".join(f"{WORDS[name]}: {MEANS[name]}" for name, b in audit.broken.items() if b.any())
    return [f"OUTSIDE THE PRINTED LIMITS: {', '.join(parts)}.{share}", f"What that means: {means}.", *found]


def what_to_do(audit: PoseAudit) -> str:
    """Which model to use for the robot, and what to change."""
    pulleys = any(audit.robot.pulleys)
    if (audit.count > 0).any():
        less = " A larger --lower-bound (or force_min) lowers lambda2, epsilon and sag."
        tighten = less if any(audit.broken[name].any() for name in _TIGHTENED) else ""
        return f"use the exact model, the default of all commands, which has none of these limits.{tighten}"
    if pulleys:
        return (
            "use the exact model, the default of all commands: the limits say nothing of pulleys, which the closed "
            "form (--model dsm) does not have. verify shows by how much it is off."
        )
    return (
        "use the exact model, the default of all commands. The closed form (--model dsm) is inside its limits, which "
        "do not cover inertia along the cable: verify shows whether it is close enough."
    )


def audit_checks(audit: PoseAudit) -> list[Check]:
    """Whether an audit over many poses can be trusted: searches that were cut short, and slack cables."""
    cut = sum(reason == CUT_SHORT for reason in audit.reason)
    lost = f"at {cut} of {len(audit.held)} poses the search for tensions ended before it had converged: not checked."
    slack = _slack_poses(audit)
    where = "the pose" if len(audit.held) == 1 else f"{slack} poses"
    loose = f"At {where} cables hang slack (less tension than weight): --lower-bound N or force_min tightens them."
    return [
        Check.of("searches cut short", cut, 0.0, lost if cut else None),
        Check.of("poses with slack cables", slack, 0.0, loose if slack else None),
    ]


def _slack_poses(audit: PoseAudit) -> int:
    """At how many poses a cable pulls with less than its own weight."""
    robot = audit.robot
    chord = anchors_in_world(robot, audit.position, audit.rotation) - robot.frame_anchors
    weight = RobotArrays.of(robot).cable_load(chord)[0] * np.linalg.norm(chord, axis=-1)
    return int((audit.held & (audit.tension < weight).any(axis=-1)).sum())


def _whose(broken: np.ndarray) -> str:
    """Which cables at one pose; how many of all cables at many."""
    if len(broken) == 1:
        return "of cable " + ", ".join(str(i + 1) for i in np.flatnonzero(broken[0]))
    return f"in {int(broken.sum())} cases"


def _worst(audit: PoseAudit, name: str) -> str:
    value = np.where(audit.broken[name], audit.value[name], np.nan)
    least = name == "crossover_distance"
    worst = float(np.nanmin(value) if least else np.nanmax(value))
    limit = "a limit by inclination" if name == "epsilon" else f"a limit of {_limit(name, audit.limit[name].flat[0])}"
    return f"worst {worst:.4g} against {limit}"


def _violations(audit: PoseAudit, poses: list[list[float]], time: np.ndarray | None) -> list[dict[str, Any]]:
    found = []
    for name in PARAMETERS:
        for pose, cable in np.argwhere(audit.broken[name]):
            found.append(
                {
                    "pose": poses[pose],
                    **_at(time, pose),
                    "cable": int(cable) + 1,
                    "parameter": name,
                    "value": float(audit.value[name][pose, cable]),
                    "limit": float(audit.limit[name][pose, cable]),
                }
            )
    return found


def _at(time: np.ndarray | None, pose: np.integer) -> dict[str, float]:
    return {} if time is None else {"time_s": float(time[pose])}


def _extreme(audit: PoseAudit, name: str, poses: list[list[float]]) -> dict[str, Any]:
    value = audit.value[name]
    flat = int(np.nanargmin(value) if name == "crossover_distance" else np.nanargmax(value))
    pose, cable = divmod(flat, value.shape[1])
    limit = float(audit.limit[name][pose, cable])
    return {"value": float(value[pose, cable]), "limit": limit, "cable": cable + 1, "pose": poses[pose]}


WORDS = dict(zip(PARAMETERS, ("λ²", "crossover distance", "|α|", "ε", "sag/chord"), strict=True))
"""The parameters as tables and figures name them."""
MEANS = {
    "lambda2": "sag makes the cable much softer along its chord, and its in-plane frequencies change places",
    "crossover_distance": "two frequencies of the cable nearly meet there, and small errors exchange their modes",
    "alpha_deg": "the cable is so steep that its weight along the chord changes the tension along it",
    "epsilon": "the cable's weight is not small beside its tension, so that terms left out of the closed form count",
    "sag_ratio": "the cable hangs deeper than the parabola that the closed form takes for it",
}
"""What follows from a broken limit for the closed form."""
CABLE_COLUMNS = ["cable", "tension [N]", "λ²", "crossover distance", "|α| [°]", "ε", "ε limit", "sag/chord", "breaks"]


def cable_rows(audit: PoseAudit, pose: int) -> list[list[str]]:
    """One row a cable at one pose."""
    rows = []
    for i in range(audit.tension.shape[1]):
        value = {name: audit.value[name][pose, i] for name in PARAMETERS}
        broken = ", ".join(WORDS[name] for name in PARAMETERS if audit.broken[name][pose, i])
        rows.append(
            [
                str(i + 1), f"{audit.tension[pose, i]:.2f}", f"{value['lambda2']:.3f}",
                f"{value['crossover_distance']:.2f}", f"{value['alpha_deg']:.1f}", f"{value['epsilon']:.4f}",
                f"{audit.limit['epsilon'][pose, i]:g}", f"{value['sag_ratio']:.4f}", broken or "-",
            ]
        )  # fmt: skip
    return rows


def _cables(audit: PoseAudit) -> str:
    return plain_table(f"{audit.robot.name} at {place(audit.position[0])}", CABLE_COLUMNS, cable_rows(audit, 0))


COUNT_COLUMNS = [
    "limit",
    *("cables outside", "poses", "worst value", "limit there", "cable", "x [m]", "y [m]", "z [m]"),
]


def count_rows(audit: PoseAudit) -> list[list[str]]:
    """One row a printed limit over all poses."""
    if not audit.held.any():
        return []
    poses, rows = poses_in_degrees(audit), []
    for name in PARAMETERS:
        worst = _extreme(audit, name, poses)
        rows.append(
            [
                f"{WORDS[name]} [°]" if name == "alpha_deg" else WORDS[name], str(int(audit.broken[name].sum())),
                str(int(audit.broken[name].any(axis=1).sum())), f"{worst['value']:.4g}", _limit(name, worst["limit"]),
                str(worst["cable"]), *(f"{v:g}" for v in worst["pose"][:3]),
            ]
        )  # fmt: skip
    return rows


def _limit(name: str, value: float) -> str:
    """A limit with its side; the one on ε is none where the cable is too steep."""
    if not value:
        return "steep"
    return f"{'>=' if name == 'crossover_distance' else '<='} {value:.4g}"


def _counts(audit: PoseAudit) -> str:
    title = f"{audit.robot.name}, {len(audit.held)} poses, {int(audit.held.sum())} held"
    return plain_table(title, COUNT_COLUMNS, count_rows(audit))
