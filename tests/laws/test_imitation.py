"""One cause begins where it does what another one does; what means the same of the robot ends with the same evidence.

The same model writes and judges (crime=True).
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cdpr_struct.hypotheses.alternatives import Offered, offered
from cdpr_struct.hypotheses.causes import library
from cdpr_struct.hypotheses.hypothesis import Hypothesis
from cdpr_struct.hypotheses.imitation import alone, imitated
from cdpr_struct.hypotheses.judge import Judged, begun, judged
from cdpr_struct.hypotheses.seen import seen_in
from cdpr_struct.residuals.layout import Layout, layout
from cdpr_struct.residuals.recorded import Recorded, recorded
from tests.laws.written_campaigns import cogiro, extended, measured

COMPLIANCE = 8e-6  # m/N, of joints at all cables
NAMES = ("joint_compliance", "dead_length", "axial_stiffness")


@cache
def soft_joints() -> tuple[Recorded, Layout, Judged, list[Offered]]:
    """Readings of a robot with soft joints, nothing being wrong, and the causes that may do alike."""
    data = recorded(measured(extended(cogiro(), series_compliance=np.full(8, COMPLIANCE)), 3))
    where, seen = layout(data), seen_in(data)
    null = judged(data, where, Hypothesis())
    causes = [one for one in library.testable(seen, {})[0] if one.name in NAMES]
    menu = [one for one in offered(data, where, seen, causes, null) if one.cause.name in NAMES]
    return data, where, null, menu


def part_of(name: str, label: str = "all alike"):
    *_, menu = soft_joints()
    own = next(one for one in menu if one.cause.name == name)
    return own.part([pattern.label for pattern in own.patterns].index(label), 2.0)


@cache
def best() -> Judged:
    data, where, null, _ = soft_joints()
    part = part_of("joint_compliance")
    return begun(data, where, null, Hypothesis((part,)), np.array([COMPLIANCE]) / part.term.sigma)


def test_a_length_of_cable_that_gives_like_a_joint_is_that_times_its_stiffness():
    """That of the null, whose cables are softer within their tolerances, as far as these go."""
    *_, null, menu = soft_joints()
    (found,) = imitated(menu, null, best(), [part_of("dead_length")])
    assert found.share == pytest.approx(1.0, abs=0.01)
    length = found.z[0] * part_of("dead_length").term.sigma[0]
    compliance = best().sizes[0][0] * best().hypothesis.parts[0].term.sigma[0]
    assert length == pytest.approx(compliance * cogiro().cables[0].axial_stiffness, rel=0.1)


def test_both_have_the_same_evidence_then():
    data, where, null, menu = soft_joints()
    part = part_of("dead_length")
    (like,) = imitated(menu, null, best(), [part])
    found = begun(data, where, null, Hypothesis((part,)), like.z)
    assert found.log_evidence == pytest.approx(best().log_evidence, abs=1.0)
    assert found.log_evidence > null.log_evidence + 20.0


def test_a_rival_that_may_not_be_negative_begins_at_zero_at_least():
    """Softer cables are what soft joints do; what stiffens them instead has no size below zero."""
    *_, null, menu = soft_joints()
    softer, each = imitated(menu, null, best(), [part_of("axial_stiffness"), part_of("dead_length", "each its own")])
    assert softer.z[0] < -0.5
    assert (each.z >= 0.0).all()


def test_a_cable_alone_does_most_of_what_acts_on_it_most():
    data, where, null, menu = soft_joints()
    each = part_of("axial_stiffness", "each its own")
    z = np.where(np.arange(8) == 4, 3.0, 0.1)
    found = begun(data, where, null, Hypothesis((each,)), z)
    pretended = replace(found, fit=replace(found.fit, z_mean=np.append(found.fit.z_mean[:-8], z)))
    likely = max(imitated(menu, null, pretended, alone(menu, pretended)), key=lambda one: one.share)
    assert likely.part.pattern.label == "cable 5 alone"
    assert likely.z[0] * likely.part.term.sigma[0] == pytest.approx(3.0 * each.term.sigma[4], rel=0.25)
    assert alone(menu, best()) == []
