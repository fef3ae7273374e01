"""What statics takes and refuses, at the limits of every number."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.errors import UnholdablePoseError
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.catenary import solve_end_forces
from cdpr_struct.statics.catenary_length import length_at_chord_tension, solve_length
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.free_orientation import left_free
from cdpr_struct.statics.holding_tensions import allowed_unbalance
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.sufficient_load import sufficient_load
from cdpr_struct.statics.tension_cost import Centre, EuclideanNorm, Middle, PowerNorm
from cdpr_struct.statics.trajectory import Trajectory, straight_line, through_samples

CABLE = {"x": 3.0, "z": -1.0, "length": 3.3, "axial_stiffness": 1e5, "weight": 0.7}
ROBOT = load_robot("thesis-3-1")
HOME = ROBOT.home
LINE = np.arange(3.0)[:, None] * np.ones(3)


@pytest.mark.parametrize("name", CABLE)
def test_a_cable_is_given_by_finite_numbers_of_the_right_sign(name):
    for wrong in (np.nan, np.inf, *([] if name == "z" else [-1e-9])):
        with pytest.raises(ValueError, match=rf"{name} must be finite.* \(1 such values\)"):
            solve_end_forces(**(CABLE | {name: np.array([CABLE[name], wrong])}))
    if name in ("x", "z", "weight"):
        assert np.isfinite(solve_end_forces(**(CABLE | {name: 0.0})).force_x)
    else:
        with pytest.raises(ValueError, match=f"{name} must be finite and > 0"):
            solve_end_forces(**(CABLE | {name: 0.0}))


def bounds(low, high):
    return inverse(ROBOT, HOME.position, HOME.rotation, lower_bound=low, upper_bound=high)


def moving(**changes):
    still = np.zeros((2, 3))
    turn = np.broadcast_to(np.eye(3), (2, 3, 3))
    given = {"time": np.arange(2.0), "position": still, "velocity": still, "acceleration": still, "rotation": turn}
    return Trajectory(**(given | {"angular_velocity": still, "angular_acceleration": still} | changes))


REFUSED = {
    "model must be one of sagging, spring": lambda: cable_model("rope"),
    r"chord_tension must be > 0, got np.float64\(0.0\)": lambda: length_at_chord_tension(
        3.0, 0.0, [5.0, 0.0], 1e5, 0.7
    ),
    "tension_at_platform must be > 0": lambda: solve_length(3.0, 0.0, [5.0, 0.0], 1e5, 0.7),
    "chord must be > 0": lambda: solve_length([1.0, 0.0], [0.0, 0.0], 5.0, 1e5, 0.7),
    r"lengths must be \(\.\.\., 8\)": lambda: forward(ROBOT, np.full(7, 9.0)),
    "and > 0": lambda: forward(ROBOT, np.append(np.full(7, 9.0), 0.0)),
    "1 cable cannot place this platform; at least 2 are needed": lambda: left_free(
        [True, False, False], 1, (1, 0, 0, 0, 0, 0)
    ),
    "lower_bound must be finite": lambda: bounds(-1.0, 100.0),
    "lower_bound must be finite and": lambda: bounds(np.inf, np.inf),
    r"lower_bound must have one entry per cable \(8\), got shape \(7,\)": lambda: bounds(np.ones(7), 100.0),
    r"upper_bound must have one entry per cable \(8\)": lambda: bounds(1.0, np.full(9, 100.0)),
    "upper_bound must be above lower_bound": lambda: bounds(5.0, np.append(np.full(7, 100.0), 5.0)),
    "tolerance and masses must be positive": lambda: sufficient_load(ROBOT, HOME.position, HOME.rotation, 0.0),
    "got 0.01 m, 0.0": lambda: sufficient_load(ROBOT, HOME.position, HOME.rotation, 0.01, 0.0),
    "got 0.01 m, 9.0..9.0 kg": lambda: sufficient_load(ROBOT, HOME.position, HOME.rotation, 0.01, 9.0, 9.0),
    "weights must be positive": lambda: EuclideanNorm(np.array([1.0, 0.0])),
    "weights must be positive, got": lambda: EuclideanNorm(np.array([1.0, np.inf])),
    "power must be from 1.1 to 6, got 1.09": lambda: PowerNorm(1.09),
    "power must be from 1.1 to 6, got 6.01": lambda: PowerNorm(6.01),
    "Trajectory.velocity must be finite": lambda: moving(velocity=np.array([[0.0, 0.0, 0.0], [0.0, np.nan, 0.0]])),
    "Trajectory.time must ascend": lambda: moving(time=np.zeros(2)),
    "duration must be > 0 s with at least 2 instants, got 0.0": lambda: straight_line(HOME, HOME, 0.0),
    "2 instants, got 1.0 s and 1": lambda: straight_line(HOME, HOME, 1.0, 1),
    "time, position and angles must be finite": lambda: through_samples([0.0, 1.0, np.inf], LINE),
    "position and angles must be finite": lambda: through_samples([0.0, 1.0, 2.0], np.where(LINE > 1.0, np.nan, LINE)),
    "and angles must be finite": lambda: through_samples([0.0, 1.0, 2.0], LINE, np.where(LINE > 1.0, np.nan, LINE)),
    "time must ascend": lambda: through_samples([0.0, 1.0, 1.0], LINE),
}


@pytest.mark.parametrize(("message", "make"), REFUSED.items(), ids=REFUSED)
def test_what_does_not_fit_is_refused(message, make):
    with pytest.raises(ValueError, match=message):
        make()


def test_what_just_fits_is_taken():
    assert bounds(0.0, 5000.0).held.all()
    assert [PowerNorm(power).power for power in (1.1, 6.0)] == [1.1, 6.0]
    assert len(straight_line(HOME, HOME, 1e-3, 2)) == 2
    assert left_free([False] * 3, 3).tolist() == [True, True, True]
    assert left_free([False, True, False], 4).tolist() == [True, True, False]
    assert left_free([False] * 3, 3, (0, 0, 0, 1, 0, 0)).tolist() == [False, True, True]


@pytest.mark.parametrize(
    "cost", [EuclideanNorm(), EuclideanNorm(np.array([1.0, 4.0, 0.5])), PowerNorm(3.0), Middle(), Centre()]
)
def test_slopes_and_curvatures_of_a_cost_are_its_derivatives(cost):
    """Central differences of step 1e-3 N of terms whose third derivatives are below 1: off by 1e-6 at most."""
    tension, low, high = np.array([[30.0, 45.0, 70.0]]), np.full((1, 3), 10.0), np.full((1, 3), 100.0)
    unit, step = np.full((1, 1), 20.0), 1e-3

    def terms(shift):
        return cost.terms(tension + shift, low, high, unit)

    above, middle, below = terms(step), terms(0.0), terms(-step)
    scale = max(np.abs(middle[1]).max(), 1.0)
    np.testing.assert_allclose((above[0] - below[0]) / (2 * step), middle[1], atol=1e-5 * scale)
    np.testing.assert_allclose((above[1] - below[1]) / (2 * step), middle[2], atol=1e-5 * scale)


def test_totals_of_costs_by_hand():
    tension, low, high = np.array([[3.0, 4.0]]), np.array([[1.0, 1.0]]), np.array([[7.0, 6.0]])
    assert EuclideanNorm().total(tension, low, high) == pytest.approx(5.0)
    assert EuclideanNorm(np.array([4.0, 1.0])).total(tension, low, high) == pytest.approx(np.sqrt(52.0))
    assert PowerNorm(3.0).total(tension, low, high) == pytest.approx(91.0 ** (1 / 3))
    assert Middle().total(tension, low, high) == pytest.approx(np.hypot(1.0, 0.5))
    assert Centre().total(tension, low, high) == pytest.approx((2.0 * 3.0 * 4.0 * 2.0) ** -0.25)
    assert [cost.name for cost in (EuclideanNorm(), EuclideanNorm(np.ones(1)))] == ["norm", "weighted-norm"]


def test_a_cable_behind_its_wheel_is_refused():
    """Its exit is taken from the pull alone, which cannot tell 170 degrees to one side from 190 to the other."""
    robot = replace(ROBOT, pulleys=(Pulley(0.1),) * len(ROBOT.cables))
    under = ROBOT.frame_anchors[0] - ROBOT.platform_anchors[0] - [0.0, 0.0, 1.0]
    for aside in (0.0, 1e-6, 0.19):
        for model in ("sagging", "spring"):
            with pytest.raises(UnholdablePoseError, match=r"cable 1 would turn by more than 180° .*0\.2 m"):
                inverse(robot, under + aside * np.eye(3)[0], np.eye(3), model)
    hanging = cs.load_robot("cogiro")
    wheels = replace(hanging, pulleys=(Pulley(0.1),) * len(hanging.cables))
    below = hanging.frame_anchors[0] - hanging.platform_anchors[0] - [0.0, 0.0, 1.0]
    with pytest.raises(UnholdablePoseError, match="cable 1 would turn by more than 180°"):
        cs.inverse(wheels, cs.Pose(below, np.zeros(3)), free="rx,ry,rz")


def test_tensions_beyond_all_measure_balance_nothing():
    """A share of the tensions alone would allow an unbalance of the platform's whole weight."""
    arrays = RobotArrays.of(ROBOT)
    weight = float(arrays.mass * arrays.gravity)
    assert allowed_unbalance(arrays, 1e-8, np.array(2.0 * weight)) == pytest.approx(2e-8 * weight)
    assert allowed_unbalance(arrays, 1e-8, np.array(1e12 * weight)) == pytest.approx(1e-3 * weight)
    weightless = RobotArrays.of(replace(ROBOT, gravity=0.0))
    assert allowed_unbalance(weightless, 1e-8, np.array(1e12)) == pytest.approx(1e4)
