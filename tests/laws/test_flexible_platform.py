"""A part of the platform on a mount, found by the peaks that belong to no mode of a rigid one (crime=True)."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cdpr_struct.diagnosis.diagnosing import Diagnosis, diagnosed
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.errors import UnstableEquilibriumError
from cdpr_struct.hypotheses.alternatives import offered
from cdpr_struct.hypotheses.causes import library
from cdpr_struct.hypotheses.hypothesis import Hypothesis, Part
from cdpr_struct.hypotheses.judge import WORTH, Judged, begun, judged
from cdpr_struct.hypotheses.scan import beginnings, mounts
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.hypotheses.significant import SIGNIFICANT, p_of_null
from cdpr_struct.measurement.campaign import Campaign, RobotFrequencies
from cdpr_struct.reports.diagnose.sentences import sentence
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.robot_writing import robot_toml
from tests.laws import written_campaigns
from tests.laws.written_campaigns import SIGMA_HERTZ, cogiro, extended, noisy, plan_of, vibrating_point, written

NAME, KILOGRAMS, HERTZ = "flexible_platform", 3.0, 5.0
CLEAR = 3.0  # nats of evidence times prior, before anything is fitted
SHAKEN, MODES, SHARE = (0, 1, 2), 50, 0.3


def _platform_peaks(robot, plan, states) -> RobotFrequencies:
    """Only those of modes that move the platform."""
    rows = []
    for i in plan.robot_in:
        found = certified_modes(vibrating_point(robot, states[i]), "exact", plan.modes)
        rows += [(i, f) for f in found.frequencies.hertz[found.shapes.platform_energy > SHARE]]
    state, hertz = np.array(rows).T
    return RobotFrequencies(state.astype(int), hertz, SIGMA_HERTZ * hertz)


@cache
def campaign(kilograms: float) -> Campaign:
    """Of the thesis's robot with a part on a mount along x; a rigid one is entered."""
    robot = load_robot("thesis-3-1")
    part = {"internal_mass": kilograms, "internal_frequency": HERTZ, "internal_direction": [1.0, 0.0, 0.0]}
    plan = plan_of(robot, 4, robot_in=SHAKEN, modes=MODES)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(written_campaigns, "_shaken", _platform_peaks)
        return noisy(written(extended(robot, **part) if kilograms else robot, plan, robot), 1)


@cache
def found() -> Diagnosis:
    return diagnosed(campaign(KILOGRAMS))


def test_it_is_named_with_its_size():
    assert found().decision.classes == ((NAME,),)
    (size,) = found().sizes
    told = size.parameters
    mass, hertz = told["internal_mass_x"], told["internal_frequency"]
    assert abs(mass["value"] - KILOGRAMS) < 3.0 * mass["sigma"] < 1.0
    assert abs(hertz["value"] - HERTZ) < 3.0 * hertz["sigma"] < 0.1
    assert found().added > 5.0  # without the peaks of any one state, too


def test_a_rigid_platform_has_none():
    assert all(NAME not in names for names in diagnosed(campaign(0.0)).decision.classes)


@pytest.mark.slow
def test_a_line_of_the_mains_is_no_error_of_the_simulation():
    """Its frequency is the same at all poses; it is told, and the robot has none of it."""
    rigid = campaign(0.0)
    peaks, lines = rigid.robot_frequencies, 5.63 * np.array([1.001, 0.999, 1.0005])
    hertz = np.concatenate([peaks.hertz, lines])
    more = RobotFrequencies(np.concatenate([peaks.state, SHAKEN]), hertz, SIGMA_HERTZ * hertz)
    said = diagnosed(replace(rigid, robot_frequencies=more))
    assert said.decision.status == "adequate"
    assert [part.cause.name for part in said.chosen.hypothesis.parts] == ["steady_disturbance"]
    assert "Peaks near 5.63 Hz at all poses belong to no mode" in sentence(said)
    assert said.extended is None


def test_the_extended_robot_is_written_read_back_and_right(tmp_path):
    path = tmp_path / "extended.toml"
    path.write_text(robot_toml(found().extended, "extended"))
    again = load_robot(path)
    assert again.extensions.causes == (NAME,)
    assert again.extensions.entered == found().extended.extensions.entered
    right = replace(campaign(KILOGRAMS), robot=again)
    said = diagnosed(right)
    assert said.decision.status == "adequate"
    assert not [peak for peak in said.peaks.uncertain if peak.none > 0.5]
    assert said.not_testable[NAME] == "the robot file has an internal mass already"


