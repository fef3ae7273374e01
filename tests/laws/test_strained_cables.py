"""Which cable is stretched beyond what ropes bear is told by its number."""

from types import SimpleNamespace

import numpy as np
import pytest

from cdpr_struct.robot.plausibility import BREAKING_STRAIN
from cdpr_struct.statics.strained_cables import strain_sentence, strains


def cables(*strain):
    return SimpleNamespace(elongation=2.0 * np.array(strain), total_length=np.full(len(strain), 2.0))


def test_strain_is_elongation_over_length_and_none_without_a_length():
    assert strains(cables(0.01, np.nan, 0.03)) == pytest.approx([0.01, 0.0, 0.03])


def test_the_sentence_names_the_cable_that_is_stretched_most():
    assert strain_sentence(cables(0.01, 0.5, 0.3)).startswith("Cable 2 is stretched by 50 %")
    assert strain_sentence(cables(0.01, BREAKING_STRAIN, np.nan)) is None
    assert strain_sentence(cables(1.01 * BREAKING_STRAIN, 0.0)).startswith("Cable 1 ")
