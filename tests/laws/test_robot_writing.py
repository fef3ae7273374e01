"""A robot that is written and read again is the same, and that of a diagnosis explains what it was fitted to."""

import re
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.left_out import rows_of
from cdpr_struct.errors import InputError
from cdpr_struct.generated.platform import rotation
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.extensions import uprights_of
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot, robot_of_text
from cdpr_struct.robot.robot_from_arrays import bodily, robot_from_arrays
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.robot.tolerances import Spread, places
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.masts import carriers
from tests.laws.written_campaigns import plan_of, written


def everything() -> RobotArrays:
    """CoGiRo with every number off, each by another share."""
    arrays, each = RobotArrays.of(load_robot("cogiro")), np.linspace(0.5, 1.5, 8)
    body = arrays.with_point_masses(0.1 * each, arrays.platform_anchors)
    exits = arrays.frame_anchors + 1e-3 / 3.0
    return replace(
        body, axial_stiffness=arrays.axial_stiffness * each, linear_density=arrays.linear_density * each,
        frame_anchors=exits, platform_anchors=arrays.platform_anchors * (1.0 + 1e-3 / 7.0),
        length_offset=0.002 * each, length_scale=1.0 + 0.001 * each, series_compliance=2e-6 * each,
        frame_compliance=2e-6 * np.linspace(0.0, 1.5, 4) @ carriers(arrays.masts).T, cell_gain=1.0 + 0.01 * each,
        mast_bending=1e-6 * np.linspace(2.0, 0.5, 4) @ carriers(arrays.masts).T, mast_foot=np.array(-1.0 / 3.0),
        mast_mass=0.7 * each,
        uprights=uprights_of(exits, -1.0 / 3.0),
        cell_bias=2.0 * each, friction=0.02 * each,
        bearing_friction=0.03 * each, pulley_drag=1.5 * each, backlash=1e-3 * each,
        force=np.array([5.0, -3.0, 2.0]), hose=np.array(30.0),
        hose_center=np.array([0.1, 0.2, 1.0 / 3.0]), tilt=np.array([0.002, -0.001]),
        moment=np.array([1.0, -2.0, 1.0 / 3.0]), drag_area=np.array(1.3), drag_width=np.array(0.012),
        wind=np.array([6.0, -5.0, 1.0 / 3.0]), air_density=np.array(1.1), temperature_change=np.array(-12.5),
        nonlinearity=np.array(0.1), stiffening_exponent=np.array(0.2), incremental_ratio=np.array(1.25),
        reference_tension=np.array(1000.0 / 3.0), tracker=np.array([0.001, 0.0, 0.002, 0.0, 0.001, 0.0]),
        creep=np.array(0.05), slip=1e-4 * each, sensor_mass=np.array(2.0), bending_stiffness=0.1 * each,
        added_mass=0.01 * each, internal_mass=np.array(20.0 / 3.0), internal_frequency=np.array(7.1),
        internal_direction=np.array([0.48, 0.6, 0.64]), swinging_mass=np.array(5.0 / 3.0),
        swinging_frequency=np.array(0.7), swinging_place=np.array([0.1, 0.0, -1.0 / 3.0]),
    )  # fmt: skip


def test_a_robot_that_is_written_and_read_again_has_the_same_arrays(tmp_path):
    robot = robot_from_arrays(load_robot("cogiro"), everything(), ("platform_mass",))
    (tmp_path / "robot.toml").write_text(robot_toml(robot, 'a "new" name', ["first line", "second\tline"]))
    again = load_robot(tmp_path / "robot.toml")
    assert again.name == 'a "new" name'
    assert again.extensions.causes == ("platform_mass",)
    assert again.home.position == pytest.approx(robot.home.position)
    for field in fields(RobotArrays):
        expected, found = (np.asarray(getattr(arrays, field.name)) for arrays in (everything(), RobotArrays.of(again)))
        np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), rtol=1e-12, atol=0.0)


