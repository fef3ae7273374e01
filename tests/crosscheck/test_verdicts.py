"""Both models are judged, the FEM refines until it can judge, and the cause named is the one that was put in."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cdpr_struct.crosscheck.neglected_effects import CABLE_EFFECTS, expansion_without, neglected
from cdpr_struct.crosscheck.refined_fem import refined_fem
from cdpr_struct.crosscheck.verdict_causes import SAG
from cdpr_struct.crosscheck.verdicts import Agreement, Criteria
from cdpr_struct.crosscheck.verification import verify
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_mass_matrix
from cdpr_struct.interface.operating_point import rest
from cdpr_struct.reports.verification_verdict import verdict_lines
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot

BOX = Path(__file__).parents[2] / "examples" / "box-robot" / "robot.toml"
MESHES = (8, 16, 32)
COARSE = Criteria(exact_error=0.01)  # what three coarse meshes can judge


def at_home(robot: Robot) -> OperatingPoint:
    return rest(robot, None, None, None, None).point


def box(pulleys: bool = True, mass: float = 25.0) -> Robot:
    robot = load_robot(BOX)
    body = replace(robot.platform, mass=mass, inertia=robot.platform.inertia * mass / robot.platform.mass)
    return replace(robot, platform=body, pulleys=robot.pulleys if pulleys else tuple(None for _ in robot.cables))


def facade(tension: float, axial_stiffness: float = 7e6, linear_density: float = 0.6) -> Robot:
    """Eight cables from the corners of a frame 30 m wide, 40 m high and 4 m deep, 500 kg."""
    robot = load_robot(BOX)
    signs = np.array([[x, y, z] for z in (1.0, -1.0) for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
    cable = replace(
        robot.cables[0], axial_stiffness=axial_stiffness, linear_density=linear_density, force_min=tension,
        force_max=np.inf,
    )  # fmt: skip
    return replace(
        robot,
        name="facade",
        pulleys=(None,) * 8,
        cables=(cable,) * 8,
        frame_anchors=signs * [15.0, 2.0, 20.0] + [0.0, 0.0, 20.0],
        platform_anchors=signs * [1.5, 0.5, -0.75],
        platform=replace(
            robot.platform, mass=500.0, inertia=np.diag([250.0, 420.0, 420.0]), center_of_mass=np.zeros(3)
        ),
        home=replace(robot.home, position=np.array([0.0, 0.0, 20.0])),
    )


def effects(trial, model="dsm") -> list[str]:
    return [cause.effect for cause in trial.causes.get(model, ())]


def test_light_straight_cables_hold_in_both_models_once_the_fem_has_refined_itself():
    """Three meshes of 32 elements at most leave 5e-5 in doubt; the exact model needs 1e-5."""
    trial = verify(at_home(box(pulleys=False)), MESHES, 12, most_elements=256)
    assert [trial.agreement(model).status for model in trial.judged] == ["HOLDS", "HOLDS"]
    assert trial.causes == {}
    assert trial.fem_uncertainty <= 1e-5
    assert np.abs(trial.exact_error).max() < 1e-5  # measured 2e-7 at 64 elements
    assert verdict_lines(trial)[0].startswith("EXACT MODEL HOLDS")
    assert "serves as well" in verdict_lines(trial)[-1]


def test_pulleys_are_named_and_the_exact_model_holds():
    trial = verify(at_home(box()), MESHES, 12, criteria=COARSE)
    assert trial.judged[0] == "exact"
    assert trial.agreement("exact").status == "HOLDS"
    assert trial.agreement("dsm").status == "DOES NOT HOLD"
    assert effects(trial) == ["pulleys"]
    assert trial.causes["dsm"][0].error < 1e-3  # measured 4e-4, of 1.9e-2 with pulleys
    said = verdict_lines(trial)
    assert "Cause: pulleys" in said[1]
    assert "the closed form has no pulleys" in said[-1]


def test_pulleys_so_small_that_they_change_nothing_are_not_named():
    """The twin: the cause is measured, not read off the file."""
    robot = box(pulleys=False)
    tiny = replace(robot, pulleys=tuple(Pulley(1e-5, np.array([0.0, 0.0, 1.0])) for _ in robot.cables))
    trial = verify(at_home(tiny), MESHES, 12, criteria=replace(COARSE, relative_error=2e-4), judged=("dsm",))
    assert trial.agreement("dsm").status == "DOES NOT HOLD"
    assert "pulleys" not in effects(trial)


def test_weight_along_the_chord_is_named_in_a_facade_with_heavy_cables():
    """Lower cables pull with 500 N at 56 degrees and weigh 146 N; the closed form takes their tension as constant."""
    trial = verify(at_home(facade(500.0)), MESHES, 8, criteria=COARSE)
    assert effects(trial) == ["along_weight"]
    assert trial.causes["dsm"][0].error < 0.5 * np.abs(trial.relative_error).max()  # measured 0.26 % of 1.17 %


def test_inertia_along_the_chord_is_named_for_a_light_platform():
    """The stretch mode of 5 kg on eight cables of 0.1 kg."""
    strict = replace(COARSE, relative_error=2e-3)
    trial = verify(at_home(box(pulleys=False, mass=5.0)), MESHES, 36, criteria=strict, judged=("dsm",))
    assert effects(trial) == ["axial_inertia"]
    assert trial.causes["dsm"][0].error < 1e-3  # of 5.3e-3


def test_stretch_is_named_for_soft_cables():
    robot = load_robot("thesis-3-1")
    soft = replace(robot, cables=tuple(replace(cable, axial_stiffness=6000.0) for cable in robot.cables))
    trial = verify(at_home(soft), MESHES, 6, criteria=COARSE)
    assert effects(trial) == ["static_strain"]


def test_sag_is_named_where_nothing_else_accounts_for_the_error():
    """Lower cables that hang: with a tension of a third of their weight no other effect matters as much."""
    trial = verify(at_home(facade(0.0, 5e6, 0.4)), MESHES, 12, criteria=COARSE)
    assert effects(trial)[-1] == SAG
    assert trial.agreement("dsm").status == "DOES NOT HOLD"
    assert "--lower-bound" in verdict_lines(trial)[-1]


def test_the_geometric_term_is_named_where_the_thesis_assembly_leaves_it_out():
    point = at_home(load_robot("six-cable-4mm"))
    trial = verify(point, MESHES, 8, "thesis", COARSE)
    assert effects(trial, "exact") == ["geometric_term"]
    assert "geometric_term" in effects(trial, "dsm")
    assert trial.causes["exact"][0].error < 1e-6  # without it, the same model twice


def test_the_fem_stops_at_the_most_elements_and_says_so(thesis_point):
    trial = verify(thesis_point, MESHES, 8, criteria=Criteria(exact_error=1e-7), most_elements=64)
    assert trial.elements == (8, 16, 32, 64)
    found = trial.agreement("exact")
    assert found.status == "NOT DECIDED"
    assert "has not converged with 64 elements per cable" in found.undecided
    assert "--most-elements" in verdict_lines(trial)[-1]


def test_the_fem_does_not_refine_beyond_what_is_asked_for(thesis_point):
    mass_of_platform = platform_mass_matrix(thesis_point.entered, thesis_point.rotation)
    size = 6 + 3 * len(thesis_point.entered.cables) * (MESHES[0] - 1)
    mass = np.eye(size)
    mass[:6, :6] = mass_of_platform
    found = refined_fem(thesis_point, MESHES, 1280, 6, mass, 1e-2, lambda _: None)
    assert found.elements == MESHES
    assert found.uncertainty <= 1e-2


def agreement(**changes) -> Agreement:
    limit = np.array([1.0, 2.0, 3.0])
    given = {
        "model": "exact", "criteria": Criteria(), "hertz": limit * (1.0 + 1e-6), "limit": limit,
        "uncertainty": 1e-6 * limit, "assurance": np.ones(3), "certified": True, "elements": 80, "neutral": 0,
        "fem_neutral": 0,
    }  # fmt: skip
    return Agreement(**given | changes)


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({}, "HOLDS"),
        ({"hertz": np.array([1.0, 2.001, 3.0])}, "DOES NOT HOLD"),
        ({"hertz": np.array([1.0, 2.001, 3.0]), "model": "dsm"}, "HOLDS"),
        ({"hertz": np.array([1.0, 2.1, 3.0]), "model": "dsm"}, "DOES NOT HOLD"),
        ({"uncertainty": np.array([1e-6, 1e-4, 1e-6])}, "NOT DECIDED"),
        ({"uncertainty": np.array([1e-6, 1e-4, 1e-6]), "model": "dsm"}, "HOLDS"),
        ({"uncertainty": np.array([1e-6, 1e-4, 1e-6]), "hertz": np.array([1.0, 2.1, 3.0])}, "DOES NOT HOLD"),
        ({"assurance": np.array([1.0, 0.4, 1.0])}, "DOES NOT HOLD"),
        ({"certified": False}, "DOES NOT HOLD"),
        ({"fem_neutral": 1}, "DOES NOT HOLD"),
    ],
)
def test_a_model_holds_only_if_every_criterion_is_met(changes, status):
    found = agreement(**changes)
    assert found.status == status
    assert bool(found.objections) == (status != "HOLDS")


def test_only_what_a_model_lacks_is_tried():
    point = at_home(box())
    assert neglected(point, "exact", "consistent") == ()
    assert neglected(point, "exact", "thesis") == ("geometric_term",)
    assert neglected(point, "dsm", "consistent") == ("pulleys", *CABLE_EFFECTS)
    assert neglected(at_home(box(pulleys=False)), "dsm", "consistent") == CABLE_EFFECTS


def test_inertia_along_the_cable_changes_no_static_stiffness(thesis_point):
    """Polynomials of order 24 give the catenary's static stiffness to nine digits of EA / L."""
    without = expansion_without(thesis_point, frozenset({"axial_inertia"}), 24)
    exact = expansion_without(thesis_point, frozenset(), 24)
    stiffness = [found.stiffness(np.zeros(8)) for found in (without, exact)]
    assert np.abs(stiffness[0] - stiffness[1]).max() < 1e-9 * np.abs(stiffness[1]).max()
    in_plane = 1  # the second of the two first ones, raised by the stretch
    assert (without.omega_squared[:, in_plane] > exact.omega_squared[:, in_plane]).all(), "less mass, higher frequency"


def test_effects_that_are_not_there_change_nothing():
    """Nearly weightless cables without strain: every switch is off as it is, to the size of what is left."""
    robot = box(pulleys=False)
    light = tuple(replace(c, axial_stiffness=1e9, linear_density=1e-6, force_min=100.0) for c in robot.cables)
    point = at_home(replace(robot, cables=light))
    first = expansion_without(point, frozenset(), 20).omega_squared[:, :4]
    for effect in ("static_strain", "along_weight"):
        found = expansion_without(point, frozenset({effect}), 20).omega_squared[:, :4]
        np.testing.assert_allclose(found, first, rtol=1e-5)  # strain 2e-7, weight over tension 4e-7
