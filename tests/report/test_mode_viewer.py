"""The points that a page of modes sends are those of the model, and the independent FEM agrees with them."""

import base64
import gzip
import json
import re

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.crosscheck.mode_motion import POINTS_PER_HALF_WAVE, mode_motion
from cdpr_struct.crosscheck.mode_pairing import modal_assurance, pair_modes, shared_subspace
from cdpr_struct.crosscheck.robot_modes import robot_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_mass_matrix
from cdpr_struct.reports.mode_viewer import FULL_SCALE, viewer_markup
from cdpr_struct.robot.robot import anchors_in_world

ROUNDING = 0.5 / FULL_SCALE
BOX = "examples/box-robot/robot.toml"  # with pulleys


def sent(page: str) -> tuple[dict, np.ndarray, list[np.ndarray]]:
    """What the script of the page reads: the robot, cables at rest (m, p, 3), and shapes (m, p', 3) of every mode."""
    robot = json.loads(re.search(r'class="mv-robot">(.*?)</script>', page, re.DOTALL)[1])
    packed = re.search(r'class="mv-shapes">(.*?)</script>', page, re.DOTALL)[1]
    data = gzip.decompress(base64.b64decode(packed))
    m, p = robot["cables"], robot["points"]
    rest, place, shapes = np.frombuffer(data, "<f4", 3 * m * p).reshape(m, p, 3), 12 * m * p, []
    for mode in robot["modes"]:
        count = (p - 1) // mode["stride"] + 1
        shapes.append(np.frombuffer(data, "<i2", 3 * m * count, place).reshape(m, count, 3) / FULL_SCALE)
        place += 6 * m * count
    assert place == len(data)
    return robot, rest, shapes


def made(robot: str, count: int):
    found = cs.modes(robot, count=count)
    return found, *sent(viewer_markup(found.point, found.answer, found.motion))


@pytest.fixture(scope="module", params=["thesis-3-1", "cogiro", BOX])
def page(request):
    return made(request.param, 40)


def test_platform_ends_of_the_cables_move_with_the_platform_and_the_largest_component_is_one(page):
    found, robot, _, shapes = page
    _, arms = anchors_in_world(found.point.robot, found.point.position, found.point.rotation)
    for mode, shape in zip(robot["modes"], shapes, strict=True):
        moved = np.array(mode["platform"])
        np.testing.assert_allclose(shape[:, -1], moved[:3] + np.cross(moved[3:], arms), rtol=0, atol=ROUNDING + 2e-5)
        largest = max(np.abs(shape).max(), np.abs(moved).max())
        assert largest == pytest.approx(1.0, abs=0.01)  # every stride-th point only
        ends = np.linalg.norm(moved[:3] + np.cross(moved[3:], arms), axis=1)
        assert mode["reach"] == pytest.approx(max(np.linalg.norm(shape, axis=2).max(), ends.max()), rel=0.01)


def test_frame_ends_are_at_rest_unless_they_are_on_pulleys(page):
    found, _, _, shapes = page
    still = all((shape[:, 0] == 0.0).all() for shape in shapes)
    assert still != found.point.arrays.has_pulleys


def test_points_are_the_models_shapes(page):
    found, robot, _, shapes = page
    fractions = np.linspace(0.0, 1.0, robot["points"])
    exact = found.modes.cable_motion(fractions)
    for k, shape in enumerate(shapes):
        own = exact[k][:, :: robot["modes"][k]["stride"]]
        scale = (found.modes.platform[k] @ found.motion.platform[k]) / (found.motion.platform[k] ** 2).sum()
        assert np.abs(own / scale - shape).max() < 1.01 * ROUNDING
        np.testing.assert_allclose(found.motion.platform[k] * scale, found.modes.platform[k], rtol=1e-9, atol=1e-12)


