"""Pose error (3.2.2): the thesis's table, the split, and from which load on springs will do."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.pose_error import pose_error, potential_energy, reference_lengths
from cdpr_struct.statics.sufficient_load import sufficient_load

# Thesis, Table 3.2: average pose error along z [mm] introduced by sag, by axial elasticity, and global.
TABLE_3_2 = {
    ("thesis-3-1", 30): (5.4, -9.7, -4.3),
    ("thesis-3-1", 60): (0.8, -19.3, -18.5),
    ("thesis-3-1-8mm", 30): (55.0, -2.4, 52.6),
    ("thesis-3-1-8mm", 60): (18.1, -4.9, 13.2),
}


def grid(count: int) -> np.ndarray:
    """(count, count, 3) poses x, y in -3..3 m at z = 0.5 m."""
    x, y = np.meshgrid(*[np.linspace(-3.0, 3.0, count)] * 2, indexing="ij")
    return np.stack([x, y, np.full_like(x, 0.5)], axis=-1)


def averages(robot, mass: float) -> np.ndarray:
    error = pose_error(robot, grid(7), np.eye(3), mass=mass)
    assert error.converged.all()
    assert not error.more_stable_pose.any()
    return np.array([1e3 * e[..., 2].mean() for e in (error.sag_error, error.axial_error, error.global_error)])


@pytest.mark.parametrize(("name", "mass"), list(TABLE_3_2))
def test_table_3_2(name, mass):
    """Printed to 0.1 mm (half a digit: 0.05); its -19.3 is -19.36 here, the only one not rounded like ours."""
    assert averages(load_robot(name), mass) == pytest.approx(np.array(TABLE_3_2[name, mass]), abs=0.07)


def test_table_3_2_sees_a_wrong_stiffness():
    """Twin: EA 2 % too soft is outside the tolerance."""
    robot = load_robot("thesis-3-1")
    soft = replace(robot, cables=tuple(replace(c, axial_stiffness=0.98 * c.axial_stiffness) for c in robot.cables))
    assert np.abs(averages(soft, 60) - TABLE_3_2["thesis-3-1", 60]).max() > 0.3


def test_split_adds_up():
    error = pose_error(load_robot("thesis-3-1"), grid(3), np.eye(3))
    assert error.sag_error + error.axial_error == pytest.approx(error.global_error)
    assert np.abs(error.global_rotation).max() < 0.1
    assert np.abs(error.axial_rotation).max() < 0.1
    assert (error.axial_error[..., 2] < 0.0).all()  # springs only stretch
    assert (error.sag_error[..., 2] > 0.0).all()  # a curve spans less than its length


def test_spring_pose_is_the_one_next_to_the_reference():
    """Stiffer and stiffer springs close in on the reference pose."""
    robot = load_robot("thesis-3-1")
    sizes = []
    for factor in (1.0, 10.0, 100.0):
        arrays = replace(RobotArrays.of(robot), axial_stiffness=factor * robot.axial_stiffness)
        sizes.append(np.abs(pose_error(arrays, grid(3), np.eye(3)).axial_error).max())
    assert sizes[1] == pytest.approx(sizes[0] / 10.0, rel=0.1)
    assert sizes[2] == pytest.approx(sizes[0] / 100.0, rel=0.1)


def test_reference_lengths_are_straight_lines():
    robot = load_robot("thesis-3-1")
    lengths = reference_lengths(robot, [0.0, 0.0, 0.5], np.eye(3))
    points = np.array([0.0, 0.0, 0.5]) + robot.platform_anchors
    assert lengths == pytest.approx(np.linalg.norm(points - robot.frame_anchors, axis=1))
    wheel = replace(robot, pulleys=(Pulley(0.05),) * 8)
    assert (reference_lengths(wheel, [0.0, 0.0, 0.5], np.eye(3)) > lengths).all()


def test_potential_energy_is_least_at_the_equilibrium():
    """Its slope is minus the wrench: against a forced displacement, E rises by K d^2 / 2."""
    robot = load_robot("thesis-3-1")
    lengths = reference_lengths(robot, [0.5, 0.3, 0.5], np.eye(3))
    rest = forward(robot, lengths, [0.5, 0.3, 0.5], model="spring")
    energies = []
    for force in (0.0, 10.0, -10.0):
        pushed = forward(robot, lengths, rest.position, rest.rotation, "spring", [force, 0, 0, 0, 0, 0])
        energies.append(float(potential_energy(robot, pushed)))  # of cables and weight, without the pushing force
    assert energies[1] > energies[0]
    assert energies[2] > energies[0]
    displaced = forward(robot, lengths, rest.position, rest.rotation, "spring", [10.0, 0, 0, 0, 0, 0])
    work = 0.5 * 10.0 * (displaced.position - rest.position)[0]
    assert energies[1] - energies[0] == pytest.approx(work, rel=0.02)


@pytest.mark.parametrize(
    ("name", "place", "printed", "share"),
    [("six-cable-4mm", [0.0, 0.0, 0.5], 50.0, 0.03), ("six-cable-8mm", [3.0, 0.0, 0.5], 70.0, 0.04)],
)
def test_load_at_which_the_spring_model_suffices(name, place, printed, share):
    """Thesis 4.2.2, read by eye from fig. 4.4: about 50 and 70 kg. There the sag error has fallen to `share` of that
    of the 10 kg platform the experiments begin with."""
    robot = load_robot(name)
    first = abs(pose_error(robot, place, np.eye(3), mass=10.0).sag_error[2])
    load = sufficient_load(robot, place, np.eye(3), tolerance=share * first, smallest=5.0, largest=100.0)
    assert load.mass == pytest.approx(printed, rel=0.1)
    at = pose_error(robot, place, np.eye(3), mass=load.mass).sag_error[2]
    assert abs(at) == pytest.approx(share * first, rel=1e-3)


def test_a_tolerance_that_no_load_meets_is_nan_and_nonsense_is_refused():
    robot = load_robot("six-cable-4mm")
    assert np.isnan(sufficient_load(robot, [0, 0, 0.5], np.eye(3), 1e-9, largest=50.0).mass)
    assert sufficient_load(robot, [0, 0, 0.5], np.eye(3), 10.0, smallest=5.0).mass == 5.0
    with pytest.raises(ValueError, match="tolerance and masses must be positive"):
        sufficient_load(robot, [0, 0, 0.5], np.eye(3), 0.0)


def test_a_lower_equilibrium_elsewhere_is_pointed_out():
    """Light platform off-centre: often the spring model has a second pose, lower in energy, near the sagging one.

    The probe is one descent and basins are intricate there, so a dozen neighbouring poses are asked.
    """
    robot = load_robot("six-cable-8mm").with_load(mass=3.0)
    place = np.array([-2.343, -1.558, 0.5]) + 0.01 * np.random.default_rng(0).normal(size=(12, 3))
    error = pose_error(robot, place, np.eye(3))
    assert error.converged.all()
    found = np.flatnonzero(error.more_stable_pose)
    assert found.size
    place, start = place[found], error.sagging
    lengths = reference_lengths(robot, place, np.eye(3))
    other = forward(robot, lengths, start.position[found], start.rotation[found], "spring")
    assert other.stable.all()
    assert (potential_energy(robot, other) < potential_energy(robot, error.spring)[found]).all()
    assert not pose_error(robot, [0.0, 0.0, 0.5], np.eye(3)).more_stable_pose
