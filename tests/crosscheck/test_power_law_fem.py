"""Cables that stiffen as a power of their tension against the referee, which adds up increments of linear bars."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import to_fem
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.static_stiffness import static_stiffness

EXPONENT, REFERENCE = 0.3, 150.0  # -, N
PAYLOAD, STEPS, MODES = 30.0, (20, 40), 12  # kg on 52.5
ELEMENTS = (20, 40)


def robot(exponent: float = EXPONENT, ratio: float | None = None):
    ratio = 1.0 / (1.0 - exponent) if ratio is None else ratio
    given = {"stiffening_exponent": exponent, "incremental_ratio": ratio, "reference_tension": REFERENCE}
    return replace(load_robot("thesis-3-1"), extensions=Extensions.of(8, given))


def held(entered) -> OperatingPoint:
    place = entered.home.position + np.array([0.5, -0.4, 0.2])
    return OperatingPoint(entered, place, np.eye(3), inverse(entered, place, np.eye(3)).cables)


@cache
def pulled() -> tuple[np.ndarray, np.ndarray]:
    """Tensions of one cable as it is strained, and the slopes dT / d(strain) between, by differences [N]."""
    stiff = load_robot("thesis-3-1").axial_stiffness[0]  # alike for all cables
    strain = np.geomspace(1e-12, 1e-2, 200001)
    tension = REFERENCE * (strain * stiff / REFERENCE) ** (1.0 / (1.0 - EXPONENT))
    return tension, np.gradient(tension, strain)


def tangent(tension: np.ndarray) -> np.ndarray:
    """dT / d(strain) [N]."""
    return np.interp(tension, *pulled())


def linear(paid_out, stretched, tension):
    """Unstrained lengths and EA of linear cables that are as long at these tensions, and gain tension as fast."""
    stiff = tangent(tension)
    lengths = stretched - paid_out * tension / stiff
    return lengths, stiff * lengths / paid_out


def pulls(rest) -> np.ndarray:
    return np.array([np.linalg.norm(cable.end_force) for cable in rest.cables])


def at_rest(point: OperatingPoint, elements: int):
    """The referee at the lengths paid out: strains of the law integrated from no tension on in small steps."""
    tension, paid_out = point.cables.tension_at_platform, point.cables.paid_out
    share = np.geomspace(1e-8, 1.0, 20001)[:, None]
    secant = tension / np.trapezoid(1.0 / tangent(share * tension), share * tension, axis=0)
    mean, stiff = (
        point.cables.tension,
        tangent(tension),
    )  # one EA a cable, that at the platform; the mean pull stretches
    lengths = paid_out * (1.0 + mean / secant - mean / stiff)
    stiff = stiff * lengths / paid_out
    density = point.entered.linear_density * paid_out / lengths
    data = to_fem(point.entered, lengths, stiff, density)
    return fem.solve_robot(data, point.position, point.rotation, elements)


@pytest.fixture(scope="module")
def point() -> OperatingPoint:
    return held(robot())


def test_what_is_paid_out_is_what_the_winches_say(point):
    np.testing.assert_allclose(point.cables.paid_out, inverse(robot(), point.position, np.eye(3)).lengths, rtol=1e-12)


def test_the_referee_rests_and_vibrates_alike(point):
    meshes = [at_rest(point, n) for n in ELEMENTS]
    assert np.abs(meshes[1].position - point.position).max() < 2e-6  # m, measured 3e-7: the mesh
    hertz = [fem.robot_modes(mesh, MODES).frequencies_hz for mesh in meshes]
    exact = certified_modes(point, "exact", MODES).frequencies.hertz
    limit = hertz[1] + (hertz[1] - hertz[0]) / 3.0
    np.testing.assert_allclose(exact, limit, rtol=1e-5)  # measured 1.3e-6
    secant = certified_modes(held(robot(ratio=1.0)), "exact", MODES).frequencies.hertz
    assert np.abs(secant / limit - 1.0).max() > 5e-3  # twin: the secant in small motion


def test_a_payload_sinks_as_the_sum_of_small_increments(point):
    """The referee is loaded in steps, each with the EA that cables have at its beginning: a first-order method."""
    found = []
    for steps in STEPS:
        rest = at_rest(point, ELEMENTS[0])
        paid_out = point.cables.paid_out
        for payload in PAYLOAD * np.arange(1, steps + 1) / steps:
            tension = pulls(rest)
            old = rest.robot.cables
            stretched = np.array(
                [c.unstrained_length * (1.0 + t / c.axial_stiffness) for c, t in zip(old, tension, strict=True)]
            )
            lengths, stiff = linear(paid_out, stretched, tension)
            density = point.entered.linear_density * paid_out / lengths
            data = to_fem(point.entered.with_load(payload), lengths, stiff, density)
            rest = fem.solve_robot(data, rest.position, rest.rotation, ELEMENTS[0])
        found.append(rest.position)
    sunk = 2.0 * found[1] - found[0] - at_rest(point, ELEMENTS[0]).position
    expected = moved(robot()) - point.position
    assert np.abs(expected).max() > 1e-3
    np.testing.assert_allclose(sunk, expected, atol=5e-3 * np.abs(expected).max())
    linear_cables = moved(robot(0.0)) - point.position
    assert np.abs(sunk - linear_cables).max() > 0.1 * np.abs(expected).max()  # twin: EA that stays


def moved(entered) -> np.ndarray:
    """Where the payload takes the platform at the lengths that hold the pose without it."""
    free = held(entered)
    lengths = inverse(entered, free.position, np.eye(3)).lengths
    return forward(entered.with_load(PAYLOAD), lengths, free.position, free.rotation).require_converged().position


def test_static_stiffness_is_that_of_small_steps(point):
    """A small force at locked lengths, by the law itself, and the 6 x 6 stiffness with the ratio of the law."""
    pushed = np.array([0.0, 0.0, -1e-2, 0.0, 0.0, 0.0])
    lengths = inverse(robot(), point.position, np.eye(3)).lengths
    start = forward(robot(), lengths, point.position, point.rotation)
    there = forward(robot(), lengths, start.position, start.rotation, external_wrench=pushed)
    stiffness = static_stiffness(robot(), start.position, start.rotation, start.cables)
    expected = stiffness.compliance[2, 2] * pushed[2]
    assert there.position[2] - start.position[2] == pytest.approx(expected, rel=5e-3)  # one EA a cable, that at its end
    secant = static_stiffness(robot(ratio=1.0), start.position, start.rotation, start.cables).compliance[2, 2]
    assert secant * pushed[2] != pytest.approx(expected, rel=0.1)  # twin
