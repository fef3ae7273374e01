"""What a diagnosis lists as candidates."""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis import verdict
from cdpr_struct.diagnosis.candidate_rows import candidate_rows
from cdpr_struct.diagnosis.diagnose import diagnose
from tests.laws.crime_campaign import hidden


def test_all_that_a_class_leaves_open_is_listed(monkeypatch):
    """Also what was fitted only in the place of another cause, and not among the first."""
    found = diagnose(hidden(lambda world: world.times(mass=np.asarray(1.03))))
    monkeypatch.setattr(verdict, "CREDIBLE", 1.1)  # a class of all rivals
    rivals = found.selection.rivals[0]
    listed = candidate_rows(replace(found, selection=replace(found.selection, first=[])))
    assert len(rivals) > 1
    assert {row["cause"] for row in listed} >= {fit.names[0] for fit in rivals} | set(found.selection.fit.names)


def test_a_cause_of_no_size_is_no_candidate():
    """Whatever its evidence: where peaks are modes otherwise, that is not the cause's doing."""
    found = diagnose(hidden(lambda world: world.times(mass=np.asarray(1.03))))
    best, *others = found.selection.first
    idle = [replace(fit, theta=0.0 * fit.theta, gain=fit.gain + 100.0) for fit in others]
    first = [*idle[:1], best, *others[1:]]
    listed = candidate_rows(replace(found, selection=replace(found.selection, first=first, rivals=[[]])))
    assert len(others) > 1
    assert {row["cause"] for row in listed} == {best.names[0], *(fit.names[0] for fit in others[1:])}
