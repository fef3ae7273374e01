"""The answer of least expected loss, by hand."""

import numpy as np
import pytest

from cdpr_struct.diagnosis.decision import Loss, decided, fits
from cdpr_struct.hypotheses.explain import Belief
from cdpr_struct.hypotheses.laws import UNKNOWN

LOSS = Loss(wrong_name=20.0, too_wide=1.0, unknown=10.0)


def beliefs(*rows: tuple[float, str]) -> list[Belief]:
    """Probability and causes, "a b" for both, "" for none."""
    assert sum(p for p, _ in rows) == pytest.approx(1.0)
    return [Belief(tuple(names.split()), p) for p, names in rows]


@pytest.mark.parametrize(
    ("rows", "status", "classes", "probability"),
    [
        # named: 20 (1 - p); a class of two: 1; adequate: 10 p; unknown: 10 p + 20 (1 - p)
        ([(1.0, "a")], "named", (("a",),), 1.0),
        ([(1.0, "")], "adequate", (), 1.0),
        ([(1.0, UNKNOWN)], UNKNOWN, (), 1.0),
        # nothing or a: 10 p against 20 (1 - p), even at two thirds
        ([(0.66, "a"), (0.34, "")], "adequate", (), 0.34),
        ([(0.67, "a"), (0.33, "")], "named", (("a",),), 0.67),
        # a or b: 20 (1 - p) against one name too many, even at p = 0.95
        ([(0.949, "a"), (0.051, "b")], "class", (("a", "b"),), 1.0),
        ([(0.951, "a"), (0.049, "b")], "named", (("a",),), 0.951),
        # a or a law outside: 20 (1 - p) against 10 p, even at two thirds
        ([(0.66, "a"), (0.34, UNKNOWN)], UNKNOWN, (), 0.34),
        ([(0.67, "a"), (0.33, UNKNOWN)], "named", (("a",),), 0.67),
        # both, or one of them: naming both costs 20 (1 - p), naming a costs 10 p, even at two thirds
        ([(0.66, "a b"), (0.34, "a")], "named", (("a",),), 1.0),
        ([(0.67, "a b"), (0.33, "a")], "named", (("a",), ("b",)), 0.67),
        # three causes, one of them for sure: it alone costs 10 for each that is unspoken, unknown one more of these
        ([(0.5, "a b c"), (0.5, "a d e")], "class", (("a",), ("b", "d"), ("c", "e")), 1.0),
        # a with one of three others: a alone costs 10, a and (b, c or d) costs 2, all others 6 or more
        ([(0.4, "a b"), (0.3, "a c"), (0.3, "a d")], "class", (("a",), ("b", "c", "d")), 1.0),
    ],
)  # fmt: skip
def test_small_cases_by_hand(rows, status, classes, probability):
    said = decided(beliefs(*rows), LOSS)
    assert said.status == status
    assert tuple(tuple(sorted(own)) for own in said.classes) == classes
    assert said.probability == pytest.approx(probability)


def test_both_of_two_causes_are_named_where_both_are_sure():
    """A cause that is there and not spoken of costs as much as to call it unknown; naming it wrongly, twice that."""
    assert decided(beliefs((0.9, "a b"), (0.1, "a")), LOSS).classes == (("a",), ("b",))
    assert decided(beliefs((0.5, "a b"), (0.5, "a")), LOSS).classes == (("a",),)


def test_three_alike_are_a_class_of_three():
    said = decided(beliefs((0.4, "a"), (0.3, "b"), (0.3, "c")), LOSS)
    assert said.status == "class"
    assert {*said.classes[0]} == {"a", "b", "c"}


def test_the_three_numbers_act_as_documented():
    """A name, a class and `unknown` each give way when what speaks against it costs more."""
    doubt = beliefs((0.9, "a"), (0.1, "b"))
    assert decided(doubt, LOSS).status == "class"
    assert decided(doubt, Loss(wrong_name=9.0, too_wide=1.0, unknown=5.0)).status == "named"  # 0.9 < 1
    assert decided(doubt, Loss(wrong_name=20.0, too_wide=2.5, unknown=10.0)).status == "named"  # 2 < 2.5
    perhaps = beliefs((0.6, "a"), (0.4, ""))
    assert decided(perhaps, LOSS).status == "adequate"  # 6 < 8
    assert decided(perhaps, Loss(wrong_name=20.0, too_wide=1.0, unknown=15.0)).status == "named"  # 8 < 9
    assert decided(beliefs((0.7, "a"), (0.3, "")), Loss(30.0, 1.0, 10.0)).status == "adequate"  # 7 < 9


