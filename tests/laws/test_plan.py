"""What a plan promises: against simulated data, against campaigns that were extended as proposed, and plain laws."""

from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.stats import chi2

from cdpr_struct.diagnosis.detectable_sizes import plainest
from cdpr_struct.generated.platform import rotation
from cdpr_struct.hypotheses.causes.library import testable as causes_for
from cdpr_struct.hypotheses.detectable import FALSE_ALARMS, POWER, noncentrality
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.inference.screening import Screen
from cdpr_struct.measurement.campaign import CableFrequencies, Campaign, RobotFrequencies, States
from cdpr_struct.measurement.loss import Loss
from cdpr_struct.planning.campaign_plan import confusions, planned
from cdpr_struct.planning.candidates import at_the_center_of, at_the_robot, checks
from cdpr_struct.planning.checks import CHECKS, Check, check_rows
from cdpr_struct.planning.information import Numbers, of_causes
from cdpr_struct.planning.measurements import joined, proposed
from cdpr_struct.planning.planned_rows import PlannedRows
from cdpr_struct.planning.separations import WIDE, Separator, Sized
from cdpr_struct.reports.plan.measurements import CHECKS as CHECK_TEXTS
from cdpr_struct.reports.plan.measurements import measurement_text
from cdpr_struct.residuals.assembled import linear_model, stacked
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.recorded import recorded
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.robot.tolerances import Tolerances
from cdpr_struct.statics.inverse_kinematics import inverse

PAIRS = [
    ("platform_mass", "joint_mass"),
    ("joint_mass", "platform_mass"),
    ("load_cell_gain", "pulley_friction"),
    ("frame_anchor_position", "tracker_frame"),
    ("axial_stiffness", "joint_compliance"),
    ("cable_linear_density", "load_cell_gain"),
    ("dead_length", "joint_compliance"),
]


def clean_campaign(count: int = 4) -> Campaign:
    """Static states of the robot as entered, all approached from one side."""
    robot, generator = load_robot("cogiro"), np.random.default_rng(1)
    m = len(robot.cables)
    position = robot.home.position + generator.uniform(-1.0, 1.0, (count, 3)) * [2.0, 1.5, 0.8]
    angles = np.radians(generator.uniform(-10.0, 10.0, (count, 3)))
    payload = np.resize([0.0, 20.0, 40.0], count)
    held = [inverse(robot.with_load(w), p, rotation(*a)) for w, p, a in zip(payload, position, angles, strict=True)]
    states = States(
        names=tuple(f"s{i}" for i in range(count)), position=position, angles=angles,
        sigma_position=np.full(count, 5e-4), sigma_rotation=np.full(count, 3.5e-4), payload=payload,
        tension=np.array([h.tensions for h in held]), tension_sigma=np.full((count, m), 2.0),
        length=np.array([h.lengths for h in held]), length_sigma=np.full((count, m), 5e-4), lock=np.arange(count),
        loaded=np.zeros(count, dtype=bool), static=np.ones(count, dtype=bool), temperature=np.full(count, np.nan),
        approach=np.ones((count, m)), time=np.full(count, np.nan),
    )  # fmt: skip
    cables = CableFrequencies(*(np.zeros(0, dtype=t) for t in (int, int, int, bool, float, float)))
    peaks = RobotFrequencies(*(np.zeros(0, dtype=t) for t in (int, float, float)))
    return Campaign("clean", robot, "cogiro", "dsm", Tolerances(), frozenset(), states, cables, peaks)


def numbers_of(data, backwards=False) -> Numbers:
    """Of all causes that new states show, too."""
    seen = seen_in(data)
    causes = [cause for cause in causes_for(seen, {})[0] if cause.carrier != "state"]
    return Numbers.of(data.cables, causes[::-1] if backwards else causes, seen)


@pytest.fixture(scope="module")
def data():
    return recorded(clean_campaign())


@pytest.fixture(scope="module")
def numbers(data):
    return numbers_of(data)


@pytest.fixture(scope="module")
def rows(data, numbers):
    return PlannedRows.of(data, numbers, {})


@pytest.fixture(scope="module")
def separator(rows, numbers):
    information = rows.information()
    gram = of_causes(information, numbers.tolerances)
    sized = {name: Sized.detectable(numbers, name, gram, WIDE) for pair in PAIRS for name in pair}
    return Separator(numbers, information, sized, PAIRS, np.zeros((numbers.count, 0)))


