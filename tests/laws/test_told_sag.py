"""Slack cables, deep sag and unstable poses are told by every result that holds a pose."""

import numpy as np
import pytest

import cdpr_struct as cs
from cdpr_struct.errors import CdprError, UnstableEquilibriumError
from cdpr_struct.statics.slack_cables import DEEP
from tests.fast_like import fast_like
from tests.random_robots import random_positions, random_robot


def test_deep_sag_is_told_with_cable_sag_and_tension():
    found = cs.inverse("six-cable-8mm", [0.0, 0.0, 0.5], mass=10.0)
    cables = found.solution.cables
    deep = np.flatnonzero(cables.sag > DEEP * cables.chord) + 1
    told = found.answer["sagging_cables"]
    assert deep.size
    assert [one["cable"] for one in told] == deep.tolist()
    first = told[0]
    i = first["cable"] - 1
    assert first["sag_over_chord"] == pytest.approx(cables.sag[i] / cables.chord[i])
    weight = cables.weight[i] * cables.length[i]
    assert first["tension_over_weight"] == pytest.approx(cables.tension[i] / weight)
    assert any(f"cable {deep[0]} by" in sentence for sentence in found.warnings)
    assert cs.audit("six-cable-8mm", [0.0, 0.0, 0.5], mass=10.0).answer["sagging_cables"] == told


def test_taut_cables_are_not_told():
    assert cs.inverse("cogiro").answer["sagging_cables"] == []
    assert cs.inverse(fast_like(), free="rx,ry,rz").answer["sagging_cables"] == []


def test_unstable_poses_are_told_as_modes_refuses_them():
    rng, seen = np.random.default_rng(5), set()
    for _ in range(12):
        robot = random_robot(rng)
        for position in random_positions(rng, robot, 2):
            try:
                found = cs.inverse(robot, position)
            except CdprError:
                continue
            try:
                cs.modes(robot, position, count=1, model="static")
                stable = True
            except UnstableEquilibriumError:
                stable = False
            assert found.answer["stable"] == stable
            assert any("unstable equilibrium" in sentence for sentence in found.warnings) == (not stable)
            seen.add(stable)
    assert seen == {True, False}
