"""Bands of one cable's frequencies against cables that are drawn from its tolerances and described one by one."""

from dataclasses import replace

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.bands.cable_bands import HELD, NUMBERS, UncertainCable
from cdpr_struct.crosscheck.single_cable import describe_cable
from cdpr_struct.robot.tolerances import Tolerances

CABLE = UncertainCable(np.array([100.0, -100.0]), 20.0, 251327.4, 0.067, 9.81, Tolerances(), "force")
COUNT = 6


def of_a_robot(name: str) -> UncertainCable:
    """The first cable of a robot at home, as its end force has it."""
    solution = cs.inverse(name).solution
    cables, cable = solution.cables, cs.load_robot(name).cables[0]
    force = np.array([cables.force_x[0], cables.force_z[0]])
    return UncertainCable(
        force, float(cables.length[0]), cable.axial_stiffness, cable.linear_density, 9.81, Tolerances(), "force"
    )


def described(cable: UncertainCable) -> np.ndarray:
    told = describe_cable(*cable.force, cable.length, cable.axial_stiffness, cable.density, cable.gravity)
    return np.concatenate([told["exact_frequencies_hz"][plane] for plane in ("out_of_plane", "in_plane")])


def test_a_cable_as_entered_has_the_frequencies_of_the_command():
    for held in HELD:
        found = replace(CABLE, held=held).numbers(np.zeros((1, 6)), COUNT)[0]
        assert found[:-1] == pytest.approx(described(CABLE), rel=1e-9)
        assert found[-1] == pytest.approx(np.hypot(100.0, 100.0), rel=1e-9)


@pytest.mark.parametrize("name", [pytest.param("cogiro", marks=pytest.mark.slow), "thesis-3-1"])
def test_bands_are_those_of_cables_described_one_by_one(name):
    """Cables of two robots whose force, length, EA and density are drawn here."""
    cable = of_a_robot(name)
    bands = cable.bands(COUNT, 0.9)
    normal = np.random.default_rng(5).standard_normal((200, 4))
    own, pull = cable.tolerances, np.linalg.norm(cable.force)
    sizes = [own.length_m, own.axial_stiffness, own.linear_density, np.hypot(own.load_cell_gain, 0.5 / pull)]
    drawn = [
        described(
            replace(
                cable,
                length=cable.length + one[0],
                axial_stiffness=cable.axial_stiffness * np.exp(one[1]),
                density=cable.density * np.exp(one[2]),
                force=cable.force * (1.0 + one[3]),
            )
        )
        for one in normal * sizes
    ]
    ends = np.quantile(drawn, [0.05, 0.95], axis=0)
    assert np.allclose(bands.sigma, np.std(drawn, axis=0), rtol=0.12)
    assert (np.abs(ends - [bands.low, bands.high]) <= 0.2 * (bands.high - bands.low)).all()


def test_ends_that_are_held_decide_the_tension():
    """A taut cable 20 m long: a millimetre at its anchors is a tenth of its tension. With the force known from a load
    cell neither length nor anchors matter."""
    by_force, by_ends = (replace(CABLE, held=held).bands(COUNT, 0.9) for held in HELD)
    share = dict(zip(NUMBERS, by_ends.shares[:, 0], strict=True))
    assert share["ends"] > 0.8
    assert dict(zip(NUMBERS, by_force.shares[:, 0], strict=True))["length"] < 1e-3
    assert by_ends.sigma[0] > 5.0 * by_force.sigma[0]
    assert np.allclose(by_ends.shares.sum(axis=0), 1.0)


def test_drawn_cables_show_where_first_order_misses():
    """The first frequency in the plane: with the tension, the part of the string rises and that of the sag falls."""
    found = cs.cable(force=(100, -100), length=20, EA=251327.4, rho=0.067, band=90, samples=100, held="ends")
    bands = found.answer["bands"]
    assert bands["samples"]["differ"] == ["in_plane 1"]
    low, high = bands["samples"]["exact_frequencies_hz"]["in_plane"][0]
    assert f"{low:.4f} .. {high:.4f}*" in found.text()
    assert "defaults used: anchor_m" in found.text()


def test_tolerances_of_zero_leave_no_band():
    none = dict.fromkeys(("length_m", "axial_stiffness", "linear_density", "load_cell_gain", "load_cell_bias_N"), 0.0)
    found = cs.cable(force=(100, -100), length=20, EA=251327.4, rho=0.067, band=90, tolerances=none)
    ends = np.array(found.answer["bands"]["exact_frequencies_hz"]["in_plane"])
    assert np.allclose(ends[:, 0], ends[:, 1])
    assert np.allclose(ends[:, 0], found.answer["exact_frequencies_hz"]["in_plane"])
