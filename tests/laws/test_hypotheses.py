"""Causes: priors, patterns of occurrence, and those that a user or an installed package adds (crime=True)."""

from dataclasses import replace
from importlib.metadata import EntryPoint

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.hypotheses.causes import library
from cdpr_struct.hypotheses.causes.cause import Cause, Parameter
from cdpr_struct.hypotheses.causes.library import LIBRARY, register
from cdpr_struct.hypotheses.correction import BEYOND_NOISE, several_tilted
from cdpr_struct.hypotheses.handling import corrections
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.changed_arrays import times
from cdpr_struct.robot.parameters import PARAMETERS
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from tests.laws.written_campaigns import noisy, plan_of, written

GROWTH = 2.4e-5  # [1/K], aluminium


def warmed(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """The frame alone has grown: cables are of fibre."""
    return times(arrays, frame_anchors=1.0 + GROWTH * theta[..., None])


WARM_FRAME = Cause(
    "warm_frame", "an aluminium frame is warmer than at calibration", (Parameter("rise", "K", 15.0),), warmed,
    seen_in=("CO",), sentence="the frame is {value} K warmer",
)  # fmt: skip


@pytest.fixture(autouse=True)
def _library_stays():
    before = dict(LIBRARY)
    yield
    LIBRARY.clear()
    LIBRARY.update(before)


@pytest.fixture(scope="module")
def campaign():
    robot = load_robot("cogiro")
    return written(robot, plan_of(robot, 6))


@pytest.fixture(scope="module")
def seen(campaign):
    return seen_in(recorded(campaign))


@pytest.mark.parametrize("name", sorted(LIBRARY))
def test_patterns_are_ways_to_occur_of_which_one_is_true(name, seen):
    cause = LIBRARY[name]
    patterns, count = cause.patterns(seen), len(cause.basic(seen))
    assert sum(p.weight for p in patterns) == pytest.approx(1.0, rel=1e-12)
    assert len({p.label for p in patterns}) == len(patterns)
    for pattern in patterns:
        assert pattern.basis.shape == (count, len(pattern.parameters))
        assert np.linalg.matrix_rank(pattern.basis) == len(pattern.parameters)


@pytest.mark.parametrize("name", sorted(LIBRARY))
def test_a_cause_of_size_zero_is_no_change_and_a_batch_is_one_by_one(name, campaign, seen):
    cause, arrays = LIBRARY[name], RobotArrays.of(campaign.robot)
    sigma = np.array([p.prior for p in cause.basic(seen)])
    theta = np.random.default_rng(3).uniform(0.0, 1.0, (3, 1, len(sigma))) * sigma
    none, batch = cause.apply(arrays, 0.0 * theta[:1]), cause.apply(arrays, theta)
    alone = [cause.apply(arrays, one[None]) for one in theta]
    changed = {field for field in PARAMETERS if getattr(batch, field) is not getattr(arrays, field)}
    assert changed
    for field in changed:
        before, after, axes = getattr(arrays, field), getattr(batch, field), PARAMETERS[field].axes
        unchanged = getattr(none, field)
        np.testing.assert_allclose(unchanged, np.broadcast_to(before, unchanged.shape), rtol=1e-14, atol=1e-14)
        for k, one in enumerate(alone):
            mine = after[k] if after.ndim > axes else after
            other = getattr(one, field)
            np.testing.assert_allclose(mine, other[0] if other.ndim > axes else other, rtol=1e-15)


def test_a_check_beside_the_robot_narrows_a_prior_and_nothing_else(seen):
    narrow, _ = library.testable(seen, {"load_cell_bias": 0.5, "axial_stiffness": 10.0})
    for cause in narrow:
        expected = 0.5 if cause.name == "load_cell_bias" else LIBRARY[cause.name].parameters[0].prior
        assert cause.parameters[0].prior == expected, cause.name


def test_a_cause_that_data_cannot_show_is_said_with_its_reason(seen):
    found, hidden = library.testable(seen, {})
    assert {cause.name for cause in found}.isdisjoint(hidden)
    assert {cause.name for cause in found} | set(hidden) == set(LIBRARY)
    assert "frequencies" in hidden["accelerometer_mass"]
    assert all(hidden.values())


def warm(kelvin: float, seed: int):
    """A frame entered as it was when cold."""
    robot = load_robot("cogiro")
    cold = replace(robot, frame_anchors=robot.frame_anchors / (1.0 + GROWTH * kelvin))
    return noisy(written(robot, plan_of(robot, 8), cold), seed)


def test_a_cause_from_an_installed_package_is_found_and_named(monkeypatch):
    """Said once, known from then on; its size within three sigmas."""
    entry = EntryPoint("warm_frame", "tests.laws.test_hypotheses:WARM_FRAME", library.ENTRY_POINTS)
    monkeypatch.setattr(library, "entry_points", lambda group: [entry] if group == library.ENTRY_POINTS else [])
    kelvin = 80.0
    said = diagnosed(warm(kelvin, 5))
    assert said.decision.classes == (("warm_frame",),)
    size = said.candidates[0].sizes[0]
    assert abs(size.mean[0] - kelvin) < 3.0 * size.sigma[0]
    assert "warm_frame" in LIBRARY


def test_a_cause_is_registered_once_under_a_name_of_its_own():
    register(WARM_FRAME)
    register(WARM_FRAME)
    assert LIBRARY["warm_frame"] is WARM_FRAME
    with pytest.raises(ValueError, match="'platform_mass' already"):
        register(replace(WARM_FRAME, name="platform_mass"))


def test_tilts_of_two_degrees_filed_in_rad_are_corrected_though_they_look_level(campaign):
    tilts = np.radians(2.0) * np.random.default_rng(4).uniform(-1.0, 1.0, campaign.states.angles.shape)
    states = replace(campaign.states, angles=np.radians(tilts))
    assert not several_tilted(states, BEYOND_NOISE)
    found = {one.sentence: one.campaign for one in corrections(replace(campaign, states=states))}
    np.testing.assert_allclose(found["the pose angles are in rad"].states.angles, tilts)


def test_nothing_is_converted_from_rad_that_is_level(campaign):
    level = replace(campaign, states=replace(campaign.states, angles=0.0 * campaign.states.angles))
    assert not [one for one in corrections(level) if "rad" in one.sentence and "pose angles" in one.sentence]
