"""The certified count of natural frequencies equals the FEM's, at any omega where the FEM has converged.

The FEM alone says where it has: two meshes count alike, and, since lumped mass lets every frequency rise to its limit,
none of the finer mesh's frequencies lies within its mesh error below omega. The model has no part in that decision.
"""

import numpy as np
import pytest

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.natural_frequencies import count_below
from tests.conftest import at_rest

MESH_ERROR = 4e-3  # (9 pi / 120)^2 / 24 for nine half waves on 120 lumped elements is 2.3e-3
HIGHEST = 70.0  # rad/s: some 60 frequencies, up to four half waves a cable
ROBOTS = {
    "thesis-3-1": ((-2.5, 2.5), (-2.5, 2.5), (0.2, 1.5)),
    "cogiro": ((-3.0, 3.0), (-2.0, 2.0), (0.5, 2.5)),
    "thesis-3-1-8mm": ((-2.0, 2.0), (-2.0, 2.0), (0.2, 1.2)),
}


def counts(point, omegas, model="exact"):
    """(model's count, FEM's count, where the FEM has converged), each (k,)."""
    meshes = [solve_in_fem(point, n) for n in (60, 120)]
    coarse, fine = (np.array([fem.count_below(mesh, w) for w in omegas]) for mesh in meshes)
    below = np.array([fem.count_below(meshes[1], w * (1.0 - MESH_ERROR)) for w in omegas])
    ours = count_below(point, cable_dynamics(point, model, HIGHEST), omegas)
    return ours, fine, (coarse == fine) & (below == fine)


def poses(name, how_many):
    rng = np.random.default_rng(20)
    low, high = np.array(ROBOTS[name]).T
    return rng.uniform(low, high, (how_many, 3))


def check(name, per_pose):
    rng = np.random.default_rng(7)
    judged = 0
    for position in poses(name, 10):
        ours, fine, converged = counts(at_rest(name, position), rng.uniform(1.0, HIGHEST, per_pose))
        assert (ours[converged] == fine[converged]).all(), position
        judged += converged.sum()
    assert judged > 0.5 * 10 * per_pose
    return judged


@pytest.mark.parametrize("name", ROBOTS)
def test_counts_agree_at_ten_poses(name):
    """7 random omegas a pose: 210 in all."""
    check(name, 7)


@pytest.mark.slow
@pytest.mark.parametrize("name", ROBOTS)
def test_counts_agree_at_200_omegas_a_pose(name):
    check(name, 200)


def test_a_lost_cable_mode_is_noticed(monkeypatch):
    """Twin: a clamped count that forgets one cable disagrees with the FEM at once."""
    import cdpr_struct.dynamics.cable_dynamics as module

    true_count = module.CatenaryCables.clamped_count
    monkeypatch.setattr(
        module.CatenaryCables, "clamped_count", lambda self, omega: true_count(self, omega) * (np.arange(8) > 0)
    )
    ours, fine, converged = counts(at_rest("thesis-3-1"), np.array([22.0, 40.0, 65.0]))
    assert (ours[converged] != fine[converged]).all()
    assert converged.any()
