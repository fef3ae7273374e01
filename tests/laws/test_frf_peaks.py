"""Peaks of frequency responses are those of the curve, not of the lines on which it was evaluated."""

from functools import cache

import numpy as np
import pytest

from cdpr_struct.dynamics.bracketed_search import bracketed_crossings, bracketed_minima
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import Hysteretic, Undamped, Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.frequency_sweep import ResponseSweep, sweep_response
from cdpr_struct.dynamics.ports import CablePort, platform_port
from cdpr_struct.dynamics.swept_stiffness import dynamic_stiffness
from tests.conftest import at_rest

AXES = np.eye(3)
PORTS = tuple(platform_port(name, axis, False, np.zeros(3)) for name, axis in zip("xyz", AXES, strict=True))
Z = PORTS[2]
POSES = {"thesis-3-1": np.array([1.3, -0.8, 0.9]), "cogiro": np.array([1.0, 0.5, 1.5])}
CASES = [(robot, model, ratio) for robot in POSES for model in ("exact", "dsm") for ratio in (1e-2, 1e-4)]


def viscous(point, ratio):
    return Viscous(np.full(len(point.robot.cables), ratio))


@cache
def sweep(robot: str, model: str, ratio: float, step: float, quantity="acceleration") -> ResponseSweep:
    """x, y, z and a point of a cable under a vertical force, 2 to 8 Hz."""
    point = at_rest(robot, POSES[robot])
    hertz = 2.0 + step * np.arange(round(6.0 / step) + 1)
    ports = (*PORTS, CablePort("cable5@0.3:z", 4, 0.3, AXES[2]))
    law = viscous(point, ratio) if ratio else Undamped()
    return sweep_response(point, model, law, Z, ports, hertz, quantity)


def pairs(one, other):
    """Numbers of the peaks that two lists share: nearest to each other, within a tenth of a width."""
    apart = np.abs(one.hertz[:, None] - other.hertz)
    there, back = apart.argmin(axis=1), apart.argmin(axis=0)
    mutual = np.flatnonzero(back[there] == np.arange(len(one.hertz)))
    close = apart[mutual, there[mutual]] < 1e-3 * one.hertz[mutual]
    return mutual[close], there[mutual[close]]


@pytest.mark.parametrize(("robot", "model", "ratio"), CASES)
@pytest.mark.parametrize("step", [0.1, 0.01])
def test_neither_place_nor_height_nor_width_depends_on_the_step(robot, model, ratio, step):
    """Against 0.001 Hz. A hundred-thousandth is typical; 0.1 % of the height is promised, 1 % of the width."""
    fine, coarse = sweep(robot, model, ratio, 0.001), sweep(robot, model, ratio, step)
    for one, other in zip(fine.peaks, coarse.peaks, strict=True):
        i, j = pairs(one, other)
        assert len(i) >= max(len(one.hertz), len(other.hertz)) - 1  # one may be at the edge of 5 %
        assert len(i) > 1
        width = 2.0 * one.hertz[i] * np.median(fine.ratios)
        assert (np.abs(one.hertz[i] - other.hertz[j]) < np.maximum(0.02 * width, 1e-6 * one.hertz[i])).all()
        np.testing.assert_allclose(other.magnitude[j], one.magnitude[i], rtol=1e-3)
        known = np.isfinite(one.half_power_width[i]) & np.isfinite(other.half_power_width[j])
        assert known.sum() >= 0.95 * np.isfinite(one.half_power_width[i]).sum()
        np.testing.assert_allclose(other.half_power_width[j][known], one.half_power_width[i][known], rtol=1e-2)


@pytest.mark.parametrize("robot", POSES)
def test_height_is_that_of_the_full_model(robot):
    """Evaluated without interpolation on two hundred frequencies about each peak of a damping ratio of 1e-4."""
    found = sweep(robot, "exact", 1e-4, 0.1)
    point = found.point
    cables = cable_dynamics(point, "exact", 2.0 * np.pi * 8.0)
    peaks = found.peaks[2]
    for i in np.argsort(peaks.magnitude)[-4:]:
        hertz = peaks.hertz[i] + peaks.half_power_width[i] * np.linspace(-0.5, 0.5, 201)
        omega = 2.0 * np.pi * hertz
        matrices = dynamic_stiffness(point, cables, viscous(point, 1e-4), omega)
        motion = np.linalg.solve(matrices, np.broadcast_to(Z.twist[:, None], (201, 6, 1)))[:, 2, 0]
        size = np.abs(motion) * omega**2
        assert peaks.magnitude[i] == pytest.approx(size.max(), rel=1e-4)
        np.testing.assert_allclose(size[[0, -1]], size.max() / np.sqrt(2.0), rtol=0.05)  # half power at the half width


