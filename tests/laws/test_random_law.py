"""What no cause explains, as a random law: its sizes are found, kept in files, and part of every band."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.bands.compared import compared
from cdpr_struct.bands.frequency_bands import chance_above, frequency_bands
from cdpr_struct.bands.mode_rates import ModeRates
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.random_law import random_law
from cdpr_struct.errors import InputError
from cdpr_struct.hypotheses.drift import ENCODERS, drifts
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.judge import judged
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.changed_arrays import plus
from cdpr_struct.robot.remainder import Remainder
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import robot_of_text
from cdpr_struct.robot.robot_writing import robot_toml
from cdpr_struct.robot.tolerances import Spread, Tolerances, Varied, change_count, places
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.laws.written_campaigns import cogiro, extended, mast_values, measured, noisy, plan_of, rotation, written

STATES = 16


def shaken(force: float, length: float, seed: int):
    """Poses held, each under a force of its own and with encoders off by an error of its own, of these rms."""
    rng, robot = np.random.default_rng(seed), cogiro()
    campaign = written(robot, plan_of(robot, STATES))
    states, rows = campaign.states, []
    for place, angles, load in zip(states.position, states.angles, states.payload, strict=True):
        machine = extended(robot, force=force * rng.standard_normal(3)).with_load(float(load))
        held = inverse(machine, place, rotation(*angles))
        rows.append((held.tensions, held.lengths + length * rng.standard_normal(8)))
    tension, encoders = (np.array(column) for column in zip(*rows, strict=True))
    return noisy(replace(campaign, states=replace(states, tension=tension, length=encoders)), seed)


def found_law(campaign) -> Remainder:
    data = recorded(campaign)
    where = layout(data)
    return random_law(data, where, judged(data, where, Hypothesis())).remainder


def rms(parts) -> float:
    return float(np.sqrt(np.mean(np.square(parts))))


@pytest.mark.parametrize("size", [10.0, 40.0])
def test_the_size_of_random_forces_is_found(size):
    found = found_law(shaken(size, 0.0, 3))
    assert rms(found.force_N) == pytest.approx(size, rel=0.3)  # three sigmas of the rms of 48 numbers
    assert rms(found.moment_Nm) < 2.5  # cells of 2 N on arms of about a metre
    assert found.length_m < 1e-3


def test_the_size_of_random_lengths_is_found():
    found = found_law(shaken(0.0, 4e-3, 4))
    assert found.length_m == pytest.approx(4e-3, rel=0.3)
    assert rms(found.force_N) < 5.0


def test_forces_in_one_direction_and_lengths_that_are_off_alike_are_told_apart():
    rng, robot, campaign = np.random.default_rng(7), cogiro(), shaken(0.0, 0.0, 6)
    states = campaign.states
    pulls = [
        inverse(extended(robot, force=[0.0, 0.0, f]).with_load(float(w)), p, rotation(*a))
        for f, w, p, a in zip(
            30.0 * rng.standard_normal(STATES), states.payload, states.position, states.angles, strict=True
        )
    ]
    tension, length = np.array([p.tensions for p in pulls]), np.array([p.lengths for p in pulls])
    longer = length + 0.004 * rng.standard_normal((STATES, 1))
    found = found_law(noisy(replace(campaign, states=replace(states, tension=tension, length=longer)), 8))
    assert found.force_N[2] == pytest.approx(30.0, rel=0.45)  # of 16 numbers
    assert max(found.force_N[:2]) < 5.0
    assert found.common_length_m == pytest.approx(0.004, rel=0.45)
    assert found.length_m < 1e-3


def test_lengths_that_drift_count_for_the_robot():
    campaign = shaken(0.0, 0.0, 9)
    states = campaign.states
    data = recorded(
        replace(campaign, states=replace(states, length=states.length + np.linspace(0.0, 0.006, STATES)[:, None]))
    )
    where, drift = layout(data), next(one for one in drifts(data) if one.sensor == ENCODERS)
    drifting = judged(data, where, Hypothesis(drift=drift))
    assert drifting.score > judged(data, where, Hypothesis()).score
    found = random_law(data, where, drifting).remainder.common_length_m
    assert 0.0015 < found < 0.0036  # 6 mm over the root of 12 about their mean, of the root of 3 about nothing


def test_nothing_is_left_where_nothing_is_wrong():
    found = found_law(shaken(0.0, 0.0, 5))
    assert rms(found.force_N) < 3.0
    assert found.length_m < 5e-4


@cache
def unknown():
    return diagnosed(shaken(40.0, 0.0, 3))


def test_after_unknown_the_robot_has_what_is_left(tmp_path):
    said = unknown()
    assert said.decision.status == "unknown"
    assert rms(said.extended.remainder.force_N) == pytest.approx(40.0, rel=0.3)
    assert said.extended.extensions.causes == ()
    again = robot_of_text(robot_toml(said.extended, "again"), "robot.toml")
    assert again.remainder.force_N == pytest.approx(said.extended.remainder.force_N, rel=1e-5)
    assert again.posterior.root.shape == said.extended.posterior.root.shape


def test_bands_hold_forces_that_are_new_at_every_rest():
    """Without knowledge of the law: positions and tensions of robots pushed by forces of its rms."""
    robot = replace(
        cogiro(), posterior=Spread(*(0.0 * part for part in within())), remainder=Remainder(force_N=(40.0,) * 3)
    )
    held = cs.inverse(cogiro())
    bands = cs.forward(robot, held.answer["lengths_m"], band=90).answer["bands"]
    pushed = plus(RobotArrays.of(cogiro()), force=40.0 * np.random.default_rng(1).standard_normal((200, 3)))
    rests = forward(pushed, np.array(held.answer["lengths_m"]), held.pose.position, np.eye(3))
    for name, found in (("tensions_N", rests.tensions), ("pose", np.hstack([rests.position, np.zeros((200, 3))]))):
        low, high = np.array(bands[name]).T
        inside = (low < found) & (found < high)
        assert inside[:, :3].mean(axis=0) == pytest.approx([0.9] * 3, abs=0.07)


def within() -> tuple[np.ndarray, np.ndarray]:
    spread = Spread.within(Tolerances(), 8)
    return spread.root, spread.mean


def test_a_random_law_adds_its_variance_to_that_of_tolerances():
    spread = Spread.within(Tolerances(), 8)
    whole = Remainder(force_N=(3.0,) * 3, length_m=0.002, common_length_m=0.001, frequency=0.01).beside(spread, 8)
    rates = np.eye(change_count(8, whole.varied))
    kinds = dict(zip((one.field for one in whole.varied), places(8, whole.varied), strict=True))
    sigma = whole.sigma(rates)
    assert sigma[kinds["force"]] == pytest.approx(3.0)
    assert sigma[kinds["moment"]] == pytest.approx(0.0)
    assert sigma[kinds["length_offset"]] == pytest.approx(np.linalg.norm([0.002, 0.001, Tolerances().length_m]))
    assert sigma[kinds["frame_anchors"]] == pytest.approx(Tolerances().anchor_m)
    assert whole.scatter == 0.01


def test_a_force_that_a_diagnosis_found_keeps_its_place_beside_random_ones():
    force = Varied.found("force")
    spread = Spread(np.eye(change_count(8) + 3), np.zeros(change_count(8) + 3), (force,))
    whole = Remainder(force_N=(3.0,) * 3).beside(spread, 8)
    assert [one.field for one in whole.found] == ["force", "moment"]
    sigma = whole.sigma(np.eye(change_count(8, whole.varied)))
    assert sigma[change_count(8) :] == pytest.approx([np.sqrt(10.0)] * 3 + [0.0] * 3)


def test_frequencies_scatter_each_by_itself():
    rates = ModeRates(np.array([2.0, 2.001]), np.zeros((1, 2)), np.array([[0, 1]]), np.zeros((1, 1)), np.zeros(2, int))
    none = Spread(np.zeros((1, 1)), np.zeros(1))
    assert frequency_bands(rates, none, 0.9).sigma == pytest.approx([0.0, 0.0], abs=1e-12)
    bands = frequency_bands(rates, replace(none, scatter=0.01), 0.9)
    assert bands.sigma == pytest.approx([0.00826, 0.00826], rel=0.05)  # of the smaller of two alike: sqrt(1 - 1 / pi)
    assert chance_above(rates, replace(none, scatter=0.01), 0, 2.0) == pytest.approx(0.25, abs=0.03)


def test_readings_are_compared_with_what_scatters():
    one, spread = np.ones(1), Spread(np.zeros((1, 1)), np.zeros(1))
    ends = np.array([[0.9, 1.1]])
    near = compared(1.1 * one, 0.01 * one, one, ends, np.zeros((1, 1)), spread, 0.9)
    free = compared(1.1 * one, 0.01 * one, one, ends, np.zeros((1, 1)), spread, 0.9, 0.06 * one)
    assert near.p_value < 1e-6 < 0.05 < free.p_value


@cache
def masts():
    robot = extended(cogiro(), frame_compliance=mast_values(cogiro(), np.full(4, 2e-5)))
    return diagnosed(measured(robot, 1))


@pytest.mark.slow
def test_the_size_of_masts_is_in_the_posterior_as_sure_as_the_diagnosis_says():
    said = masts()
    assert {"frame_compliance"} <= set(said.extended.extensions.causes)
    posterior = said.extended.posterior
    assert [one.field for one in posterior.found] == ["frame_compliance"]
    kinds = dict(zip((one.field for one in posterior.varied), places(8, posterior.varied), strict=True))
    own = np.linalg.norm(posterior.root[kinds["frame_compliance"]], axis=1)
    (size,) = said.sizes
    assert own.max() == pytest.approx(size.sigma.max(), rel=0.02)


def test_bands_hold_the_size_of_masts_as_drawn_robots_do():
    robot = masts().extended
    known = robot.posterior
    kinds = dict(zip((one.field for one in known.varied), places(8, known.varied), strict=True))
    sure = known.root.copy()
    sure[kinds["frame_compliance"]] = 0.0
    wide, narrow = (
        cs.modes(replace(robot, posterior=replace(known, root=root)), count=3, band=90, samples=200).answer["bands"]
        for root in (known.root, sure)
    )
    width = [np.ptp(one["frequencies_hz"], axis=1) for one in (wide, narrow)]
    assert np.abs(width[0] / width[1] - 1.0).max() > 0.02
    assert np.ptp(wide["samples"]["frequencies_hz"], axis=1) == pytest.approx(width[0], rel=0.2)
    assert not wide["samples"]["differ"]


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("[remainder]\nforce_N = [-1.0, 0.0, 0.0]\n", "remainder.force_N"),
        ("[remainder]\nforce = 1.0\n", "remainder.force"),
        ('[posterior]\nfound = ["mass"]\nmean = []\nroot = []\n', "posterior.found"),
        ('[posterior]\nfound = ["force", "force"]\nmean = []\nroot = []\n', "posterior.found"),
    ],
)
def test_a_law_that_no_robot_can_have_is_refused(table, said):
    with pytest.raises(InputError, match=said):
        robot_of_text(f"{robot_toml(cogiro(), 'again')}\n{table}", "robot.toml")


def test_no_size_is_negative():
    with pytest.raises(ValueError, match=r"Remainder\.length_m must be zero or more"):
        Remainder(length_m=-1.0)
    with pytest.raises(ValueError, match=r"Remainder\.force_N must be three numbers"):
        Remainder(force_N=1.0)


@pytest.mark.parametrize("quantity", ["tension-min", "first-frequency", "pose-error"])
def test_maps_hold_what_is_left(quantity):
    """Far more than tolerances do; drawn robots say how much."""
    widths = []
    for left in (None, Remainder(force_N=(100.0,) * 3, length_m=2e-3, frequency=0.05)):
        robot = replace(cogiro(), remainder=left)
        found = cs.map(robot, "0,0,1.2", quantity, band=90, samples=60 if left else None)
        columns = found.columns()
        widths.append(column(columns, "high") - column(columns, "low"))
    assert widths[1] > 1.5 * widths[0]
    drawn = column(columns, "drawn_high") - column(columns, "drawn_low")
    assert widths[1] == pytest.approx(drawn, rel=0.35)


def column(columns, ending: str) -> float:
    return next(float(values[0]) for name, values in columns.items() if name.rstrip("_NHzm").endswith(f"_{ending}"))


def test_other_commands_take_a_robot_with_what_is_left():
    robot = replace(masts().extended, remainder=Remainder((5.0,) * 3, (1.0,) * 3, 2e-4, 1e-4, 0.002))
    assert cs.pose_error(robot, pose=robot.home, band=90).answer["bands"]
    assert cs.sensitivity(robot, count=2).answer["shares"]
    assert cs.accept(robot, "examples/bands/requirements.toml").answer
