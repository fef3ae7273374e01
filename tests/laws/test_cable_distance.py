"""Distances of sagging cables: against sampled curves, against the FEM's shape, and what an anchor zone leaves out."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.fem_reference.cable import CableData
from cdpr_struct.fem_reference.cable_statics import solve_cable
from cdpr_struct.robot.body import Body
from cdpr_struct.robot.robot import anchors_in_world
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_curves import CableCurves
from cdpr_struct.statics.cable_distance import CLOSE, body_distance, cable_distance, segment_distance
from cdpr_struct.statics.inverse_kinematics import inverse

SAMPLES = 300
BODIES = (
    Body("box", "platform", "box", np.array([0.8, 0.5, 0.4]), np.array([0.0, 0.0, 0.7])),
    Body("post", "frame", "cylinder", np.array([0.5, 0.5, 4.0]), np.array([2.0, 2.0, 2.0])),
    Body("ball", "frame", "sphere", np.array([0.6, 0.6, 0.6]), np.array([-2.0, 1.0, 3.0])),
)


@pytest.fixture(scope="module", params=["thesis-3-1", "cogiro"])
def hanging(request):
    """Curves of held poses, number of cables, positions and rotations; cogiro's lower cables sag by half a metre."""
    robot = load_robot(request.param)
    rng = np.random.default_rng(3)
    position = rng.uniform((-2.0, -2.0, 0.5), (2.0, 2.0, 2.0), (30, 3))
    found = inverse(robot, position, np.eye(3), allow_unheld=True)
    good = np.flatnonzero(found.held)[:10]
    turned = np.broadcast_to(np.eye(3), (len(good), 3, 3))
    anchors = anchors_in_world(robot, position[good], turned)[0]
    return CableCurves.of(found.cables.at(good), anchors), len(robot.cables), (position[good], turned)


def sampled(curves: CableCurves, cables: int) -> np.ndarray:
    """(n, m, SAMPLES, 3) points on the cables."""
    shares = np.linspace(0.0, 1.0, SAMPLES)
    points = [curves.points(np.full(len(curves.length), share)) for share in shares]
    return np.stack(points, axis=1).reshape(-1, cables, SAMPLES, 3)


def test_cable_distance_is_that_of_sampled_curves(hanging):
    """Sampling can only find more; segments between samples find less by no more than the sag of a segment."""
    curves, m, _ = hanging
    near, points = cable_distance(curves, m, 0.0), sampled(curves, m)
    assert len(points) >= 8
    for pose, cables in enumerate(points):
        least = np.inf
        for i in range(m):
            for j in range(i):
                gap = np.linalg.norm(cables[i][:, None] - cables[j][None], axis=-1)
                a, b = np.unravel_index(gap.argmin(), gap.shape)
                a, b = np.clip((a, b), 1, SAMPLES - 2)
                for c in (a - 1, a):
                    for d in (b - 1, b):
                        ends = (cables[i][[c]], cables[i][[c + 1]], cables[j][[d]], cables[j][[d + 1]])
                        least = min(least, segment_distance(*ends)[0])
        assert near.distance[pose] == pytest.approx(least, abs=2.0 * CLOSE)


def test_body_distance_is_that_of_sampled_curves(hanging):
    curves, m, (position, turned) = hanging
    near, points = body_distance(curves, m, BODIES, (position, turned), 0.0), sampled(curves, m)
    step = float(np.max(curves.length)) / (SAMPLES - 1)
    for pose, cables in enumerate(points):
        own = cables - position[pose]
        least = min(float(body.distance(own if body.fixed_to == "platform" else cables).min()) for body in BODIES)
        assert near.distance[pose] <= least + CLOSE
        rest = step**2 / (8.0 * max(least, step))  # what a straight cable may come closer between two samples
        assert near.distance[pose] >= least - max(rest, 0.5 * step if least < step else 0.0) - CLOSE


