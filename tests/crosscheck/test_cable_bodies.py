"""The diagnosis finds a mass on a cable and stiff cables on hinges: the FEM plucks the cables."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign
from cdpr_struct.robot.robot_file import load_robot
from fem_reference.cable import CableData
from fem_reference.cable_modes import cable_modes
from fem_reference.cable_statics import solve_cable
from tests.laws.written_campaigns import noisy, plan_of, written

ROBOT, POSES, MODES, SIGMA, MESHES = load_robot("thesis-3-1"), 3, 5, 2e-3, (60, 120)
CABLES = len(ROBOT.cables)


def plucked(lumps: dict[int, tuple[float, float]], stiff: float = 0.0, seed: int = 1) -> Campaign:
    """Modes across the plane of all cables at three poses, with noise.

    lumps : by cable, a share of its length from the platform and a mass [kg];  stiff : EI [N m^2] of hinged cables
    """
    silent = written(ROBOT, plan_of(ROBOT, POSES))
    hertz = np.array([[modes_of(silent, s, i, lumps.get(i), stiff) for i in range(CABLES)] for s in range(POSES)])
    state, cable, mode = (axis.ravel() for axis in np.indices(hertz.shape))
    drawn = hertz.ravel() * (1.0 + SIGMA * np.random.default_rng(seed).normal(size=hertz.size))
    across = np.zeros(hertz.size, dtype=bool)
    rows = CableFrequencies(state, cable, mode + 1, across, drawn, SIGMA * hertz.ravel())
    return replace(noisy(silent, seed), cable_frequencies=rows)


def modes_of(campaign: Campaign, s: int, i: int, lump: tuple[float, float] | None, stiff: float) -> np.ndarray:
    """(MODES,) [Hz] by the FEM, extrapolated from two meshes; EI raises the n-th of a hinged string by the root of
    1 + (n pi / l)^2 EI / tau."""
    states, own = campaign.states, ROBOT.cables[i]
    length = float(states.length[s, i])
    lumps = () if lump is None else ((lump[0] * length, lump[1]),)
    data = CableData(length, own.axial_stiffness, own.linear_density, lumps=lumps)
    end = states.position[s] + rotation(*states.angles[s]) @ ROBOT.platform_anchors[i]
    found = []
    for elements in MESHES:
        cable = solve_cable(data, ROBOT.frame_anchors[i], end, elements)
        modes = cable_modes(cable, 3 * MODES)
        found.append(modes.frequencies_hz[modes.in_plane_share < 0.5][:MODES])
    fine = found[1] + (found[1] - found[0]) / 3.0
    waves = np.arange(1, MODES + 1) * np.pi / np.linalg.norm(end - ROBOT.frame_anchors[i])
    return fine * np.sqrt(1.0 + waves**2 * stiff / cable.tensions.mean())


SEEDS = [1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (2, 3))]


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_a_mass_off_the_middle_is_named_with_its_place(seed):
    mass, place = 0.03, 0.3
    found = diagnosed(plucked({2: (place, mass)}, seed=seed))
    assert found.decision.classes == (("cable_added_mass",),)
    (size,), more = found.sizes, found.extended.extensions
    assert np.abs([more.added_mass[2] - mass, more.added_mass_place[2] - place] / size.sigma).max() < 2.6  # 99 %
    assert not np.delete(more.added_mass, 2).any()
    assert size.sigma[1] < 0.003


@pytest.mark.parametrize("seed", SEEDS)
def test_stiff_cables_on_hinges_are_told_from_clamped_ones(seed):
    stiff = 6.0
    found = diagnosed(plucked({}, stiff, seed=seed))
    assert found.decision.classes == (("bending_stiffness",),)
    (size,), more = found.sizes, found.extended.extensions
    assert size.part.pattern.label == "all alike, pinned ends"
    assert not more.bending_fixity.any()
    assert abs(more.bending_stiffness[0] - stiff) < 2.6 * size.sigma[0] < 0.1 * stiff