@pytest.mark.parametrize("ratio", [1e-2, 1e-4])
def test_width_of_a_mode_alone_is_twice_its_damping(ratio):
    """Six modes, 1 Hz and more apart, on massless cables with a loss factor 2 zeta: width 2 zeta f to second order."""
    point = at_rest("thesis-3-1", POSES["thesis-3-1"])
    found = sweep_response(point, "static", Hysteretic(2.0 * ratio), Z, (Z,), np.arange(0.5, 30.0, 0.05))
    peaks = found.peaks[0]
    highest = int(peaks.magnitude.argmax())
    assert peaks.damping_ratio[highest] == pytest.approx(ratio, rel=max(5.0 * ratio, 2e-3))
    assert found.ratios == pytest.approx(np.full(len(found.ratios), ratio), rel=5e-3)  # no loss in the rotating arms


@pytest.mark.parametrize("model", ["static", "dsm", "exact"])
def test_undamped_peaks_are_poles(model):
    """Every eigenfrequency that is excited and seen, at that frequency, unbounded, whatever the step."""
    point = at_rest("cogiro", POSES["cogiro"])
    found = []
    for law in (Undamped(), viscous(point, 0.0)):
        for step in (0.1, 0.013):
            sweep_ = sweep_response(point, model, law, Z, PORTS, np.arange(2.0, 8.0, step))
            for peaks in sweep_.peaks:
                modes = sweep_.modes.hertz[(sweep_.modes.hertz > 2.0) & (sweep_.modes.hertz < 7.98)]
                np.testing.assert_array_equal(peaks.hertz[peaks.hertz < 7.98], modes)
                assert np.isinf(peaks.magnitude).all()
                assert np.isnan(peaks.half_power_width).all()
            assert np.isfinite(sweep_.response.response).all()
            found.append(len(sweep_.peaks[0].hertz))
    assert min(found) >= (3 if model == "static" else 20)


def test_symmetry_leaves_poles_and_peaks_out(thesis_point):
    """At the home pose nothing answers sideways, and only the symmetric modes answer along z."""
    for law in (Undamped(), viscous(thesis_point, 1e-4), viscous(thesis_point, 0.01)):
        found = sweep_response(thesis_point, "exact", law, Z, PORTS, np.arange(1.0, 16.0, 0.005))
        assert found.silent.tolist() == [True, True, False]
        assert [len(peaks.hertz) for peaks in found.peaks[:2]] == [0, 0]
        assert 0 < len(found.peaks[2].hertz) < 0.7 * len(found.modes.hertz)


def test_the_lines_hold_every_peak_within_its_half_power_band():
    for ratio in (1e-2, 1e-4):
        found = sweep("cogiro", "exact", ratio, 0.1)
        assert found.even.sum() == 61
        for column, peaks in enumerate(found.peaks):
            at = np.searchsorted(found.response.hertz, peaks.hertz)
            np.testing.assert_array_equal(found.response.hertz[at], peaks.hertz)
            height = np.abs(found.response.response[at, column])
            np.testing.assert_allclose(height, peaks.magnitude, rtol=1e-6)
            inside = (found.response.hertz[:, None] > peaks.half_power_hertz[:, 0]) & (
                found.response.hertz[:, None] < peaks.half_power_hertz[:, 1]
            )
            assert (inside.sum(axis=0) >= 3)[np.isfinite(peaks.half_power_width)].all()


def test_even_lines_are_the_response_itself():
    found = sweep("cogiro", "exact", 1e-4, 0.01)
    even = found.evenly
    cables = cable_dynamics(found.point, "exact", 2.0 * np.pi * 8.0)
    law = viscous(found.point, 1e-4)
    plain = frequency_response(found.point, cables, law, Z, found.response.respond, even.hertz)
    np.testing.assert_allclose(even.response, plain.response, rtol=1e-12)  # equal but for rounding


def test_bracketed_minima_and_crossings():
    """Minima of quartics and zeros of a cosine, all at once."""
    centre, stretch = np.linspace(1.0, 2.0, 7), np.linspace(0.0, 3.0, 7)

    def quartic(place, rows):
        x = place - centre[rows]
        return x**2 + stretch[rows] * x**3 + 4.0 * x**4

    brackets = centre[:, None] + np.array([-0.11, 0.02, 0.12])
    rows = np.repeat(np.arange(7), 3)
    place, value = bracketed_minima(quartic, brackets, quartic(brackets.ravel(), rows).reshape(7, 3))
    np.testing.assert_allclose(place, centre, atol=3e-4)
    assert value.max() < 1e-7
    ends = np.stack([centre - 0.3, centre + 0.1], axis=1)

    def wave(place, rows):
        return np.sin(3.0 * (place - centre[rows]))

    zeros = bracketed_crossings(wave, ends, wave(ends.ravel(), np.repeat(np.arange(7), 2)).reshape(7, 2))
    np.testing.assert_allclose(zeros, centre, atol=1e-8)
