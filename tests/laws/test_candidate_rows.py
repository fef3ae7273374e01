"""What a diagnosis lists as candidates."""

from dataclasses import replace

import numpy as np

from cdpr_struct.diagnosis.diagnose import diagnose
from cdpr_struct.diagnosis.verdict import candidate_rows
from tests.laws.crime_campaign import hidden


def test_a_cause_of_no_size_is_no_candidate():
    """Whatever its evidence: where peaks are modes otherwise, that is not the cause's doing."""
    found = diagnose(hidden(lambda world: world.times(mass=np.asarray(1.03))))
    best, *others = found.selection.first
    idle = [replace(fit, theta=0.0 * fit.theta, gain=fit.gain + 100.0) for fit in others]
    listed = candidate_rows(replace(found, selection=replace(found.selection, first=[*idle[:1], best, *others[1:]])))
    assert len(others) > 1
    assert {row["cause"] for row in listed} == {best.names[0], *(fit.names[0] for fit in others[1:])}
