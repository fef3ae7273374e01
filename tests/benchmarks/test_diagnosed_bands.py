"""The study of bands after a diagnosis: the truth is the entered robot where nothing is off; misses are counted."""

from dataclasses import replace

import numpy as np

import cdpr_struct as cs
from benchmarks.diagnosed_bands.summary import summary
from benchmarks.diagnosed_bands.truth import FREQUENCIES, TrueRobot
from cdpr_struct.robot.pose import angles_from_rotation
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import entered_robot


def true_robot(name: str) -> TrueRobot:
    entered = entered_robot(name)
    return TrueRobot(entered, Deviations.none(entered.cables), {"kind": "null"})


def test_where_nothing_is_off_the_truth_is_what_is_predicted():
    true = true_robot("cogiro")
    command = true.commands(np.random.default_rng(3))[0]
    there = true.at(command)
    start = cs.Pose(command.position, angles_from_rotation(command.rotation))
    modes = cs.modes("cogiro", lengths=command.lengths, start=start, payload=command.payload, count=FREQUENCIES)
    np.testing.assert_allclose(there.hertz, modes.modes.hertz, rtol=2e-5)
    np.testing.assert_allclose(there.tension, modes.point.cables.tension_at_platform, rtol=1e-3)
    np.testing.assert_allclose(there.pose[:3], modes.point.position, atol=1e-5)
    heavier = replace(true, deviations=true.deviations.plus("platform_mass", np.array([5.0]))).at(command)
    assert np.abs(heavier.hertz / there.hertz - 1.0).max() > 1e-3


def told(number: int, off: float) -> dict:
    inside = {str(level): (abs(off) <= reach) for level, reach in ((50, 0.674), (90, 1.645), (99, 2.576))}
    m, count = 8, 6 + 8 + FREQUENCIES
    pose = {"off": [off] * count, "sigma": [1.0] * count, "inside": {k: [v] * count for k, v in inside.items()}}
    return {
        "seed": number, "kind": "single", "status": "named", "cables": m, "chosen": [0, 6 + m, 0, 6],
        "poses": [pose, {"lost": "no rest"}],
    }  # fmt: skip


def test_shares_are_counted_by_what_was_said_and_lost_poses_are_outside():
    text = summary([*(told(n, off) for n, off in enumerate((0.1, 1.0, 2.0, 3.0))), {"seed": 9, "refused": "none"}])
    assert "| inside, named | 4 | 1 / 2 / 3 | 1 / 2 / 3 | 1 / 2 / 3 |" in text
    assert "1 cases have no extended robot; 4 poses came to no answer" in text
    assert "| inside, named | 4 | 12 / 25 / 38 |" in text
