"""Poses written in another convention: recognised, named, corrected."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from cdpr_struct.diagnosis import diagnosing
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.hypotheses.conventions import conventions
from cdpr_struct.measurement.campaign import RobotFrequencies
from tests.laws.written_campaigns import cogiro, measured, with_states

SLOW = pytest.mark.slow


def angles_of(turn: Rotation, order: str = "xyz") -> np.ndarray:
    """Angles in the columns rx, ry, rz, about fixed axes in the order of turning."""
    return turn.as_euler(order)[:, [order.index(axis) for axis in "xyz"]]


def quaternions_moved(turn: Rotation, places: int) -> Rotation:
    return Rotation.from_quat(np.roll(turn.as_quat(), places, axis=1))


Y_UP = Rotation.from_euler("x", 90, degrees=True)
MIRROR = np.diag([1.0, -1.0, 1.0])
WRITTEN = {
    "about z, then y, then x": lambda p, r: (p, angles_of(r, "zyx")),
    "about y, then x, then z": lambda p, r: (p, angles_of(r, "yxz")),
    "columns rz, ry, rx": lambda p, r: (p, angles_of(r)[:, ::-1]),
    "rotation vectors": lambda p, r: (p, r.as_rotvec()),
    "transposed": lambda p, r: (p, angles_of(r.inv())),
    "x, y, z, w as w, x, y, z": lambda p, r: (p, angles_of(quaternions_moved(r, -1))),
    "w, x, y, z as x, y, z, w": lambda p, r: (p, angles_of(quaternions_moved(r, 1))),
    "y up": lambda p, r: (Y_UP.inv().apply(p), angles_of(Y_UP.inv() * r * Y_UP)),
    "left-handed": lambda p, r: (p @ MIRROR, angles_of(Rotation.from_matrix(MIRROR @ r.as_matrix() @ MIRROR))),
}
SAID = {
    "about z, then y, then x": "z, then y, then x", "about y, then x, then z": "y, then x, then z",
    "columns rz, ry, rx": "column", "rotation vectors": "rotation vectors", "transposed": "transposed",
    "x, y, z, w as w, x, y, z": "x, y, z, w that were taken", "w, x, y, z as x, y, z, w": "w, x, y, z that were taken",
    "y up": "y points up", "left-handed": "y points the other way",
}  # fmt: skip


@pytest.fixture(scope="module")
def campaign():
    return measured(cogiro(), 9)


@pytest.mark.parametrize("way", WRITTEN)
def test_the_right_reading_is_among_those_tried(campaign, way):
    """Each way of writing is undone by the convention that says so, to rounding."""
    position, turn = campaign.states.position, Rotation.from_euler("xyz", campaign.states.angles)
    wrong = dict(zip(("position", "angles"), WRITTEN[way](position, turn), strict=True))
    (found,) = [one for one in conventions(with_states(campaign, **wrong)) if SAID[way] in one.sentence]
    again = Rotation.from_euler("xyz", found.campaign.states.angles)
    assert (again * turn.inv()).magnitude().max() < 1e-12
    assert found.campaign.states.position == pytest.approx(position, abs=1e-12)


@pytest.mark.parametrize(
    "way", [pytest.param(way, marks=[] if way == "about z, then y, then x" else SLOW) for way in WRITTEN]
)
def test_another_convention_is_named(campaign, way):
    position, turn = campaign.states.position, Rotation.from_euler("xyz", campaign.states.angles)
    wrong = dict(zip(("position", "angles"), WRITTEN[way](position, turn), strict=True))
    said = diagnosed(with_states(campaign, **wrong))
    assert said.decision.status == "named", said.decision
    assert said.decision.classes == (("rotation_convention",),)
    assert SAID[way] in said.correction.sentence


def test_peaks_are_left_out_where_the_robot_cannot_stand(campaign, monkeypatch):
    """Poses that a convention puts upside down have no modes: what is left of the readings says what is wrong."""
    asked = []

    def explained(one, budget, progress):
        asked.append(one)
        if len(one.robot_frequencies.hertz):
            raise UnstableEquilibriumError("the equilibrium is unstable")
        return [budget, progress]

    monkeypatch.setattr(diagnosing, "explained", explained)
    peaks = RobotFrequencies(np.array([0]), np.array([3.0]), np.array([0.01]))
    left, _ = diagnosing._explained(replace(campaign, robot_frequencies=peaks), "small", str)
    assert [len(one.robot_frequencies.hertz) for one in asked] == [1, 0]
    assert "frequencies are not used" in left.notes[-1]
    nothing = np.full_like(campaign.states.tension, np.nan)
    bare = with_states(replace(campaign, robot_frequencies=peaks), tension=nothing, length=nothing)
    with pytest.raises(UnstableEquilibriumError):
        diagnosing._explained(bare, "small", str)