@pytest.fixture(scope="module")
def candidates(data, numbers):
    return [*checks(data, numbers), *at_the_robot(data, numbers)]


@pytest.fixture(scope="module")
def gains(separator, candidates):
    before = separator.nats()
    return [separator.gain(what, more, before) for what, more in candidates]


def of(gains, text):
    """Separations by pair of the best measurement whose words hold a text."""
    found = max((g for g in gains if text in measurement_text(g.measurement)), key=lambda g: g.nats)
    return {(s.cause, s.rival): s for s in found.separations}


@pytest.mark.parametrize("name", ["platform_mass", "load_cell_gain", "drum_scale"])
def test_a_detectable_size_is_found_as_often_as_promised(rows, data, numbers, name):
    """Draws of noise and tolerances with the cause of this size, judged by the score that screening computes."""
    where, columns = layout(data), numbers.pattern(name, plainest(numbers.patterns[name]))
    model, generator = linear_model(rows.local, where), np.random.default_rng(7)
    own = [part @ columns for part in stacked(where, rows.causes)]
    gram = of_causes(rows.information(), numbers.tolerances)
    size = np.sqrt(noncentrality(1) / (columns.T @ gram @ columns)[0, 0])
    found, draws = 0, 300
    for _ in range(draws):
        z = generator.standard_normal(model.parameters)
        r = [
            np.einsum("knq,kq->kn", s.A, generator.standard_normal(s.A[:, 0].shape))
            + s.floor * generator.standard_normal(s.floor.shape)
            + s.X @ z
            + part[..., 0] * size
            for s, part in zip(model.stacks, own, strict=True)
        ]
        said = Screen.of(model.with_residual(r), NoiseState.stated(model.groups)).screened(own)
        found += said.score[0] ** 2 / said.gram[0, 0] > chi2.isf(FALSE_ALARMS, 1)
    assert found / draws == pytest.approx(POWER, abs=3.0 * np.sqrt(POWER * (1.0 - POWER) / draws))


def extended(old: Campaign, new: Campaign, chosen: tuple[int, ...]) -> Campaign:
    """A campaign with some states of another one, and the frequencies there."""
    index, start = np.array(chosen), len(old.states.names)
    parts = {f.name: getattr(new.states, f.name) for f in fields(States)}
    some = States(**{n: tuple(v[i] for i in chosen) if n == "names" else v[index] for n, v in parts.items()})
    lock = np.where(some.lock >= 0, some.lock + old.states.lock.max() + 1, -1)
    cables, peaks = new.cable_frequencies, new.robot_frequencies
    cables = CableFrequencies(*(getattr(cables, f.name)[np.isin(cables.state, index)] for f in fields(cables)))
    kept = np.isin(peaks.state, index)
    return replace(
        old,
        states=joined(old.states, replace(some, lock=lock)),
        cable_frequencies=replace(cables, state=start + np.searchsorted(index, cables.state)),
        robot_frequencies=RobotFrequencies(
            start + np.searchsorted(index, peaks.state[kept]), peaks.hertz[kept], peaks.sigma[kept]
        ),
    )


@pytest.mark.parametrize("kind", ["approach", "payload", "locked", "tilts", "cable_frequencies", "robot_frequencies"])
def test_a_measurement_adds_what_was_promised(data, numbers, separator, candidates, kind):
    """Against the campaign with these states in it, linearised as a whole."""
    found = proposed(data.campaign)
    what, states = next((what, states) for what, states in found.measurements if what.kind == kind)
    more = next(more for other, more in candidates if other.kind == kind)
    whole = at_the_center_of(data, extended(data.campaign, found.campaign, states))
    anew = replace(separator, information=PlannedRows.of(whole, numbers, {}).information())
    promised = separator.nats(more)
    assert (promised > separator.nats() + 0.05).any(), what
    np.testing.assert_allclose(promised, anew.nats(), rtol=1e-6, atol=1e-6)


def test_the_order_of_states_and_causes_changes_nothing(data, rows, numbers):
    campaign, order = data.campaign, np.array([2, 0, 3, 1])
    parts = {f.name: getattr(campaign.states, f.name) for f in fields(States)}
    states = States(**{n: tuple(v[i] for i in order) if n == "names" else v[order] for n, v in parts.items()})
    other = recorded(replace(campaign, states=states))
    backwards = numbers_of(other, backwards=True)
    again = PlannedRows.of(other, backwards, {}).information()
    first = confusions(numbers, of_causes(rows.information(), numbers.tolerances), Loss())
    second = confusions(backwards, of_causes(again, backwards.tolerances), Loss())
    assert len(first) > 3
    assert {(c.cause, c.taken_for) for c in first} == {(c.cause, c.taken_for) for c in second}
    nats = {(c.cause, c.taken_for): c.nats for c in second}
    np.testing.assert_allclose([nats[c.cause, c.taken_for] for c in first], [c.nats for c in first], rtol=1e-5)


