"""One case of a blind set: the robot as its diagnosis extended it, and as it is, at poses that were not measured."""

import json
from pathlib import Path
from typing import Any

import numpy as np

import cdpr_struct as cs
from benchmarks.band_coverage.fem_rest import FemRest
from benchmarks.diagnosed_bands.truth import FREQUENCIES, POSES, TrueRobot
from cdpr_struct.fem_reference import FemError
from cdpr_struct.robot.pose import angles_from_rotation
from tests.blind.true_robot import Command

LEVELS = (50, 90, 99)
_SEED = 35

Told = dict[str, Any]


def tried(folder: Path, number: int) -> Told:
    """What came of a case of a blind set: of each pose the distances of truths from what is predicted and the sigmas of
    the bands, in units of the truth, and whether they lie in the bands."""
    case = folder / "answers" / f"c{number:03d}"
    about: Told = {"seed": number, "set": folder.name}
    robot = case / "extended_robot.toml"
    if not robot.exists():
        return about | {"refused": "no extended robot"}
    true = TrueRobot.opened(folder.with_name(f"{folder.name}-sealed") / f"{case.name}.json")
    rng = np.random.default_rng([_SEED, number])
    status = json.loads((case / "result.json").read_text("utf-8"))["verdict"]["status"]
    about |= {"robot": true.entered.name, "cables": true.entered.cables, "chosen": _chosen(true, rng)}
    about |= {"kind": true.about["kind"], "status": status, "way": true.about.get("way", ""), "poses": []}
    about["hidden"] = [effect["cause"] for effect in true.about["effects"]]
    for command in true.commands(rng):
        try:
            about["poses"].append(_at_pose(robot, command, true.at(command)))
        except (cs.CdprError, FemError, RuntimeError) as error:
            about["poses"].append({"lost": f"{type(error).__name__}: {error}"})
    return about


def _chosen(true: TrueRobot, rng: np.random.Generator) -> list[int]:
    """Pose, and places of one frequency, one component of the pose and one tension that count for limits."""
    m = true.entered.cables
    ranges = POSES, FREQUENCIES, 6, m
    pose, mode, component, cable = (int(rng.integers(count)) for count in ranges)
    return [pose, 6 + m + mode, component, 6 + cable]


def _at_pose(robot: Path, command: Command, truth: FemRest) -> Told:
    start = cs.Pose(command.position, angles_from_rotation(command.rotation))
    asked: dict[str, Any] = {"payload": command.payload, "start": start, "lengths": command.lengths}
    inside = {}
    for level in LEVELS:
        rest = cs.forward(robot, command.lengths, payload=command.payload, start=start, band=level)
        modes = cs.modes(robot, count=FREQUENCIES, band=level, **asked)
        told, hertz = rest.answer["bands"], modes.answer["bands"]
        ends = np.concatenate([told["pose"], told["tensions_N"], hertz["frequencies_hz"]])
        inside[str(level)] = ((ends[:, 0] <= truth.all) & (truth.all <= ends[:, 1])).tolist()
    sigma = np.concatenate([told["pose_sigma"], told["tension_sigma_N"], hertz["sigma_hz"]])
    off = truth.all - ends.mean(axis=1)
    return {"off": off.tolist(), "sigma": sigma.tolist(), "inside": inside}
