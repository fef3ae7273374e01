"""Measurements beside the robot that tell the names of an ambiguous case apart, and how a campaign says them.

What is measured is entered in the robot file whatever it turns out to be, and the campaign's [checked] table says how
far it may still be off. Nothing here looks at which effect was hidden.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from tests.blind.deviations import Deviations
from tests.blind.entered_robot import EnteredRobot

SURVEY = 5e-4  # m, 1 sigma of each coordinate of a surveyed frame anchor
GAUGE = 1e-7  # m/N, of the compliance read by a dial gauge across a joint
THERMOMETER = 1.0  # K
_ANCHOR = re.compile(r"^frame_anchor = \[.*\]$", re.MULTILINE)


@dataclass(frozen=True, eq=False)
class BesideCheck:
    """A check and what it leaves.

    left       : one sigma of what each of these causes may still be, in its unit
    robot_text : robot file with what was measured, None if nothing had to be entered
    measured   : causes that, if they are there, are now in the robot file
    """

    left: Mapping[str, float]
    robot_text: str | None = None
    measured: tuple[str, ...] = ()


def survey(robot: EnteredRobot, deviations: Deviations, rng: np.random.Generator) -> BesideCheck:
    """Every frame anchor in the frame's own axes, by an instrument that is not the platform's tracker."""
    true = robot.frame_anchors + deviations["frame_anchor_position"].reshape(-1, 3)
    seen = iter(true + SURVEY * rng.standard_normal(true.shape))
    text, count = _ANCHOR.subn(lambda _: f"frame_anchor = [{', '.join(f'{v:.6f}' for v in next(seen))}]", robot.text)
    if count != robot.cables:
        raise ValueError(f"{robot.name}: {count} frame anchors in the robot file, {robot.cables} cables")
    return BesideCheck({"frame_anchor_position": SURVEY}, text, ("frame_anchor_position",))


def gauge(robot: EnteredRobot, deviations: Deviations, rng: np.random.Generator) -> BesideCheck:
    """A dial gauge across joint and load cell of every cable; what lies behind the exit is not in it."""
    if "[extensions]" in robot.text:
        raise ValueError(f"{robot.name}: the robot file has extensions already")
    seen = np.maximum(deviations["joint_compliance"] + GAUGE * rng.standard_normal(robot.cables), 0.0)
    entered = ", ".join(f"{value:.4g}" for value in seen)
    text = f"{robot.text}\n[extensions]\nseries_compliance = [{entered}]\n"
    return BesideCheck({"joint_compliance": GAUGE}, text, ("joint_compliance",))


def thermometer(robot: EnteredRobot, deviations: Deviations, rng: np.random.Generator) -> BesideCheck:
    """Cables and frame at their calibration temperature; a robot file holds no other one."""
    seen = float(deviations["temperature"][0] + THERMOMETER * rng.standard_normal())
    if abs(seen) > 4.0 * THERMOMETER:
        raise ValueError(f"{robot.name} is {seen:.0f} K off its calibration, which no entry of a robot file says")
    return BesideCheck({"temperature": THERMOMETER})


CHECKED: dict[str, Callable[[EnteredRobot, Deviations, np.random.Generator], BesideCheck]] = {
    "tracker_frame": survey, "joint_compliance": gauge, "dead_length": gauge, "drum_scale": thermometer,
}  # fmt: skip