def test_information_of_states_adds_up(rows, data):
    parts = [rows.information([i]) for i in range(data.states)]
    whole = rows.information()
    np.testing.assert_allclose(sum(parts), whole, rtol=1e-9, atol=1e-9 * np.abs(whole).max())


def test_no_measurement_makes_causes_harder_to_tell_apart(separator, candidates):
    before = separator.nats()
    assert len(candidates) >= len(CHECKS) + 15
    for what, more in candidates:
        assert (separator.nats(more) >= before * (1.0 - 1e-6) - 1e-6).all(), measurement_text(what)


def test_a_check_too_coarse_to_see_anything_is_worth_nothing(data, numbers, separator):
    for check in CHECKS:
        blind = Check(check.name, 1e9 * check.sigma, check.reads, check.apart, check.cause)
        seen = check_rows(data.arrays, data.campaign.tolerances, numbers, blind)
        np.testing.assert_allclose(separator.nats(seen.T @ seen), separator.nats(), atol=1e-6, err_msg=check.name)


def test_what_a_person_would_do_is_found(gains):
    """Weighing tells platform from joints; the other side tells friction from gain, which one side cannot at all."""
    weighed = of(gains, "weigh the platform")
    assert weighed["platform_mass", "joint_mass"].after > 5.0 > 3.0 > weighed["platform_mass", "joint_mass"].before
    friction = of(gains, "again, approached from the other side")["load_cell_gain", "pulley_friction"]
    assert friction.before < 1.0
    assert friction.after > 5.0
    tracked = of(gains, "survey the frame anchors")["frame_anchor_position", "tracker_frame"]
    assert tracked.after > tracked.before + 3.0


def test_a_clamp_tells_what_lies_behind_it_from_what_does_not(gains):
    """Loads on clamped cables; the same loads on free ones, and all other states, see a compliance and no more."""
    pair = ("dead_length", "joint_compliance")
    clamped = of(gains, "clamp the cables")[pair]
    assert clamped.after > clamped.before + 3.0
    for gain in gains:
        if gain.measurement.kind != "clamped" and gain.measurement.check not in ("joint_compliance", "axial_stiffness"):
            (seen,) = [s for s in gain.separations if (s.cause, s.rival) == pair]
            assert seen.after < seen.before + 0.3, measurement_text(gain.measurement)


def test_a_check_leaves_alone_what_it_does_not_read(gains):
    weighed = of(gains, "weigh the joints")["load_cell_gain", "pulley_friction"]
    assert weighed.after == pytest.approx(weighed.before, abs=0.05)


def test_states_of_a_preloaded_robot_are_proposed_within_its_lower_bound():
    """With the least tensions of all, some of its cables would hang slack nearly everywhere."""
    robot, campaign = load_robot("thesis-5"), clean_campaign(2)
    home = np.tile(robot.home.position, (2, 1))
    states = replace(campaign.states, position=home, angles=np.zeros((2, 3)), payload=np.zeros(2))
    found = proposed(replace(campaign, robot=robot, states=states, lower_bound=150.0))
    kinds = {what.kind for what, _ in found.measurements}
    assert {"pose", "payload", "locked", "poses", "payloads", "clamped"} <= kinds
    static = found.campaign.states.static
    assert (found.campaign.states.tension[static] > 149.0).all()


def test_a_plan_ranks_the_best_of_each_family():
    plan = planned(clean_campaign(2))
    worth, families = [g.nats for g in plan.gains], [g.measurement.family for g in plan.gains]
    assert worth == sorted(worth, reverse=True)
    assert len(set(families)) == len(families)
    assert {row.cause for row in plan.confusable} >= {"joint_mass", "platform_mass"}
    assert not plan.detectable.keys() & plan.not_testable.keys()


def test_every_check_has_words():
    assert list(CHECK_TEXTS) == [check.name for check in CHECKS]


def test_a_check_reads_parameters_or_a_cause():
    with pytest.raises(ValueError, match="either reads or cause"):
        Check("nothing", 1.0)
    with pytest.raises(ValueError, match="must be positive"):
        Check("exact", 0.0, cause="temperature")
