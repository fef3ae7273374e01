"""Swivel angles of pulleys as readings, of the FEM's wheels: no pose was read, and encoders begin anywhere."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.fem_reference import solve_robot
from cdpr_struct.measurement.campaign import Campaign, States
from cdpr_struct.observation.rest import rest
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.tolerances import Tolerances
from cdpr_struct.statics.swivel_angle import swivel_angle, within_turn
from tests.laws.written_campaigns import NO_CABLES, NO_PEAKS, with_states

FOUR = Path(__file__).parents[1] / "blind" / "robots" / "four-cables.toml"
AXES = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
ZEROS = np.radians([25.0, -130.0, 80.0, 170.0])  # of the encoders: nobody knows them
SIGMA = {"tension": 1.0, "length": 3e-4, "swivel": np.radians(0.02)}
COUNT, BARS = 14, 80


@dataclass(frozen=True)
class Truth:
    """What rests in the FEM: positions (S, 3), angles (S, 3), tensions, lengths and swivel angles (S, 4)."""

    position: np.ndarray
    angles: np.ndarray
    tension: np.ndarray
    length: np.ndarray
    swivel: np.ndarray
    payload: np.ndarray


def on_wheels(moved: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Robot:
    """Four cables over wheels of 60 mm, two that swivel about the vertical and two about x; frame anchor 3 moved."""
    robot = load_robot(FOUR)
    anchors = np.array(robot.frame_anchors)
    anchors[2] += moved
    return replace(robot, frame_anchors=anchors, pulleys=tuple(Pulley(0.06, axis) for axis in AXES))


def turned_by_hand(outward: np.ndarray, axis: np.ndarray) -> float:
    """Angle of a wheel's middle about its axis by its coordinates: from x about the vertical, from down about x."""
    if axis[2]:
        return float(np.arctan2(outward[1], outward[0]))
    return float(np.arctan2(axis[0] * outward[1], -outward[2]))  # x cross -z is +y


@lru_cache(maxsize=4)
def truth(moved: tuple[float, float, float] = (0.0, 0.0, 0.0), bars: int = BARS) -> Truth:
    robot, draw = on_wheels(moved), np.random.default_rng(1)
    place = robot.home.position + draw.uniform(-1.0, 1.0, (COUNT, 3)) * [0.9, 0.7, 0.6]
    length = np.linalg.norm(robot.frame_anchors - place[:, None] - robot.platform_anchors, axis=-1) + 0.06
    payload = np.resize([0.0, 8.0, 16.0], COUNT)
    found = [
        solve_robot(to_fem(robot.with_load(load), own), start, np.eye(3), bars)
        for load, own, start in zip(payload, length, place - [0.0, 0.0, 0.05], strict=True)
    ]
    swivel = [[turned_by_hand(c.wrap.outward, a) for c, a in zip(f.cables, AXES, strict=True)] for f in found]
    angles = [Rotation.from_matrix(f.rotation).as_euler("xyz") for f in found]
    tension = [[np.linalg.norm(c.end_force) for c in f.cables] for f in found]
    position = np.array([f.position for f in found])
    return Truth(position, np.array(angles), np.array(tension), length, np.array(swivel), payload)


def measured(real: Truth, posed: bool = False, swivels: bool = True, noise: float = 1.0, seed: int = 5) -> Campaign:
    """What lengths, load cells and encoders on the swivels say; of poses nothing unless `posed`."""
    draw, robot = np.random.default_rng(seed), on_wheels()
    values = {"tension": real.tension, "length": real.length, "swivel": real.swivel + ZEROS}
    read = {name: value + noise * SIGMA[name] * draw.standard_normal(value.shape) for name, value in values.items()}
    shape, blank = real.tension.shape, np.full(COUNT, np.nan)
    if not swivels:
        read["swivel"] = np.full(shape, np.nan)
    states = States(
        names=tuple(f"s{k}" for k in range(COUNT)), position=np.where(posed, real.position, np.nan),
        angles=np.where(posed, real.angles, np.nan), sigma_position=np.full(COUNT, 3e-4),
        sigma_rotation=np.full(COUNT, 2e-4), payload=real.payload, tension_sigma=np.full(shape, SIGMA["tension"]),
        length_sigma=np.full(shape, SIGMA["length"]), lock=np.arange(COUNT), loaded=np.zeros(COUNT, dtype=bool),
        static=np.ones(COUNT, dtype=bool), temperature=blank, approach=np.full(shape, np.nan), time=blank,
        swivel_sigma=np.full(shape, SIGMA["swivel"]), **read,
    )  # fmt: skip
    return Campaign("fem", robot, robot.name, "exact", Tolerances(), frozenset(), states, NO_CABLES, NO_PEAKS)


def size_of(found: Diagnosis) -> tuple[np.ndarray, np.ndarray]:
    """Fitted size of the only cause and its sigmas."""
    size = found.sizes[0]
    return size.mean, np.sqrt(np.diag(size.covariance))


