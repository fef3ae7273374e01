"""The robot model on trial before the FEM, and wrong models that must be found guilty."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

import cdpr_struct.dynamics.cable_dynamics as cable_dynamics
import cdpr_struct.dynamics.taut_cables as taut_cables
from cdpr_struct.crosscheck.determinant_minima import match_minima
from cdpr_struct.crosscheck.fem_robot import solve_in_fem, to_fem
from cdpr_struct.crosscheck.verification import verify
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.generated import cable_dsm
from tests.conftest import at_rest

ELEMENTS = (10, 20, 40, 80)


@pytest.fixture(scope="module")
def trial(thesis_point):
    return verify(thesis_point, ELEMENTS, 54)


def test_every_fem_frequency_below_8_hz_has_its_dsm_partner_within_one_percent(trial):
    """Largest measured deviation 0.79 %, a rotational platform mode at 6.86 Hz."""
    assert trial.objections("dsm") == []
    assert (trial.fem_limit_hertz < 8.0).sum() == 45
    assert trial.fem_limit_hertz.max() > 8.0
    assert trial.assurance.min() > 0.8
    assert len(set(trial.dsm_hertz)) == len(trial.dsm_hertz), "two FEM modes share one DSM mode"


def test_shapes_of_single_modes_are_those_of_the_fem_and_unlike_all_others(trial):
    """Rows of the MAC are FEM modes; a mode farther than 2 % from its neighbours does not mix with them."""
    hertz = trial.fem_limit_hertz
    gap = np.abs(hertz[:, None] / hertz - 1.0) + np.eye(len(hertz))
    single = gap.min(axis=1) > 0.02
    single[-1] = False  # its neighbour above is not among the modes
    assert single.sum() >= 5
    assert np.diag(trial.exact_mac)[single] == pytest.approx(1.0, abs=1e-3)
    assert (trial.exact_mac - np.diag(np.diag(trial.exact_mac)))[single].max() < 0.01
    assert trial.exact_mac.shape == trial.dsm_mac.shape == (54, 54)


def test_exact_catenary_meets_the_fem_limit_far_closer(trial):
    """The FEM's own uncertainty bounds the agreement: below 6e-5 for modes of up to three half waves."""
    below = trial.fem_limit_hertz < 8.2
    error = np.abs(trial.exact_hertz / trial.fem_limit_hertz - 1.0)[below]
    assert error.max() < 6e-5
    assert error[:18].max() < 2e-6


def test_fem_converges_with_order_two(trial):
    assert np.nanmedian(trial.observed_order) == pytest.approx(2.0, abs=0.05)


def test_scan_misses_most_of_the_clustered_frequencies(trial):
    """Sixteen cable modes lie between 2.4 and 2.8 Hz; damped, they leave two minima."""
    assert trial.missed_by_scan > 30
    assert all(0 <= missed <= 54 for missed in trial.missed.values())


def test_static_model_has_no_cable_modes(trial):
    assert np.isfinite(trial.static_hertz).sum() == 6
    assert trial.static_hertz[trial.fem_limit_hertz < 3.0].tolist() == pytest.approx([np.nan] * 16, nan_ok=True)


def test_wrong_axial_stiffness_is_found_guilty(thesis_point, monkeypatch):
    """EA + 2 % in the model: a stretch mode moves by up to 1 %, on top of the DSM's own 0.8 %."""
    true_taut = cable_dynamics.taut_cables
    monkeypatch.setattr(
        cable_dynamics,
        "taut_cables",
        lambda point: dataclasses.replace(
            taut := true_taut(point),
            axial_stiffness=1.02 * taut.axial_stiffness,
            lambda_squared=1.02 * taut.lambda_squared,
        ),
    )
    wrong = verify(thesis_point, ELEMENTS[:3], 40, judged=("dsm",))
    assert any("is off by" in text for text in wrong.objections())


@pytest.fixture(scope="module")
def sagging_point():
    """8 mm cables and a light platform: eps = 0.25, where the coupling of chord and transverse motion shows."""
    return at_rest("thesis-3-1-8mm", np.array([1.0, 0.5, 0.5]), mass=45.0)


def flipped(*arguments):
    k_xx, k_xz, k_yy, k_zz = cable_dsm.dynamic_stiffness(*arguments)
    return k_xx, -k_xz, k_yy, k_zz


def test_sign_of_k_xz_is_decided_by_the_fem(sagging_point, monkeypatch):
    """K_xz vanishes at omega = 0, so statics cannot tell; the robot's eigenfrequencies can."""
    right = verify(sagging_point, ELEMENTS[:3], 20)
    names = ("epsilon", "lambda_squared", "effective_length_integral")
    wrong_forms = SimpleNamespace(dynamic_stiffness=flipped, **{name: getattr(cable_dsm, name) for name in names})
    monkeypatch.setattr(taut_cables, "cable_dsm", wrong_forms)
    wrong = verify(sagging_point, ELEMENTS[:3], 20)
    assert np.abs(right.relative_error).max() < 0.004  # measured 0.0025
    assert np.abs(wrong.relative_error).max() > 0.04  # measured 0.063


def long_arms() -> OperatingPoint:
    """CoGiRo hung by cables whose platform anchors lie on arms three times as long."""
    from cdpr_struct.robot.robot_file import load_robot
    from cdpr_struct.statics.inverse_kinematics import inverse

    robot = load_robot("cogiro")
    robot = dataclasses.replace(robot, platform_anchors=3.0 * robot.platform_anchors)
    solution = inverse(robot, robot.home.position, robot.home.rotation)
    return OperatingPoint(robot, robot.home.position, robot.home.rotation, solution.cables)


def test_dropping_the_geometric_term_is_found_guilty_on_long_arms():
    point = long_arms()
    right = verify(point, ELEMENTS[:3], 20, "consistent")
    wrong = verify(point, ELEMENTS[:3], 20, "thesis")
    right_exact = np.abs(right.exact_hertz / right.fem_limit_hertz - 1.0).max()
    wrong_exact = np.abs(wrong.exact_hertz / wrong.fem_limit_hertz - 1.0).max()
    assert right_exact < 2e-5  # measured 4.7e-6
    assert wrong_exact > 1e-4  # measured 1.9e-4


def test_each_minimum_serves_one_frequency():
    matched = match_minima(np.array([1.0, 2.0]), np.array([1.001, 1.002, 2.5]), 0.03)
    assert matched.tolist() == pytest.approx([1.0, np.nan, np.nan], nan_ok=True)


def test_referee_is_told_the_same_robot(thesis_point):
    data = to_fem(thesis_point.robot, thesis_point.cables.length)
    assert [c.axial_stiffness for c in data.cables] == thesis_point.robot.axial_stiffness.tolist()
    assert data.platform.mass == 60.0
    assert solve_in_fem(thesis_point, 40).position == pytest.approx([0.0, 0.0, 0.5], abs=2e-5)