def test_every_mode_has_enough_points_for_its_waves(page):
    """Counted in the shape itself: sign changes of each component along a cable, the end's motion taken off."""
    _, _, _, shapes = page
    for shape in shapes:
        count = shape.shape[1]
        line = np.linspace(0.0, 1.0, count)[:, None]
        wave = shape - shape[:, :1] - line * (shape[:, -1:] - shape[:, :1])
        wave = np.where(np.abs(wave) > 0.05 * np.abs(wave).max(), wave, 0.0)
        for curve in np.moveaxis(wave, 2, 1).reshape(-1, count):
            signs = np.sign(curve[curve != 0.0])
            half_waves = 1 + int((signs[1:] != signs[:-1]).sum())
            assert count - 1 >= POINTS_PER_HALF_WAVE * half_waves


def test_cables_at_rest_hang_from_the_frame_to_the_platform(page):
    found, robot, rest, _ = page
    platform, _ = anchors_in_world(found.point.robot, found.point.position, found.point.rotation)
    np.testing.assert_allclose(rest[:, -1], platform, atol=1e-5)
    np.testing.assert_allclose(rest[:, 0], platform - found.point.cables.offset, atol=1e-5)
    if not found.point.arrays.has_pulleys:
        assert robot["wheels"] == []
        return
    wheels = np.array(robot["wheels"])
    exits = np.linalg.norm(wheels - rest[:, :1], axis=2).min(axis=1)
    assert exits.max() < 0.15 * found.point.arrays.pulley_radius.max()  # on the rim, between two of its 25 points
    np.testing.assert_allclose(wheels[:, 0], robot["anchors"], atol=1e-5)


def test_shapes_are_those_of_the_independent_fem():
    """Modal assurance in the cables' own mass; nearly double modes as subspaces."""
    found = cs.modes("thesis-3-1", count=24)
    point, stations = found.point, np.linspace(0.0, 1.0, 41)
    fem = robot_modes(point, "fem", 30, elements=80)
    vectors = []
    for modes in (found.modes, fem):
        motion = modes.cable_motion(stations)[:, :, 1:-1]
        vectors.append(np.concatenate([modes.platform, motion.reshape(len(motion), -1)], axis=1))
    pieces = np.repeat(point.robot.linear_density * point.cables.length / 40, 3 * 39)
    mass = np.diag(np.concatenate([np.zeros(6), pieces]))
    mass[:6, :6] = platform_mass_matrix(point.robot, point.rotation)
    assurance = modal_assurance(*vectors, mass)
    partner = pair_modes(assurance, found.modes.hertz, fem.hertz)
    assert shared_subspace(assurance, fem.hertz, partner).min() > 0.999
    wrong = modal_assurance(vectors[0] * np.r_[np.ones(6), -np.ones(len(mass) - 6)], vectors[1], mass)
    moving = found.modes.platform_energy > 0.02
    assert shared_subspace(wrong, fem.hertz, partner)[moving].min() < 0.999


def test_a_high_mode_is_drawn_finely_and_a_low_one_coarsely():
    point = cs.modes("thesis-3-1", count=1).point
    motion = mode_motion(point, robot_modes(point, "exact", 150))
    assert motion.stride[0] > motion.stride[-1] == 1
    assert (len(motion.fractions) - 1) % motion.stride.max() == 0


def test_massless_cables_move_in_straight_lines():
    found = cs.modes("thesis-3-1", model="static")
    _, _, shapes = sent(viewer_markup(found.point, found.answer, found.motion))
    for shape in shapes:
        line = np.linspace(0.0, 1.0, shape.shape[1])[:, None]
        np.testing.assert_allclose(shape, line * shape[:, -1:], atol=2 * ROUNDING)


def test_the_page_holds_every_mode_and_the_script_reads_what_is_there():
    page = str(cs.modes("thesis-5", count=3).files()["report.html"])
    robot, _, shapes = sent(page)
    assert len(shapes) == len(robot["modes"]) == 3
    script = page[page.rindex("// Moves the robot in its modes") :]
    for name in set(re.findall(r'inside\("\.([\w-]+)"\)', script)):
        assert f'class="{name}"' in page, name


def test_sixty_modes_of_eight_cables_stay_small():
    page = str(cs.modes("thesis-3-1", count=60).files()["report.html"])
    assert len(page.encode()) < 4e6
