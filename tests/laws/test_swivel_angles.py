"""Swivel angles of pulleys: where zero is, which files hold them, what is refused, templates, plans and pages."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.diagnosis.left_out import rows_of
from cdpr_struct.diagnosis.sensor_sigmas import sigmas_used
from cdpr_struct.errors import InputError
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.interface.new_campaign import new_campaign
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.observation.rest import rest
from cdpr_struct.residuals.assembled import linear_model
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.robot.tolerances import UNKNOWN_SWIVEL
from cdpr_struct.statics.swivel_angle import swivel_angle, swivel_reference, within_turn
from tests.laws.written_campaigns import extended, on_pulleys, plan_of, with_states, written

TWO = Path(__file__).parents[1] / "blind" / "robots" / "two-cables.toml"
ENTRY = '[[measurement]]\nkind = "{}"\nfile = "{}"\n'
STATES = ENTRY.format("static_state", "states.csv")


def on_wheels(*wheels: Pulley | None) -> Robot:
    return replace(load_robot(TWO), pulleys=wheels or (Pulley(0.05), Pulley(0.05)))


def loaded(folder: Path, robot: Robot, head: str = "", entries: str = STATES, **files: str) -> Campaign:
    (folder / "robot.toml").write_text(robot_toml(robot, "wheels"))
    for name, rows in files.items():
        (folder / f"{name}.csv").write_text(rows)
    (folder / "campaign.toml").write_text(f'robot = "robot.toml"\n{entries}{head}')
    return load_campaign(folder / "campaign.toml")


WIDE = "case,tension_1_N,tension_2_N,length_1_m,length_2_m,swivel_1_deg,swivel_2_deg\n"
ROW = "a,150,160,3.2,3.5,12.5,-170\nb,152,158,3.3,3.4,,100\n"


@pytest.mark.parametrize(
    ("axis", "direction", "degrees"),
    [
        ([0, 0, 1], [1, 0, -2], 0.0), ([0, 0, 1], [0, 1, 5], 90.0), ([0, 0, -1], [0, 1, 5], -90.0),
        ([1, 0, 0], [7, 0, -1], 0.0), ([1, 0, 0], [0, 1, 0], 90.0), ([-1, 0, 0], [0, 1, 0], -90.0),
        ([0, 1, 0], [1, 3, -1], -45.0), ([0.6, 0, 0.8], [1, 0, 0], 0.0), ([0.6, 0, 0.8], [0, 1, 0], 90.0),
        ([0, 0.1, 0.994987], [1, 0, 0], 0.0),
    ],
)  # fmt: skip
def test_zero_is_straight_down_or_world_x_and_turns_are_right_handed(axis, direction, degrees):
    """By hand; (0.6, 0, 0.8) is 37 degrees off the vertical, and straight down less its part along it points to +x."""
    own = np.array(axis, dtype=float)
    own /= np.linalg.norm(own)
    found = np.degrees(swivel_angle(np.array(direction, dtype=float), own, swivel_reference(own)))
    assert within_turn(np.radians(found - degrees)) == pytest.approx(0.0, abs=1e-6)


def test_files_with_a_row_a_pose_and_with_a_row_a_cable_say_the_same(tmp_path):
    wide = loaded(tmp_path, on_wheels(), states=WIDE + ROW).states
    rows = (
        "case,cable,tension_N,length_m,swivel_deg\na,1,150,3.2,12.5\na,2,160,3.5,-170\nb,1,152,3.3,\nb,2,158,3.4,100\n"
    )
    long = loaded(tmp_path, on_wheels(), states=rows).states
    np.testing.assert_allclose(np.degrees(wide.swivel), [[12.5, -170.0], [np.nan, 100.0]])
    np.testing.assert_array_equal(wide.swivel, long.swivel)
    np.testing.assert_allclose(np.degrees(wide.swivel_sigma[0]), 0.1)
    assert np.isnan(wide.swivel_sigma[1, 0])


def test_a_file_of_swivel_angles_alone_and_locked_poses_join_the_same_cases(tmp_path):
    entries = STATES + ENTRY.format("static_state", "angles.csv") + ENTRY.format("loaded_pose", "locked.csv")
    entries += "sigma = { swivel_deg = 0.05 }\n"
    files = {
        "states": "case,tension_1_N,tension_2_N\na,150,160\n", "angles": "case,swivel_1_deg,swivel_2_deg\na,3,4\n",
        "locked": "case,length_1_m,length_2_m,swivel_1_deg,swivel_2_deg\na,3.2,3.5,,\nc,3.2,3.6,5,\n",
    }  # fmt: skip
    found = loaded(tmp_path, on_wheels(), entries=entries, **files).states
    assert found.names == ("a", "c")
    np.testing.assert_allclose(np.degrees(found.swivel), [[3.0, 4.0], [5.0, np.nan]])
    np.testing.assert_allclose(np.degrees(found.swivel_sigma), [[0.1, 0.1], [0.05, np.nan]])
    np.testing.assert_array_equal(found.tension[0], [150.0, 160.0])
    files["locked"] = "case,length_1_m,length_2_m,swivel_1_deg,swivel_2_deg\na,3.2,3.5,3.5,\n"
    with pytest.raises(InputError, match=r"locked.csv.*row 1, case a, swivel angle of cable 1: got 3.5; 3, as another"):
        loaded(tmp_path, on_wheels(), entries=entries, **files)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (WIDE + ROW, r"states.csv.*row 1, column swivel_1_deg: got 12.5; an empty cell: cable 1 of .* has no pulley"),
        ("case,cable,length_m,swivel_deg\na,2,3,1\na,1,3,4\n", r"row 2, column swivel_deg: got 4.0; .*cable 1"),
        (WIDE + "a,150,160,3.2,3.5,,400\n", r"column swivel_2_deg: got 400.0; the angle .* from -360 to 360"),
        (WIDE + "a,150,160,3.2,3.5,,x\n", r"column swivel_2_deg: got 'x'; a number"),
        ("case,tension_1_N,tension_2_N,swivel_1_deg\na,1,2,3\n", r"column swivel_2_deg is missing"),
        ("case,tension_1_N,tension_2_N,swivel_deg\na,1,2,3\n", r"got 'swivel_deg'; one column a cable"),
    ],
)
def test_what_cannot_be_a_swivel_angle_is_refused(tmp_path, rows, said):
    with pytest.raises(InputError, match=said):
        loaded(tmp_path, on_wheels(None, Pulley(0.05)), states=rows)


def test_sigmas_and_tolerances_of_swivel_angles(tmp_path):
    campaign = loaded(tmp_path, on_wheels(), states=WIDE + ROW)
    used = {row.sigma: (row.words, row.source) for row in sigmas_used(campaign)}
    assert used["swivel_deg"] == ("0.1 deg", "default")
    assert campaign.tolerances.swivel_deg == UNKNOWN_SWIVEL
    none = loaded(tmp_path, on_wheels(), states="case,tension_1_N,tension_2_N\na,150,160\n")
    assert "swivel_deg" not in {row.sigma for row in sigmas_used(none)}
    known = loaded(tmp_path, on_wheels(), "[tolerances]\nswivel_deg = 0.5\n", states=WIDE + ROW)
    assert known.tolerances.swivel_deg == 0.5
    with pytest.raises(InputError, match=r"tolerances\.swivel_deg"):
        loaded(tmp_path, on_wheels(), "[tolerances]\nswivel_deg = -1.0\n", states=WIDE + ROW)


def test_a_zero_that_is_known_stays_in_the_readings(tmp_path):
    """Half a degree of tolerance: what is off by 10 degrees is off. Unknown, the first state tells it."""
    rows = "".join(
        f"{n},{x},0.4,2,0,0,0,150,160,3.2,3.5,{a},{b}\n" for n, x, a, b in (("a", 0, 5, 9), ("b", 0.1, 4, 9))
    )
    head = WIDE.replace("case,", "case,x_m,y_m,z_m,rx_deg,ry_deg,rz_deg,")
    told = []
    for tolerance in ("", "[tolerances]\nswivel_deg = 0.5\n"):
        data = recorded(loaded(tmp_path, on_wheels(), tolerance, states=head + rows))
        told.append(np.degrees(Local.about(data, Point.entered(data)).r.swivels).reshape((2, 2)))
    free, known = told
    np.testing.assert_allclose(free.sum(axis=0), 0.0, atol=1e-9)  # two readings about their median
    np.testing.assert_allclose(np.diff(free, axis=0), np.diff(known, axis=0), atol=1e-6)
    assert np.abs(known).max() > 5.0


def test_a_template_has_a_column_a_cable_and_empty_cells_without_a_pulley(tmp_path):
    (tmp_path / "robot.toml").write_text(robot_toml(on_wheels(None, Pulley(0.05)), "wheels"))
    made = new_campaign(tmp_path / "robot.toml", kinds="tensions,lengths,swivels", directory=tmp_path)
    header, row = made.files["states.csv"].splitlines()[-2:]
    cells = dict(zip(header.split(","), row.split(","), strict=True))
    assert (cells["swivel_1_deg"], cells["predicted_swivel_1_deg"], cells["swivel_2_deg"]) == ("", "", "?")
    assert -180.0 <= float(cells["predicted_swivel_2_deg"]) <= 180.0
    assert "swivel_deg = 0.1" in made.files["campaign.toml"]
    made.write(tmp_path)
    planned = load_campaign(tmp_path / "campaign.toml", planned=True).states
    np.testing.assert_allclose(np.degrees(planned.swivel[0, 1]), float(cells["predicted_swivel_2_deg"]))
    assert np.isnan(planned.swivel[0, 0])
    usual = new_campaign(tmp_path / "robot.toml", kinds="static_state").files["states.csv"]
    assert "swivel" not in usual
    with pytest.raises(InputError, match=r"kinds: got 'swivels'; a robot with pulleys: no cable of thesis-3-1"):
        new_campaign("thesis-3-1", kinds="swivels")


def test_a_plan_with_swivel_angles_detects_less(tmp_path):
    """Through files and the Python interface; without a measured pose, zeros unknown."""
    (tmp_path / "robot.toml").write_text(robot_toml(on_wheels(), "wheels"))
    poses = [[x, y, 2.0 + 0.2 * x] for x in (-0.5, 0.0, 0.5) for y in (0.35, 0.45)]
    least = []
    for kinds in ("tensions,lengths", "tensions,lengths,swivels"):
        new_campaign(tmp_path / "robot.toml", kinds=kinds, poses=poses, directory=tmp_path).write(
            tmp_path, overwrite=True
        )
        states = tmp_path / "states.csv"
        states.write_text(unposed(states.read_text()))
        found = cs.plan(tmp_path / "campaign.toml")
        least.append({row["cause"]: row["minimum_detectable"]["value"] for row in found.to_json()["detectable"]})
    without, with_them = least
    assert with_them["external_force"] < 0.8 * without["external_force"]  # measured 3.6 N against 5.1 N
    assert all(with_them[name] < 1.001 * value for name, value in without.items())


def unposed(text: str) -> str:
    """Rows of a template whose pose cells are empty."""
    lines = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
    for row in lines[1:]:
        row[1:7] = [""] * 6
    return "\n".join(",".join(row) for row in lines) + "\n"


@pytest.mark.slow
def test_pages_say_degrees(tmp_path):
    rows = "".join(f"{n},150,160,3.2,3.{k},12.5,-17{k}\n" for k, n in enumerate("abc", start=4))
    loaded(tmp_path, on_wheels(), states=WIDE + rows)
    found = cs.diagnose(tmp_path / "campaign.toml")
    by_kind = {row["kind"]: row["unit"] for row in found.to_json()["errors_by_state"]}
    assert by_kind["swivel angles"] == "deg"


@pytest.fixture(scope="module")
def beside_all() -> Campaign:
    """Exact readings of eight cables: four states, two of them at the locked lengths of the first, plucked and shaken
    in one of each kind; swivel angles of some cables, where the wheels face."""
    robot = on_pulleys("cogiro", 0.05)
    campaign = written(robot, plan_of(robot, 2, loads=(10.0, 20.0), cables_in=(0,), robot_in=(1,), modes=8))
    data = recorded(campaign)
    angle = data.swivels.reference, rest(data.arrays, data.readings, data.known).cables.force_at_frame
    swivel = swivel_angle(angle[1], data.arrays.pulley_axis, angle[0]) + np.radians(np.linspace(-170.0, 170.0, 8))
    swivel[0, 2], swivel[3, :5] = np.nan, np.nan
    return with_states(campaign, swivel=swivel, swivel_sigma=np.full_like(swivel, np.radians(0.05)))


def test_a_wrong_swivel_angle_stands_in_the_row_of_its_state_and_cable(beside_all):
    """Between cable frequencies and modes, in a block of locked states and alone."""
    for state, cable in ((0, 5), (2, 1), (1, 7)):
        swivel = beside_all.states.swivel.copy()
        swivel[state, cable] += np.radians(2.0)
        data = recorded(with_states(beside_all, swivel=swivel))
        where = layout(data)
        found = judged(data, where, Hypothesis())
        rows = rows_of(data, where, found, NoiseState.stated(found.model.groups))
        own = np.flatnonzero(rows.kind == "SW")
        assert len(own) == len(data.swivels) == 8 * 4 - 6
        worst = own[np.abs(rows.before[own]).argmax()]
        assert (rows.state[worst], rows.cable[worst]) == (state, cable)
        assert np.degrees(rows.before[worst]) == pytest.approx(2.0, abs=0.01)
        assert (rows.kind == "CF").sum() == 4 * 8
        rest_ = np.delete(np.arange(len(rows.kind)), worst)
        assert np.abs(rows.before[rest_] / rows.sigma[rest_])[rows.kind[rest_] != "RF"].max() < 0.3


def test_a_swivel_angle_depends_on_the_pose_of_its_own_state_alone(beside_all):
    """Rows of the block that four states share, against differences of the wheels' angles."""
    data = recorded(beside_all)
    where, local = layout(data), Local.about(data, Point.entered(data))
    model = linear_model(local, where)
    stack, shelf = next(
        (stack, shelf) for stack, shelf in zip(model.stacks, where.shelves, strict=True) if len(shelf.states[0]) == 3
    )
    first = 3 * (6 + 8) + shelf.cables.shape[1]
    at = stack.A[0, first : first + shelf.swivels.shape[1]]
    step = 1e-4
    for place, state in enumerate(shelf.states[0].tolist()):
        moved = np.zeros_like(data.sigma)
        moved[state, 0] = step / data.sigma[state, 0]
        there = local.nearby.swivels(local.arrays, local.point.readings(data, moved), data.swivels.reference)
        slope = (local.r.swivels - data.swivels.missed(there))[shelf.swivels[0]] / step * data.sigma[state, 0]
        np.testing.assert_allclose(at[:, place * (6 + 8)], slope, atol=1e-3 * np.abs(slope).max())
        assert (slope != 0.0).sum() == (data.swivels.state == state).sum()


def test_a_zero_in_the_robot_file_is_added_to_what_its_encoder_says(beside_all):
    """Zeros of -170 to 170 degrees as the extension `swivel_zero`, their tolerance stated: nothing is left."""
    zero = np.radians(np.linspace(-170.0, 170.0, 8))
    known = replace(beside_all, stated=frozenset({"swivel_deg"}))
    left = []
    for own in (zero, np.zeros(8)):
        data = recorded(replace(known, robot=extended(known.robot, swivel_zero=own)))
        left.append(np.degrees(np.abs(Local.about(data, Point.entered(data)).r.swivels)).max())
    assert left[0] < 1e-6
    assert left[1] == pytest.approx(170.0, abs=1e-6)
