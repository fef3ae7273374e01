"""Model and referee meet what others have printed, and the page says so."""

import dataclasses

import pytest

from tests.published.page import CASES, PAGE, page


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_model_meets_the_print(case):
    assert case.model() == pytest.approx(case.published, rel=case.accepted)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_referee_meets_the_print(case):
    assert case.referee() == pytest.approx(case.published, rel=case.accepted)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_model_and_referee_agree_more_closely(case):
    assert case.model() == pytest.approx(case.referee(), rel=min(case.accepted, 1e-5))


def test_a_wrong_print_is_seen():
    wrong = dataclasses.replace(CASES[3], published=CASES[3].published * (1.0 + 2.0 * CASES[3].accepted))
    assert wrong.model() != pytest.approx(wrong.published, rel=wrong.accepted)


def test_the_page_is_in_step():
    assert PAGE.read_text("utf-8") == page(), "run: python -m tests.published"