def test_a_wider_class_never_follows_from_a_dearer_one():
    rows = beliefs((0.5, "a"), (0.3, "b"), (0.15, "c"), (0.05, "d"))
    widths = []
    for too_wide in (0.1, 0.5, 1.0, 2.0, 4.0, 8.0):
        said = decided(rows, Loss(20.0, too_wide, 19.0))
        widths.append(sum(len(own) for own in said.classes))
    assert widths == sorted(widths, reverse=True)
    assert widths[0] == 4


def test_order_of_beliefs_and_names_does_not_matter():
    rows = [(0.45, "a b"), (0.3, "b c"), (0.15, "c"), (0.05, ""), (0.05, UNKNOWN)]
    forward = decided(beliefs(*rows), LOSS)
    backward = decided([Belief(one.names[::-1], one.probability) for one in beliefs(*rows[::-1])], LOSS)
    assert forward.status == backward.status
    assert {frozenset(own) for own in forward.classes} == {frozenset(own) for own in backward.classes}
    assert forward.probability == pytest.approx(backward.probability)


@pytest.mark.parametrize("rows", [
    [(0.45, "a b"), (0.3, "b c"), (0.15, "c"), (0.05, ""), (0.05, UNKNOWN)],
    [(0.3, "a"), (0.25, "b"), (0.2, "c"), (0.15, "a c"), (0.1, "")],
    [(0.35, "a b"), (0.33, "a c"), (0.32, "b c")],
    [(0.5, "a b"), (0.5, "c d")],
])  # fmt: skip
def test_no_answer_of_up_to_two_classes_costs_less(rows):
    """By enumeration, expected losses written out anew."""
    given = beliefs(*rows)
    names = sorted({n for one in given for n in one.names} - {UNKNOWN})
    sets = [tuple(n for i, n in enumerate(names) if k >> i & 1) for k in range(1, 2 ** len(names))]
    answers = [()] + [(s,) for s in sets] + [(s, t) for s in sets for t in sets if not set(s) & set(t)]

    def loss(classes) -> float:
        total = sum(len(own) - 1.0 for own in classes)
        for one in given:
            if not _true(classes, one.names):
                total += 20.0 * one.probability
            else:
                total += 10.0 * one.probability * (len(one.names) - len(classes))
        return total

    unknown = sum(
        p * (20.0 if not names else 0.0 if names == UNKNOWN else 10.0 * len(names.split())) for p, names in rows
    )
    said = decided(given, LOSS)
    cost = unknown if said.status == UNKNOWN else loss(said.classes)
    assert cost == pytest.approx(min(unknown, *map(loss, answers)))


def _true(classes, names) -> bool:
    """Each class has a cause of its own."""
    if not classes:
        return True
    first, *rest = classes
    return any(n in first and _true(rest, [o for o in names if o != n]) for n in names)


def test_a_cause_stands_for_one_class_only():
    assert fits((("a", "b"), ("b", "c")), ("a", "b"))
    assert not fits((("a", "b"), ("a", "b")), ("a",))
    assert not fits((("a",), ("c",)), ("a", "b"))


@pytest.mark.parametrize("given", [(10.0, 1.0, 10.0), (20.0, 10.0, 10.0), (20.0, 0.0, 10.0), (float("nan"), 1.0, 10.0)])
def test_losses_that_would_turn_an_answer_around_are_refused(given):
    with pytest.raises(ValueError, match="wrong_name > unknown > too_wide > 0"):
        Loss(*given)


@pytest.mark.parametrize("loss", [LOSS, Loss(wrong_name=50.0, too_wide=2.0, unknown=10.0)])
@pytest.mark.parametrize("side", [0.99, 1.01])
def test_limits_of_the_loss_are_those_of_a_decision(loss, side):
    rival = 1.0 / (1.0 + np.exp(side * loss.nats_of_a_class))
    said = decided(beliefs((1.0 - rival, "a"), (rival, "b")), loss)
    assert said.status == ("class" if side < 1.0 else "named")
    sure = side * loss.least_said
    assert decided(beliefs((sure, "a"), (1.0 - sure, UNKNOWN)), loss).status == (UNKNOWN if side < 1.0 else "named")
