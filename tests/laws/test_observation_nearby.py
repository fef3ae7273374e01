"""States near known ones: first-order residuals have the slopes of the whole computation, by everything."""

import numpy as np
import pytest

from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.observation.nearby_rest import NearbyRest
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import static_residuals
from cdpr_struct.residuals.linearised import Term, less
from cdpr_struct.residuals.recorded import Recorded, recorded
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.tolerances import tolerance_count, tolerated
from tests.laws.written_campaigns import extended, mast_values, on_pulleys, plan_of, written

SHARE = 2e-5  # of the largest slope: one-sided differences over a hundred-thousandth of a value err by as much
UNSEEN = 1e-5 * np.repeat([0.05, 2e-5], (6, 8))  # N, m, a sigma of the cause: of what evidence can see at all
MISSING = {
    "bending_stiffness", "cable_added_mass", "accelerometer_gain", "accelerometer_mass", "platform_inertia",
    "flexible_platform", "steady_disturbance", "swinging_payload",
}  # fmt: skip
"""Act in vibration only."""


def everything(name: str) -> Recorded:
    """A campaign of a robot that has something of everything, so that no slope is that of a neutral value."""
    robot = on_pulleys("cogiro", 0.05) if name == "pulleys" else load_robot(name)
    m = len(robot.cables)
    varied = np.linspace(0.4, 1.3, m)
    more = {
        "series_compliance": 4e-6 * varied, "frame_compliance": mast_values(robot, 2e-6 * varied), "hose": 30.0,
        "mast_bending": mast_values(robot, 3e-6 * varied), "mast_foot": -1.0,
        "hose_center": robot.home.position, "force": [5.0, 3.0, -4.0], "tilt": [3e-3, -2e-3], "nonlinearity": 0.1,
        "reference_tension": 400.0, "length_offset": 2e-3 * varied, "length_scale": 1.0 + 1e-3 * varied,
        "cell_gain": 1.0 + 0.02 * varied, "cell_bias": 4.0 * varied, "friction": 0.03 * varied,
        "tracker": [1e-3, 2e-3, -1e-3, 1e-3, -2e-3, 1e-3], "creep": 0.05, "slip": 1e-3 * varied,
    }  # fmt: skip
    return recorded(written(extended(robot, **more), plan_of(robot, 2, loads=(5.0,))))


@pytest.fixture(scope="module", params=["thesis-3-1", "pulleys"])
def about(request) -> tuple[Recorded, NearbyRest]:
    data = everything(request.param)
    return data, NearbyRest.about(data.arrays, data.readings, data.known, data.radius)


def whole(data: Recorded, arrays: RobotArrays, readings: Readings) -> np.ndarray:
    return static_residuals(arrays, readings, data.known, data.radius)


def assert_same_slopes(found: np.ndarray, expected: np.ndarray, label: str) -> None:
    """Slopes (d, S, rows) agree as well as the largest of each column asks, forces and lengths apart."""
    for rows in (slice(0, 6), slice(6, None)):
        size = np.abs(expected[..., rows]).max(axis=(1, 2), keepdims=True)
        excess = np.abs(found - expected)[..., rows] - SHARE * size - UNSEEN[rows]
        assert excess.max() < 0.0, f"{label}: {excess.max():.1e}"


def slopes(of, step: float, count: int) -> np.ndarray:
    """Central differences (d, S, rows) of `of`(steps (d, 1, d)), of the fourth order."""
    each = step * np.eye(count)[:, None, :]
    return (8.0 * (of(each) - of(-each)) - (of(2.0 * each) - of(-2.0 * each))) / (12.0 * step)


def test_slopes_by_every_reading(about):
    data, nearby = about
    count = data.sigma.shape[1]

    def moved(steps: np.ndarray) -> Readings:
        return less(data, data.readings, steps)

    exact = slopes(lambda u: whole(data, data.arrays, moved(u)), 0.5, count)
    found = slopes(lambda u: nearby.residuals(data.arrays, moved(u)), 1e-3, count)
    assert_same_slopes(found, exact, "readings")


@pytest.mark.parametrize("name", sorted(set(LIBRARY) - MISSING))
def test_slopes_by_every_parameter_of_every_cause(about, name):
    data, nearby = about
    cause = LIBRARY[name]
    if name == "pulley_radius" and not data.arrays.has_pulleys:
        pytest.skip("no wheel that it could change")
    if name in ("sensor_delay", "clock_drift"):
        pytest.skip("these states were filed at rest: test_sensor_delay.py")
    if name == "missing_pulleys":
        pytest.skip("a wheel cannot be smaller than none: forward differences in test_missing_pulleys.py")
    sigma = np.array([p.prior for p in cause.basic(seen_in(data))])
    term = Term(cause.apply, np.eye(len(sigma)), sigma)

    def changed(z: np.ndarray) -> RobotArrays:
        return term.applied(data.arrays, z)

    exact = slopes(lambda z: whole(data, changed(z), data.readings), 0.02, len(sigma))
    found = slopes(lambda z: nearby.residuals(changed(z), data.readings), 1e-3, len(sigma))
    assert np.abs(exact).max() > 0.0
    assert_same_slopes(found, exact, name)


def test_slopes_by_every_tolerance(about):
    data, nearby = about
    count = tolerance_count(data.cables, data.arrays.has_pulleys)

    def changed(u: np.ndarray) -> RobotArrays:
        return tolerated(data.arrays, data.campaign.tolerances, u)

    exact = slopes(lambda u: whole(data, changed(u), data.readings), 0.1, count)
    found = slopes(lambda u: nearby.residuals(changed(u), data.readings), 1e-2, count)
    acting = np.abs(exact).max(axis=(1, 2)) > 0.0
    idle = 3 + data.cables  # inertia; zeros of swivel angles that are not among these rows, or radii without wheels
    assert (~acting).sum() == idle
    assert_same_slopes(found[acting], exact[acting], "tolerances")


def test_at_the_states_themselves_nothing_differs(about):
    data, nearby = about
    there = nearby.residuals(data.arrays, data.readings)
    np.testing.assert_allclose(there, whole(data, data.arrays, data.readings), rtol=0.0, atol=1e-9)