def test_arrays_of_several_robots_are_no_robot():
    arrays = RobotArrays.of(load_robot("cogiro"))
    with pytest.raises(ValueError, match=r"RobotArrays.mass describes more than one robot: it has the shape \(2,\)"):
        robot_from_arrays(load_robot("cogiro"), replace(arrays, mass=np.array([100.0, 110.0])))


def test_an_inertia_that_no_body_has_becomes_the_nearest_that_one_has():
    """Principal moments 1, 2, 4: the largest becomes 3, along the same axes."""
    turn = Rotation.from_rotvec([0.3, -0.2, 0.5]).as_matrix()
    assert bodily(turn @ np.diag([1.0, 2.0, 4.0]) @ turn.T) == pytest.approx(turn @ np.diag([1.0, 2.0, 3.0]) @ turn.T)


def commanded(true_robot):
    """Clean tensions and lengths of a robot at rest at the poses of a campaign whose robot is the entered one."""
    robot = load_robot("cogiro")
    campaign = written(robot, plan_of(robot, 6))
    states, more = campaign.states, true_robot.extensions
    held = [
        inverse(true_robot.with_load(float(w)), p, rotation(*a))
        for w, p, a in zip(states.payload, states.position, states.angles, strict=True)
    ]
    tension = np.array([h.tensions for h in held]) * more.cell_gain + more.cell_bias
    return replace(campaign, states=replace(states, tension=tension, length=np.array([h.lengths for h in held])))


def rms_in_sigmas(campaign) -> float:
    """Of all rows as entered, under noise and tolerances."""
    data = recorded(campaign)
    where = layout(data)
    null = judged(data, where, Hypothesis())
    rows = rows_of(data, where, null, NoiseState.stated(null.model.groups))
    return float(np.sqrt(np.mean((rows.before / rows.sigma) ** 2)))


@pytest.mark.parametrize(
    ("cause", "change"),
    [
        ("axial_stiffness", lambda a: replace(a, axial_stiffness=0.8 * a.axial_stiffness)),
        ("load_cell_gain", lambda a: replace(a, cell_gain=1.08 * a.cell_gain)),
    ],
)
def test_the_extended_robot_explains_its_campaign(cause, change, tmp_path):
    entered = load_robot("cogiro")
    campaign = commanded(robot_from_arrays(entered, change(RobotArrays.of(entered))))
    found = diagnosed(campaign)
    assert found.extended.extensions.causes == (cause,)
    (tmp_path / "robot.toml").write_text(robot_toml(found.extended, "again"))
    mended = replace(campaign, robot=load_robot(tmp_path / "robot.toml"))
    assert rms_in_sigmas(campaign) > 1.0
    assert rms_in_sigmas(mended) < 0.2
    kept, known = found.extended.posterior, mended.robot.posterior
    assert np.allclose(known.root, kept.root, rtol=1e-6, atol=1e-12)
    assert np.allclose(known.mean, kept.mean, rtol=1e-6, atol=1e-12)
    before = Spread.within(campaign.tolerances, 8)
    own = np.eye(len(before.root))
    narrower = known.sigma(own) <= 1.01 * before.sigma(own) + 1e-12
    assert narrower[: places(8)[-3].start].all()  # of all but the load cells, one of which is the cause
    anchors = places(8)[0]
    assert (known.sigma(own)[anchors] > 0.0).all()
    weights = np.linalg.pinv(before.root) @ known.root
    assert np.linalg.svd(weights, compute_uv=False).min() < 0.3  # some combination is known much better


@pytest.mark.parametrize(
    ("broken", "said"),
    [("mean = [0.0]\nroot = []\n", "posterior.mean: got '1 numbers'"), ("root = []\n", "posterior.mean")],
)
def test_a_posterior_that_does_not_fit_the_robot_is_refused(broken, said):
    text = f"{robot_toml(load_robot('cogiro'), 'again')}\n[posterior]\n{broken}"
    with pytest.raises(InputError, match=re.escape(said)):
        robot_of_text(text, "robot.toml")
