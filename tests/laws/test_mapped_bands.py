"""Bands over the workspace against robots drawn from the tolerances, and against the bands of single poses."""

from pathlib import Path

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.bands.mapped_bands import BANDED, BELOW, DRAWN, DRAWN_BELOW, ENDS, BandedQuantity, band_column
from cdpr_struct.robot.tolerances import Spread, Tolerances
from cdpr_struct.workspace.quantities import quantity_of

ENTERED = Path(__file__).parents[2] / "examples/bands/robot.toml"
QUANTITIES = (
    "tension-min", "tension-max", "sag-max", "stiffness-min", "stiffness-vertical", "tilt", "platform-frequency",
    "first-frequency", "pose-error", "pose-error-sag",
)  # fmt: skip


CASES = [
    *(("cogiro", quantity) for quantity in QUANTITIES),
    pytest.param(str(ENTERED), "tension-min", marks=pytest.mark.slow),
    pytest.param(str(ENTERED), "stiffness-min", marks=pytest.mark.slow),
    ("thesis-3-1", "platform-frequency"),
]
SMOOTH = ("pose-error", "pose-error-sag", "platform-frequency", "first-frequency", "stiffness-vertical")


def within(robot: cs.Robot) -> Spread:
    return Spread.within(Tolerances(**robot.tolerances), len(robot.cables))


@pytest.mark.parametrize(("name", "quantity"), CASES)
def test_bands_are_those_of_drawn_robots(name, quantity):
    """At a pose without symmetry and at one with it, where the least of several is no smooth number."""
    robot = cs.load_robot(name)
    position = robot.home.position + np.array([[0.0, 0.0, 0.0], [0.7, 0.3, 0.2]])
    bare = BandedQuantity(quantity, within(robot), 0.9)(robot, position, robot.home.rotation)
    value = bare[quantity_of(quantity).column]
    limit = float(value[1])
    samples = 250 if quantity == "first-frequency" else 400
    found = BandedQuantity(quantity, within(robot), 0.9, limit, samples)(robot, position, robot.home.rotation)
    low, high, sigma = (found[band_column(quantity, end)] for end in ENDS)
    ends = [found[band_column(quantity, end)] for end in DRAWN]
    assert (np.abs([low - ends[0], high - ends[1]]) <= 0.16 * (high - low)).all()
    if quantity in SMOOTH:
        assert np.allclose(0.5 * (low + high), value, atol=0.06 * (high - low).max())
    assert np.allclose(sigma, (high - low) / (2.0 * 1.645), rtol=0.12)
    assert np.allclose(found[BELOW], found[DRAWN_BELOW], atol=0.1)


def test_a_map_has_the_bands_of_single_poses():
    found = cs.map("thesis-3-1", "1,0,0.5", "first-frequency", band=90).frame()
    told = cs.modes("thesis-3-1", (1.0, 0.0, 0.5), count=1, band=90).answer["bands"]
    assert found[["first_low_Hz", "first_high_Hz"]].to_numpy()[0] == pytest.approx(told["frequencies_hz"][0], rel=1e-6)


def test_values_are_those_without_a_band_and_poses_that_are_not_held_have_none():
    grid = "0:12:3,0,0.5"
    bare, found = (cs.map("thesis-3-1", grid, "tension-min", **more).frame() for more in ({}, {"band": 50}))
    assert np.allclose(bare["tension_min_N"], found["tension_min_N"], equal_nan=True)
    assert np.isfinite(found["tension_min_low_N"]).tolist() == found["held"].astype(bool).tolist()
    assert not found["held"].all()


def test_the_least_of_equal_tensions_is_hardly_ever_as_large_as_entered():
    """At the centre of a symmetric robot four cables have the least tension; the weakest of them decides."""
    robot = cs.load_robot("thesis-3-1")
    limit = float(cs.map(robot, "0,0,0.5", "tension-min").frame()["tension_min_N"][0])
    found = cs.map(robot, "0,0,0.5", "tension-min", band=90, limit=limit)
    assert found.frame()[BELOW][0] > 0.9
    assert f"falls below {limit:g} N" in found.text()


def test_what_a_batch_depends_on_is_in_its_name():
    spread = within(cs.load_robot("cogiro"))
    names = {
        str(BandedQuantity("tilt", *asked))
        for asked in ((spread, 0.9), (spread, 0.8), (spread, 0.9, 1.0), (spread, 0.9, 1.0, 20))
    } | {str(BandedQuantity("tilt", Spread(2.0 * spread.root, spread.mean), 0.9))}
    assert len(names) == 5


def test_columns_end_with_the_unit_of_the_quantity():
    assert band_column("stiffness-min", "low") == "stiffness_min_low_N_mm"
    for quantity in map(quantity_of, BANDED):
        assert quantity.column.endswith("_" + quantity.unit.replace("/", "_"))