def test_wheels_of_the_fem_face_where_the_model_says():
    """Angles by hand from the place of the FEM's wheel. Its first bar points along its chord, not the tangent at the
    exit: over a level axis it is off by half of its own sag, which halves with its length."""
    far = []
    for bars in (40, 80):
        real = truth(bars=bars)
        data = recorded(measured(real, posed=True, noise=0.0))
        pull = rest(data.arrays, data.readings, data.known).cables.force_at_frame
        angle = swivel_angle(pull, data.arrays.pulley_axis, data.swivels.reference)
        far.append(np.degrees(np.abs(within_turn(angle - real.swivel))).max(axis=0))
    assert far[1][:2].max() < 2e-5  # deg; about the vertical sag does not turn the wheel: measured 9e-6
    assert far[1][2:].max() < 0.02  # measured 0.0196, and 0.046 with bars of twice the length
    assert (far[1][2:] < 0.6 * far[0][2:]).all()


def test_what_is_left_of_true_readings_is_nothing():
    """Zeros of 25 to 170 degrees are found from the poses, and angles that pass half a turn are none."""
    data = recorded(measured(truth(), posed=True, noise=0.0))
    own = data.swivels
    there = rest(data.arrays, data.readings, data.known).cables.force_at_frame
    missed = own.missed(swivel_angle(there, data.arrays.pulley_axis, own.reference))
    assert len(own) == 4 * COUNT
    assert np.degrees(np.abs(missed)).max() < 0.02
    assert np.degrees(np.abs(missed[own.cable < 2])).max() < 2e-5


def test_swivel_angles_tell_an_anchor_from_a_length_that_nothing_else_tells_apart():
    """A frame anchor 15 mm aside, nothing read of any pose: a class of two without swivel angles, named with them."""
    real = truth((0.0, 0.015, 0.0))
    without, with_them = (diagnosed(measured(real, swivels=own)) for own in (False, True))
    assert ("frame_anchor_position", "unstrained_length_offset") in without.decision.classes
    assert with_them.decision.status == "named"
    assert with_them.decision.classes == (("frame_anchor_position",),)
    (mean, sigma), (_, before) = size_of(with_them), size_of(without)
    assert with_them.sizes[0].part.pattern.label == "cable 3 alone"
    assert (np.abs(mean - [0.0, 0.015, 0.0]) < 2.5 * sigma).all()
    assert (sigma < 0.8 * before).all()  # measured: 1.8, 1.8, 2.4 mm against 2.6, 2.8, 3.2


@pytest.mark.slow
def test_a_robot_without_faults_stays_without_and_sigmas_are_right():
    found = diagnosed(measured(truth()))
    assert found.decision.status == "adequate"
    own = next(one for one in found.noise if one.kind == "swivel")
    assert own.readings == 4 * COUNT
    assert 0.7 < own.factor < 1.4


def test_missing_and_stray_swivel_angles():
    """Some not read, one off by 3 degrees: that one is set aside, the rest say what they say."""
    campaign = measured(truth())
    swivel = campaign.states.swivel.copy()
    swivel[::3, 1], swivel[:, 3] = np.nan, np.nan
    swivel[4, 0] += np.radians(3.0)
    found = diagnosed(with_states(campaign, swivel=swivel))
    assert found.decision.status == "adequate"
    assert [(row.kind, row.case, row.cable) for row in found.set_aside] == [("swivel", "s4", 0)]


@pytest.mark.parametrize("shift", [0.0, 2.0])
def test_where_an_encoder_begins_says_nothing(shift):
    """Evidence does not change with the zero: nats, at slightly other linearisations."""
    campaign = measured(truth())
    moved = with_states(campaign, swivel=campaign.states.swivel + shift * np.array([1.0, -1.3, 0.4, 0.0]))
    assert recorded(moved).swivels.angle == pytest.approx(recorded(campaign).swivels.angle, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("which", "said"),
    [
        (slice(None), "the sense of the swivel angles is wrong"),
        (2, "the sense of the swivel angle of cable 3 is wrong"),
    ],
)
def test_encoders_that_count_the_other_way_round_are_a_wrong_sign(which, said):
    campaign = measured(truth())
    swivel = campaign.states.swivel.copy()
    swivel[:, which] *= -1.0
    found = diagnosed(with_states(campaign, swivel=swivel))
    assert found.decision.status == "named"
    assert found.decision.classes == (("sign_error",),)
    assert found.correction is not None
    assert found.correction.sentence == said


@pytest.mark.slow
def test_exchanged_channels_of_swivel_angles():
    campaign = measured(truth())
    found = diagnosed(with_states(campaign, swivel=campaign.states.swivel[:, [1, 0, 2, 3]]))
    assert found.decision.classes == (("swapped_channels",),)
    assert found.correction is not None
    assert found.correction.sentence == "the swivel channels of cables 1 and 2 are swapped"
