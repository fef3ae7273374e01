"""Elastic catenary: any cable is solved, and the answers obey the laws of a hanging cable."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cdpr_struct.generated.catenary import end_point, sag
from cdpr_struct.statics import catenary_length
from cdpr_struct.statics.catenary import RESIDUAL_TOLERANCE, CableStatus, solve_end_forces
from cdpr_struct.statics.catenary_length import force_z_curvature, length_at_chord_tension, solve_length

POPULATION = 100_000


def population(count: int, seed: int) -> dict[str, np.ndarray]:
    """Cables of known end forces: sag/chord 1e-6..2, direction of the pull -90..90 deg, EA/wL 1e2..1e8."""
    rng = np.random.default_rng(seed)
    length, weight = 10 ** rng.uniform(-1, 3, count), 10 ** rng.uniform(-2, 3, count)
    slackness = 10 ** rng.uniform(-5.1, 1.05, count)  # w L / (2 tension)
    angle = np.radians(rng.uniform(-90, 90, count))
    pull = 0.5 * weight * length / slackness
    cable = {"length": length, "axial_stiffness": 10 ** rng.uniform(2, 8, count) * weight * length, "weight": weight}
    forces = pull * np.cos(angle), pull * np.sin(angle) + 0.5 * weight * length
    x, z = end_point(*forces, **cable)
    return {"x": x, "z": z, **cable}


def reached(cable: dict[str, np.ndarray], forces) -> np.ndarray:
    """End-point error over length."""
    x, z = end_point(forces.force_x, forces.force_z, cable["length"], cable["axial_stiffness"], cable["weight"])
    return np.hypot(x - cable["x"], z - cable["z"]) / cable["length"]


def test_a_hundred_thousand_random_cables_all_converge():
    cable = population(POPULATION, seed=0)
    forces = solve_end_forces(**cable)
    assert forces.converged.all()
    assert reached(cable, forces).max() < RESIDUAL_TOLERANCE  # measured 1e-12, EA/wL = 1e2 at a strain of 1000
    chord = np.hypot(cable["x"], cable["z"])
    ratio = sag(forces.force_x, forces.force_z, cable["length"], cable["axial_stiffness"], cable["weight"]) / chord
    inclination = np.degrees(np.arctan2(cable["z"], cable["x"]))
    assert ratio.min() < 2e-6
    assert ratio.max() > 2.0
    assert inclination.min() < -89.0
    assert inclination.max() > 89.0


def test_population_check_sees_a_wrong_stiffness():
    """Twin: forces solved with EA off by 2 % miss the end points."""
    cable = population(1000, seed=1)
    wrong = {**cable, "axial_stiffness": 1.02 * cable["axial_stiffness"]}
    assert (reached(cable, solve_end_forces(**wrong)) > RESIDUAL_TOLERANCE).mean() > 0.95


@pytest.mark.parametrize(
    ("cable", "horizontal", "frame_end", "platform_end"),
    [
        ((89.9, 59.2, 130.0, 7.51e8, 881.05), 31373.229, -26650.341, -87886.159),
        ((400.0, 200.0, 500.0, 7.51e12, 200.0), 43694.581, -22365.599, -77634.401),
    ],
)
def test_published_rows(cable, horizontal, frame_end, platform_end):
    """Rows from the literature; V there is the reaction on the cable, positive down at the upper end.

    The printed forces themselves miss their end point by 5e-6 m, hence 1e-6; ours miss it by less than 1e-12.
    """
    forces = solve_end_forces(*cable)
    assert forces.force_x == pytest.approx(horizontal, rel=1e-6)
    assert forces.force_z == pytest.approx(-platform_end, rel=1e-6)
    assert forces.force_z - cable[4] * cable[2] == pytest.approx(frame_end, rel=1e-6)
    assert forces.residual < 1e-12 * cable[2]


def test_published_rows_see_a_wrong_weight():
    """Twin: 2 % more weight is far outside the tolerance."""
    forces = solve_end_forces(89.9, 59.2, 130.0, 7.51e8, 1.02 * 881.05)
    assert forces.force_x != pytest.approx(31373.229, rel=1e-3)


ratios = st.floats(0.05, 0.999) | st.floats(1.0001, 1.05)
slopes = st.floats(-89.0, 89.0)


@settings(max_examples=80, deadline=None)
@given(chord=ratios, slope=slopes, stiffness=st.floats(2.0, 7.0), weight=st.floats(-9.0, 2.0))
def test_reversed_ends_carry_the_same_forces(chord, slope, stiffness, weight):
    """Seen from its other end, a cable has the same horizontal force; the two verticals sum to its weight."""
    x, z = 10.0 * chord * np.cos(np.radians(slope)), 10.0 * chord * np.sin(np.radians(slope))
    w = 10.0**weight
    one = solve_end_forces(x, z, 10.0, 10.0**stiffness, w)
    other = solve_end_forces(x, -z, 10.0, 10.0**stiffness, w)
    scale = np.hypot(one.force_x, one.force_z) + w * 10.0
    assert one.force_x == pytest.approx(other.force_x, abs=1e-9 * scale)
    assert one.force_z + other.force_z == pytest.approx(w * 10.0, abs=1e-9 * scale)


@settings(max_examples=60, deadline=None)
@given(slope=slopes, strain=st.floats(1e-5, 1e-2))
def test_weight_going_to_zero_gives_the_straight_spring(slope, strain):
    x, z = 10.0 * np.cos(np.radians(slope)), 10.0 * np.sin(np.radians(slope))
    length = 10.0 / (1.0 + strain)
    for weight in (1e-9, 1e-30, 0.0):
        forces = solve_end_forces(x, z, length, 1e5, weight)
        assert np.hypot(forces.force_x, forces.force_z) == pytest.approx(1e5 * strain, rel=1e-7)
        assert forces.force_z * x == pytest.approx(forces.force_x * z, abs=1e-6 * strain * 1e6)


def test_weightless_cable_longer_than_its_chord_is_slack():
    forces = solve_end_forces(3.0, 4.0, [4.9, 5.0, 5.1], 1e5, 0.0)
    assert forces.status.tolist() == [CableStatus.CONVERGED, *[CableStatus.WEIGHTLESS_SLACK] * 2]
    assert forces.force_x[1:].tolist() == [0.0, 0.0]


@pytest.mark.parametrize("z", [-8.0, -2.0, 0.0, 2.0, 8.0])
def test_a_fold_is_the_limit_of_a_narrow_cable(z):
    """Exactly vertical and longer than its chord: status FOLDED, forces continuous with x -> 0."""
    folded = solve_end_forces(0.0, z, 10.0, 1e5, 3.0)
    narrow = solve_end_forces(1e-12, z, 10.0, 1e5, 3.0)
    assert folded.status == CableStatus.FOLDED
    assert narrow.status == CableStatus.CONVERGED
    assert folded.force_x == 0.0
    assert folded.force_z == pytest.approx(narrow.force_z, abs=1e-9)
    assert folded.force_z == pytest.approx(0.5 * 30.0 + 0.5 * z * 3.0, rel=1e-3)  # each end carries its strand


def test_a_hanging_weight_stretches_a_vertical_cable():
    """Closed form: end at -(L + (P + w L / 2) L / EA) under a load P."""
    load, length, stiff, weight = 50.0, 10.0, 1e4, 2.0
    z = -(length + (load + 0.5 * weight * length) * length / stiff)
    forces = solve_end_forces(0.0, z, length, stiff, weight)
    assert forces.status == CableStatus.CONVERGED
    assert forces.force_z == pytest.approx(-load, rel=1e-10)


@settings(max_examples=80, deadline=None)
@given(
    slackness=st.floats(-5.0, 0.3),
    slope=st.floats(-89.99, 89.99) | st.sampled_from([-90.0, 90.0]),
    stiffness=st.floats(1.0, 6.0),
)
def test_length_from_tension_inverts_the_force_solver(slackness, slope, stiffness):
    """L(tau) and back; w chord / (2 tau) up to 2 would be past the tension minimum, vertical ones fold at 1."""
    x, z = (
        (0.0, np.sign(slope) * 7.0)
        if abs(slope) == 90.0
        else (7.0 * np.cos(np.radians(slope)), 7.0 * np.sin(np.radians(slope)))
    )
    weight = 0.8
    tau = 0.5 * weight * 7.0 / (0.9 if x == 0.0 and slackness > -0.05 else 10.0**slackness)
    cable = length_at_chord_tension(x, z, tau, 10.0**stiffness * tau, weight)
    assert cable.converged
    forces = solve_end_forces(x, z, cable.length, 10.0**stiffness * tau, weight)
    assert forces.force_x == pytest.approx(cable.force_x, abs=1e-7 * tau)
    assert forces.force_z == pytest.approx(cable.force_z, abs=1e-7 * tau)


@settings(max_examples=60, deadline=None)
@given(slackness=st.floats(-2.0, 0.3), slope=st.floats(-85.0, 85.0))
def test_rates_along_the_family_of_cables(slackness, slope):
    """Rates with the chord tension against central differences; the curvature is meant to be approximate."""
    x, z, weight = 7.0 * np.cos(np.radians(slope)), 7.0 * np.sin(np.radians(slope)), 0.8
    tau = 0.5 * weight * 7.0 / 10.0**slackness
    step = 1e-4 * tau
    low, here, high = (length_at_chord_tension(x, z, tau + d, 1e4 * tau, weight) for d in (-step, 0.0, step))
    slope_z = (high.force_z - low.force_z) / (2.0 * step)
    assert here.force_z_rate == pytest.approx(slope_z, abs=1e-5 * (1.0 + abs(slope_z)))
    assert here.length_rate == pytest.approx((high.length - low.length) / (2.0 * step), rel=1e-4)
    bend = (high.force_z_rate - low.force_z_rate) / (2.0 * step)
    approximate = force_z_curvature(np.array(x), np.array(z), np.array(tau), np.array(weight))
    assert approximate * tau == pytest.approx(bend * tau, abs=0.02 * (1.0 + abs(bend * tau)))


@settings(max_examples=60, deadline=None)
@given(slope=st.floats(-80.0, 80.0), tension=st.floats(1.0, 5.0))
def test_solve_length_gives_the_wanted_tension(slope, tension):
    x, z, weight = 7.0 * np.cos(np.radians(slope)), 7.0 * np.sin(np.radians(slope)), 0.8
    wanted = 0.5 * weight * 7.0 * 10.0**tension / 5.0
    cable = solve_length(x, z, wanted, 1e6, weight)
    if cable.converged:
        forces = solve_end_forces(x, z, cable.length, 1e6, weight)
        assert np.hypot(forces.force_x, forces.force_z) == pytest.approx(wanted, rel=1e-8)
    else:
        assert cable.status == CableStatus.TENSION_TOO_LOW
        assert np.hypot(cable.force_x, cable.force_z) > wanted


@pytest.mark.parametrize(("factor", "fewer"), [(1.001, True), (30.0, False), (1e-3, False)])
def test_a_near_cable_changes_the_way_and_not_the_answer(factor, fewer, monkeypatch):
    """From a cable of almost the same tension fewer steps do; one far away is no harm."""
    x, z, wanted = np.array([10.0, 10.0, 3.0]), np.array([0.0, 4.0, -6.0]), np.array([60.0, 400.0, 9.0])
    near = solve_length(x - 1e-4, z, factor * wanted, 1e5, 0.8)
    steps, jacobian = [0], catenary_length._jacobian
    monkeypatch.setattr(catenary_length, "_jacobian", lambda *args: (steps.append(1), jacobian(*args))[1])
    cold, before = solve_length(x, z, wanted, 1e5, 0.8), len(steps)
    warm = solve_length(x, z, wanted, 1e5, 0.8, near)
    np.testing.assert_allclose(warm.length, cold.length, rtol=1e-12)
    assert warm.converged.all()
    assert not fewer or len(steps) - before < 0.7 * before


def test_solve_length_says_when_the_cable_weighs_more_than_the_tension():
    """A horizontal cable pulls with at least 0.754 w span (inextensible): 0.74 w span cannot be had, 0.77 can."""
    cable = solve_length(10.0, 0.0, [0.74 * 8.0, 0.77 * 8.0], 1e9, 0.8)
    assert cable.status.tolist() == [CableStatus.TENSION_TOO_LOW, CableStatus.CONVERGED]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"x": -1.0}, "x must be finite and >= 0"),
        ({"z": np.nan}, "z must be finite"),
        ({"length": 0.0}, "length must be finite and > 0"),
        ({"weight": -0.1}, "weight must be finite and >= 0"),
        ({"axial_stiffness": np.inf}, "axial_stiffness must be finite and > 0"),
    ],
)
def test_impossible_cables_are_refused_by_name(change, message):
    cable = {"x": 1.0, "z": 0.0, "length": 1.0, "axial_stiffness": 1e3, "weight": 1.0}
    with pytest.raises(ValueError, match=message):
        solve_end_forces(**{**cable, **change})


def test_batches_broadcast():
    forces = solve_end_forces(np.ones((3, 1)), np.zeros(4), 1.01, 1e3, 1.0)
    assert forces.force_x.shape == (3, 4)
    assert forces.iterations.max() < 12
