"""Sets of robots with few cables, without poses, with pulleys in no file: what is drawn, and what is handed out."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.blind.answers import names_in_truth
from tests.blind.campaign_files import write_case
from tests.blind.case_drawing import Case
from tests.blind.catalogue import LIBRARY
from tests.blind.controller import hanging
from tests.blind.detectability import FEW, UNREAD, reference_size, typical_size
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import EnteredRobot, entered_robot
from tests.blind.measuring_plan import PlanSize
from tests.blind.spoilt_sets import WHEELS, SpoiltKind, spoilt_cases, spoilt_kinds
from tests.blind.true_robot import Command, true_robot

SMALL = PlanSize(static_states=2, locks=1, loads_per_lock=2)


def test_every_robot_has_as_many_cases_and_a_third_of_nulls():
    kinds = spoilt_kinds("few", 6 * len(FEW), 1)
    for robot in FEW:
        own = [kind.reality for kind in kinds if kind.way == robot]
        assert len(own) == 6
        assert sum(kind.kind == "null" for kind in own) == 2
    assert len({kind.group for kind in kinds}) == len(kinds)


@pytest.mark.parametrize("robot", ["two-cables", "four-cables-inclined"])
def test_a_campaign_holds_what_the_robot_s_sensors_read(tmp_path, robot):
    kind = next(kind for kind in spoilt_kinds("few", 3 * len(FEW), 1) if kind.way == robot)
    kind = replace(kind, reality=replace(kind.reality, size=SMALL))
    ((name, case, seed),) = spoilt_cases([("c001", kind)], 1)
    file = write_case(case, name, seed, tmp_path / "campaigns", tmp_path / "sealed")
    assert 'robot = "robot.toml"' in file.read_text()
    cables, tracked = entered_robot(robot).cables, not robot.endswith("inclined")
    assert (file.parent / "robot.toml").read_text().count("[[cables]]") == cables
    for table in case.tables.values():
        assert ("x_m" in table) == ("rz_deg" in table) == tracked
        assert {"rx_deg", "ry_deg"} <= set(table)


def handed_out(kind: SpoiltKind, folder: Path) -> tuple[Path, Case]:
    """Directory of the only campaign of a small plan, and its case."""
    kind = replace(kind, reality=replace(kind.reality, size=SMALL))
    ((name, case, seed),) = spoilt_cases([("c001", kind)], 1)
    return write_case(case, name, seed, folder / "campaigns", folder / "sealed").parent, case


@pytest.mark.parametrize("robot", UNREAD)
def test_a_campaign_without_any_pose_holds_none(tmp_path, robot):
    kinds = [kind for kind in spoilt_kinds("unread", 6 * len(UNREAD), 1) if kind.way == robot]
    assert [sum(kind.reality.kind == which for kind in kinds) for which in ("null", "single")] == [2, 4]
    folder, case = handed_out(next(kind for kind in kinds if kind.reality.kind == "null"), tmp_path)
    assert f'robot = "{robot.removesuffix("-unread")}"' in (folder / "campaign.toml").read_text()
    for table in case.tables.values():
        assert not {"x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg"} & set(table)


def test_pulleys_are_in_the_robot_its_file_or_both_as_the_way_says(tmp_path):
    kinds = spoilt_kinds("wheels", 3 * 6, 1)
    for way, real, filed in zip(WHEELS, (0, 4, 8), (0, 4, 0), strict=True):
        own = [kind for kind in kinds if kind.way == way]
        assert [kind.reality.kind for kind in own].count("null") == (6 if way == "bare" else 2)
        kind = next(kind for kind in own if kind.reality.kind == "null")
        folder, case = handed_out(kind, tmp_path / way)
        robot = case.robot
        truth = true_robot(robot, Deviations.none(8), command_of(robot), np.eye(3), np.zeros((8, 3)))
        wheels = truth.pulleys or (None,) * 8
        assert sum(wheel is not None for wheel in wheels) == real
        assert pulleys_of(folder) == filed
        assert names_in_truth(case.truth) == (("missing_pulleys",) if way == "bare" else ())


def pulleys_of(folder: Path) -> int:
    """Cables with a pulley in the robot file of a campaign; a built-in robot, which has no file there, has none."""
    if not (folder / "robot.toml").exists():
        return 0
    table = tomllib.loads((folder / "robot.toml").read_text("utf-8"))
    return sum("pulley" in {**table.get("cable", {}), **cable} for cable in table["cables"])


def command_of(robot: EnteredRobot) -> Command:
    lengths = np.linalg.norm(robot.frame_anchors - robot.home, axis=1)
    return Command(lengths, 0.0, np.ones(8), robot.home, np.eye(3))


def test_a_robot_hangs_where_its_forces_meet_the_weight():
    """Two cables: their planes and the centre of mass lie in one vertical plane, but for the cables' own weight."""
    robot = entered_robot("two-cables")
    lengths, position, rotation, tensions = hanging(robot, robot.home, 0.0)
    away = robot.frame_anchors - position - robot.platform_anchors @ rotation.T
    force = (tensions / np.linalg.norm(away, axis=1)) @ away
    cables = robot.linear_density * lengths
    carried = robot.gravity * (robot.mass + 0.5 * cables.sum())  # half of each cable hangs on the platform
    # straight chords: a sag of half a per cent turns the pull by as much
    assert force[2] == pytest.approx(carried, rel=0.01)
    assert np.abs(force[:2]).max() < 0.01 * carried


@pytest.mark.parametrize("robot", [*FEW, *UNREAD])
def test_a_mass_shows_as_far_as_the_cells_allow(robot):
    """Gains of .5 % of single cells and .1 kg: with m cells 4.1 sigmas of a mass are some per cent of it."""
    entered = entered_robot(robot)
    size = reference_size(robot, "platform_mass", np.ones(1), 1, True)
    assert size is not None
    assert 4.1 * 0.1 < size < 0.05 * entered.mass
    assert reference_size(robot, "internal_force", np.ones(2), 1, True) is None
    assert typical_size(robot, "platform_mass") is None  # it stands in no set with frequencies
    assert LIBRARY["platform_mass"].largest > 4.0 * size
