"""Extensions of a robot in vibration: series formulas, counts, and small effects against their closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.cable_poles import UPPER
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.damping import Viscous
from cdpr_struct.dynamics.fundamental_frequency import fundamental_frequency
from cdpr_struct.dynamics.natural_frequencies import natural_frequencies, static_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.stiff_cable import bending_factor, load_factor, slenderness
from cdpr_struct.dynamics.swept_stiffness import dynamic_stiffness, swept_dynamic_stiffness
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse


def at_rest(given: dict) -> OperatingPoint:
    robot = load_robot("thesis-3-1")
    robot = replace(robot, extensions=Extensions.of(8, given))
    place = robot.home.position + np.array([0.5, -0.4, 0.2])
    return OperatingPoint(robot, place, np.eye(3), inverse(robot, place, np.eye(3)).cables)


SOFT = [
    {"series_compliance": 5e-5},
    {"frame_compliance": 5e-5},
    {"frame_compliance": [0.0, 5e-5, 2e-5, 0.0, 0.0, 5e-5, 2e-5, 0.0]},
    {"series_compliance": 2e-5, "frame_compliance": 2e-5},
    {"mast_bending": 5e-5, "mast_foot": -1.0},
    {"frame_compliance": 2e-5, "mast_bending": [0.0, 5e-5, 2e-5, 0.0, 0.0, 5e-5, 2e-5, 0.0]},
    {"frame_compliance": 5e-5, "mast_mass": 8.0},
    {"mast_bending": 5e-5, "mast_foot": -1.0, "mast_mass": [0.0, 5.0, 0.0, 2.0, 8.0, 5.0, 0.0, 2.0]},
    {"hose": 500.0},
]


@pytest.mark.parametrize("model", ["dsm", "exact"])
@pytest.mark.parametrize("given", SOFT, ids="+".join)
def test_eigenproblem_and_count_agree(given, model):
    """The count knows the platform's stiffness and the clamped cables only; the eigenproblem has masts as unknowns."""
    point = at_rest(given)
    found = certified_modes(point, model, 10)
    assert found.frequencies.certified
    counted = natural_frequencies(point, found.cables, 10).hertz
    np.testing.assert_allclose(found.shapes.omega / (2.0 * np.pi), counted, rtol=1e-5)  # dsm: a truncated series


@pytest.mark.parametrize("given", [given for given in SOFT if "mast_mass" not in given], ids="+".join)
def test_massless_cables_give_the_static_frequencies(given):
    point = at_rest(given)
    found = certified_modes(point, "static", 6).frequencies.hertz
    np.testing.assert_allclose(found, np.sort(static_frequencies(point)), rtol=1e-12)
    assert abs(found[0] / static_frequencies(at_rest({}))[0] - 1.0) > 0.02  # the extension is felt


@pytest.mark.parametrize("hertz", [0.0, 1.0, 2.0, 3.3])
def test_closed_form_with_an_element_in_line_is_the_series_of_both(hertz):
    """K (1 + C K)^-1 with C along the chord, at any frequency: this cable has no inertia along its chord."""
    give, omega = 5e-5, np.array([(2.0 * np.pi * hertz) ** 2])
    point = at_rest({"series_compliance": give})
    bare = replace(point, robot=point.robot.without_extensions())
    rigid, soft = (cable_dynamics(p, "dsm").stiffness(omega) for p in (bare, point))
    chord = point.cables.offset / point.cables.chord[:, None]
    compliance = give * chord[:, :, None] * chord[:, None, :]
    series = rigid @ np.linalg.inv(np.eye(3) + compliance @ rigid)
    np.testing.assert_allclose(soft, series, atol=1e-9 * np.abs(series).max())
    assert np.abs(rigid - series).max() > 0.1 * np.abs(series).max()


def test_static_limit_of_the_exact_cable_is_the_series_of_both():
    give = 5e-5
    point = at_rest({"series_compliance": give})
    cables = point.cables
    bare = replace(point, robot=point.robot.without_extensions())
    rigid, soft = (cable_dynamics(p, "exact").stiffness(np.array([1e-8])) for p in (bare, point))
    pull = cables.tension_at_frame
    along = cables.force_at_frame / pull[:, None]
    stretch = (1.0 + pull / cables.axial_stiffness)[:, None, None]
    series = rigid @ np.linalg.inv(np.eye(3) + give / stretch * along[:, :, None] * along[:, None, :] @ rigid)
    # what passes the frame end weighs: w c next to 1, here 3e-5
    np.testing.assert_allclose(soft, series, atol=5e-5 * np.abs(series).max())


def test_sweep_over_masts_is_the_full_evaluation():
    point = at_rest({"frame_compliance": 5e-5})
    omega = 2.0 * np.pi * np.linspace(1.0, 5.0, 40)
    cables, law = cable_dynamics(point, "exact", omega[-1]), Viscous(np.full(8, 0.01))
    swept = swept_dynamic_stiffness(point, cables, law, omega)
    full = dynamic_stiffness(point, cables, law, omega)
    np.testing.assert_array_equal(swept[:, *UPPER], full[:, *UPPER])
    np.testing.assert_array_equal(swept, np.swapaxes(swept, 1, 2))
    rigid = dynamic_stiffness(replace(point, robot=point.robot.without_extensions()), cables, law, omega)
    assert np.abs(swept - rigid).max() > 0.1 * np.abs(rigid).max()