def test_segments_match_brute_force():
    rng = np.random.default_rng(1)
    ends = rng.normal(size=(4, 200, 3))
    ends[3, :20] = ends[2, :20] + 2.0 * (ends[1, :20] - ends[0, :20])  # parallel
    s, t = np.meshgrid(*(np.linspace(0.0, 1.0, 101),) * 2)
    a, b, c, d = (end[:, None, None] for end in ends)
    gap = np.linalg.norm(a + s[..., None] * (b - a) - c - t[..., None] * (d - c), axis=-1).min(axis=(1, 2))
    found = segment_distance(*ends)
    assert (found <= gap + 1e-12).all()
    assert np.abs(found - gap).max() < 0.05


def test_shared_anchor_counts_from_its_zone_on():
    """Two straight cables from one anchor, 30 degrees apart: a zone r leaves 2 r sin 15 degrees."""
    angle = np.radians(30.0)
    heading = np.array([[1.0, 0.0, 0.0], [np.cos(angle), np.sin(angle), 0.0]])
    one = np.ones(2)
    up = np.tile([0.0, 0.0, 1.0], (2, 1))
    curves = CableCurves(np.zeros((2, 3)), heading, up, 100.0 * one, 0.0 * one, 5.0 * one, 1e9 * one, 0.0 * one)
    assert cable_distance(curves, 2, 0.0).distance[0] == pytest.approx(0.0, abs=CLOSE)
    assert cable_distance(curves, 2, 0.2).distance[0] == pytest.approx(0.4 * np.sin(0.5 * angle), abs=2.0 * CLOSE)


def test_anchors_are_shared_by_the_cables_of_one_pose_only():
    """Level cables a metre apart; then the first and the third from one anchor, as above, the second 3 m higher."""
    angle = np.radians(30.0)
    start = np.array([[0, 5, 0], [0, 6, 0], [0, 7, 0], [0, 1, 0], [0, 1, 3], [0, 1, 0]], dtype=float)
    heading = np.tile([1.0, 0.0, 0.0], (6, 1))
    heading[5] = np.cos(angle), np.sin(angle), 0.0
    one = np.ones(6)
    up = np.tile([0.0, 0.0, 1.0], (6, 1))
    curves = CableCurves(start, heading, up, 100.0 * one, 0.0 * one, 5.0 * one, 1e9 * one, 0.0 * one)
    found = cable_distance(curves, 3, 0.2).distance
    np.testing.assert_allclose(found, [1.0, 0.4 * np.sin(0.5 * angle)], atol=2.0 * CLOSE)


def test_fem_shape_gives_the_same_distance():
    """The referee's bar elements between the same ends, as segments: the catenary's distance within their size."""
    robot = load_robot("thesis-3-1")
    position = np.array([[2.7, -2.82, 0.72]])  # two cables cross there, between their ends
    found = inverse(robot, position, np.eye(3))
    anchors = anchors_in_world(robot, position, np.eye(3)[None])[0]
    curves, m = CableCurves.of(found.cables, anchors), len(robot.cables)
    near = cable_distance(curves, m, 0.0)
    pair = int(near.first[0]), int(near.second[0])
    starts = anchors[0] - found.cables.offset[0]
    shapes = [fem_points(curves, i, starts[i], anchors[0, i]) for i in pair]
    a, b = (np.repeat(shapes[0][:-1], len(shapes[1]) - 1, axis=0), np.repeat(shapes[0][1:], len(shapes[1]) - 1, axis=0))
    c, d = (np.tile(shapes[1][:-1], (len(shapes[0]) - 1, 1)), np.tile(shapes[1][1:], (len(shapes[0]) - 1, 1)))
    referee = segment_distance(a, b, c, d).min()
    assert referee == pytest.approx(near.distance[0], abs=1e-4)
    wrong = cable_distance(replace(curves, weight=0.98 * curves.weight), m, 0.0)
    assert abs(wrong.distance[0] - referee) > 1e-3  # a weight off by 2 %


def fem_points(curves: CableCurves, number: int, start: np.ndarray, end: np.ndarray, elements: int = 400) -> np.ndarray:
    """(n + 1, 3) nodes of a cable of bars between the same ends, with the same unstrained length."""
    one = curves.take(np.array([number]))
    data = CableData(float(one.length[0]), float(one.axial_stiffness[0]), float(one.weight[0]) / 9.81)
    return solve_cable(data, start, end, elements).nodes