def _on_a_mount():
    """The campaign as recorded, its layout, nothing wrong, and the cause along one axis."""
    data = recorded(campaign(KILOGRAMS))
    where = layout(data)
    cause = next(one for one in library.testable(seen_in(data), {})[0] if one.name == NAME)
    return data, where, judged(data, where, Hypothesis()), Part(cause, cause.patterns(seen_in(data))[0], 2.0)


def test_evidence_does_not_depend_on_the_start():
    """From both sides of the numbers that are found."""
    data, where, null, part = _on_a_mount()
    values = [
        begun(data, where, null, Hypothesis((part,)), np.array([root, hertz]) / part.term.sigma).log_evidence
        for root, hertz in ((1.5, 4.9), (1.9, 5.05), (2.0, 5.1))
    ]
    assert np.ptp(values) < WORTH  # nats: another start is not followed for less
    assert values[0] > null.log_evidence + 10.0


def test_a_fit_is_not_begun_where_a_cable_would_be_slack():
    """Its modes would take minutes, and are nobody's measurement."""
    data, where, null, part = _on_a_mount()
    start, z = null.likeliest(data, where), np.array([1.5, 4.9]) / part.term.sigma
    loose = np.zeros_like(start.noise)
    loose[0, 6] = (start.readings(data).tension[0, 0] - 0.1) / data.sigma[0, 6]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Judged, "likeliest", lambda *_: replace(start, noise=start.noise + loose))
        with pytest.raises(UnstableEquilibriumError, match="slack"):
            begun(data, where, null, Hypothesis((part,)), z)


def _known_of(some: Campaign):
    """A campaign as recorded, nothing wrong, and what each cause would change."""
    data = recorded(some)
    seen, where = seen_in(data), layout(data)
    null = judged(data, where, Hypothesis())
    return data, null, offered(data, where, seen, library.testable(seen, {})[0], null)


def test_parts_on_mounts_are_looked_for_where_they_suit_the_peaks():
    for kilograms, some in ((KILOGRAMS, True), (0.0, False)):
        data, null, menu = _known_of(campaign(kilograms))
        assert bool(mounts(data, menu, null)) == some
        assert not some or all(one.part.cause.tuned for one in mounts(data, menu, null))


def test_of_explained_peaks_only_what_nothing_else_shows_is_tried_at_large_sizes():
    data, null, menu = _known_of(campaign(0.0))
    assert null.lists is not None
    assert null.lists.left < 2.0
    assert {one.part.cause.name for one in beginnings(data, menu, null, 4)} == {"platform_inertia"}


def with_hidden_payload(share: float) -> Campaign:
    """A share of the platform on a cord of 0.25 m; peaks of its swing are not read, nor two thirds of the others."""
    hangs = {"swinging_mass": share * cogiro().platform.mass, "swinging_frequency": 1.0} if share else {}
    plan = plan_of(cogiro(), 8, robot_in=(0, 1, 2), modes=30)
    clean, rng = written(extended(cogiro(), **hangs), plan, cogiro()), np.random.default_rng(2)
    peaks = clean.robot_frequencies
    read = (peaks.hertz > 2.0) & (rng.random(peaks.hertz.size) < 0.35)
    some = RobotFrequencies(peaks.state[read], peaks.hertz[read], peaks.sigma[read])
    return noisy(replace(clean, robot_frequencies=some), 2)


@pytest.mark.parametrize(("share", "clear"), [(0.25, True), (0.0, False)])
def test_a_payload_that_swings_is_looked_for_where_no_linear_test_sees_it(share, clear):
    """Peaks near modes of the platform as entered explain themselves; those of three quarters of it are nearer."""
    data, null, menu = _known_of(with_hidden_payload(share))
    assert p_of_null(menu, null) > SIGNIFICANT
    own = [one.gain for one in mounts(data, menu, null) if one.part.cause.name == "swinging_payload"]
    assert (max(own, default=-np.inf) > CLEAR) == clear


@pytest.mark.slow
def test_a_payload_that_swings_is_found_where_no_linear_test_sees_it():
    said = diagnosed(with_hidden_payload(0.25))
    assert said.decision.classes == (("swinging_payload",),)


def test_a_check_bounds_the_mass_and_not_the_frequency():
    seen = seen_in(recorded(campaign(KILOGRAMS)))
    causes, _ = library.testable(seen, {NAME: 0.25})
    own = next(one for one in causes if one.name == NAME)
    *roots, hertz = own.parameters
    assert [p.prior for p in roots] == [0.5, 0.5, 0.5]
    assert [p.most for p in roots] == [2.0, 2.0, 2.0]  # four times what is left
    assert hertz.most == np.inf
    assert hertz.prior == library.LIBRARY[NAME].parameters[-1].prior * seen.highest > 1.0