@pytest.mark.parametrize("mode", [1, 2, 3, 4])
def test_bending_stiffness_raises_frequencies_as_of_a_clamped_stiff_string(mode):
    stiff = 0.5
    slender = slenderness(np.full(8, stiff), at_rest({}).cables.tension, at_rest({}).cables.chord)
    frequencies = [_out_of_plane(at_rest(given), mode) for given in ({}, {"bending_stiffness": stiff})]
    gain = frequencies[1] / frequencies[0]
    third_order = slender**3 * (mode * np.pi) ** 2  # the formula ends with the second order; measured: 1.0 of this
    assert (np.abs(gain - bending_factor(slender, mode)) < 1.5 * third_order).all()
    assert gain.min() > 1.005


@pytest.mark.parametrize("mode", [1, 2, 3, 4])
def test_pinned_ends_leave_the_stiffness_of_the_half_waves_alone(mode):
    """f = n f0 sqrt(1 + (n pi)^2 EI / (tau l^2)), exact for a string of constant tension (Fletcher and Rossing)."""
    stiff, cables = 0.5, at_rest({}).cables
    slender = slenderness(np.full(8, stiff), cables.tension, cables.chord)
    pinned = {"bending_stiffness": stiff, "bending_fixity": 0.0}
    gain = _out_of_plane(at_rest(pinned), mode) / _out_of_plane(at_rest({}), mode)
    exact = np.sqrt(1.0 + (mode * np.pi * slender) ** 2)
    assert (np.abs(gain - exact) < 4e-3 * (exact - 1.0)).all()  # cables stretch by 0.1 %, tensions vary along them
    between = _out_of_plane(at_rest({**pinned, "bending_fixity": 0.4}), mode) / _out_of_plane(at_rest({}), mode)
    assert (np.abs(between - bending_factor(slender, mode, 0.4)) < 1.5 * slender**3 * (mode * np.pi) ** 2).all()


@pytest.mark.parametrize(("mode", "place"), [(1, 0.25), (2, 0.25), (3, 1.0 / 3.0), (4, 0.9)])
def test_a_mass_anywhere_lowers_the_modes_that_move_there(mode, place):
    mass, point = 1e-4, at_rest({"added_mass": 1e-4, "added_mass_place": place})
    cable_mass = point.robot.linear_density * point.cables.length
    ratio = _out_of_plane(point, mode) / _out_of_plane(at_rest({}), mode)
    wanted = 1.0 / np.sqrt(load_factor(mass, cable_mass, mode, place))
    np.testing.assert_allclose(ratio, wanted, rtol=7e-7)  # tensions vary along the cable, and so do half waves
    assert (ratio < 1.0 - 1e-5).all() == (mode != 3)  # a third from the end is a node of the third mode


@pytest.mark.parametrize("mode", [1, 2, 3])
def test_mass_at_mid_cable_lowers_odd_modes(mode):
    """Against the first-order formula; a small mass, so that its square hardly matters."""
    mass, point = 1e-4, at_rest({"added_mass": 1e-4})
    cable_mass = point.robot.linear_density * point.cables.length
    ratio = _out_of_plane(point, mode) / _out_of_plane(at_rest({}), mode)
    np.testing.assert_allclose(ratio, 1.0 / np.sqrt(load_factor(mass, cable_mass, mode)), rtol=2e-7)
    assert (ratio < 1.0 - 1e-5).all() == (mode % 2 == 1)


def test_fundamental_frequency_knows_both():
    given = {"bending_stiffness": 0.5, "added_mass": 0.005}
    point = at_rest(given)
    quick = fundamental_frequency(point.cables, point.robot.linear_density, point.robot.extensions)
    exact = cable_dynamics(point, "exact").first_frequency
    np.testing.assert_allclose(quick, exact, rtol=1e-4)  # a mass of 1 % of the cable, squared
    bare = fundamental_frequency(point.cables, point.robot.linear_density)
    assert np.abs(bare / exact - 1.0).min() > 1e-3


def _out_of_plane(point: OperatingPoint, mode: int) -> np.ndarray:
    """(m,) frequency of each cable's mode across its plane [rad/s]."""
    full = cable_dynamics(point, "exact", 200.0).expansion(200.0)
    across = np.abs(full.coupling[..., 1]) > 0.5 * np.linalg.norm(full.coupling, axis=-1)
    return np.array([np.sqrt(w[own])[mode - 1] for w, own in zip(full.omega_squared, across, strict=True)])


@pytest.mark.parametrize("model", ["dsm", "exact"])
def test_moving_masts_have_as_many_modes_as_the_highest_frequency_asks_for(model):
    """A low frequency in the same call takes nothing away; few modes are far off at 900 rad/s."""
    cables = cable_dynamics(at_rest({"frame_compliance": 1e-5}), model, 1000.0)
    squared = np.array([[1.0], [900.0]]) ** 2
    for both, alone in zip(cables.mast_stiffness(squared), cables.mast_stiffness(squared[1:]), strict=True):
        np.testing.assert_allclose(both[1], alone[0], rtol=1e-9, atol=1e-9 * np.abs(alone).max())
