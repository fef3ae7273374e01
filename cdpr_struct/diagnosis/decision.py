"""What to say, given how probable everything is: the answer of least expected loss.

An answer is a row of classes: one cause of each is there. A class of one names its cause; no class at all says that
the model is adequate. What is said may be wrong (a class without a true cause), or wider than need be: for every name
too many in a class, and for every true cause that is not spoken of.
"""

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from itertools import combinations, permutations

from cdpr_struct.hypotheses.explain import Belief
from cdpr_struct.hypotheses.laws import UNKNOWN
from cdpr_struct.measurement.loss import Loss

Classes = tuple[tuple[str, ...], ...]
_LIKELIEST = 8  # sets of causes that answers are begun from


@dataclass(frozen=True, slots=True)
class Decision:
    """The answer of least expected loss: its status, classes, and the probability that it is right."""

    status: str
    classes: Classes
    probability: float

    @property
    def doubted(self) -> bool:
        """Whether it speaks of the likeliest causes, one a class, without being sure enough to name them."""
        return self.status == "class" and all(len(names) == 1 for names in self.classes)


def decided(beliefs: Sequence[Belief], loss: Loss, without_size: AbstractSet[str] = frozenset()) -> Decision:
    """The decision for beliefs whose probabilities sum up to one.

    without_size : causes that are not spoken of: what was fitted of them is no change of the robot
    """
    options: list[tuple[float, str, Classes]] = [
        (_of_unknown(beliefs, loss), UNKNOWN, ()),
        (_of_classes((), beliefs, loss), "adequate", ()),
    ]
    for start in _beginnings(beliefs, without_size):
        classes = _widened(start, beliefs, loss, without_size)
        options.append((_of_classes(classes, beliefs, loss), _status(classes), classes))
    _, status, classes = min(options, key=lambda option: option[0])
    return Decision(status, classes, min(1.0, _right(status, classes, beliefs)))


def _status(classes: Classes) -> str:
    return "named" if all(len(names) == 1 for names in classes) else "class"


def _right(status: str, classes: Classes, beliefs: Sequence[Belief]) -> float:
    """Probability that what is said is true."""
    if status == UNKNOWN:
        return sum(one.probability for one in beliefs if UNKNOWN in one.names)
    if status == "adequate":
        return sum(one.probability for one in beliefs if not one.names)
    return sum(one.probability for one in beliefs if fits(classes, one.names))


def _beginnings(beliefs: Sequence[Belief], without_size: AbstractSet[str]) -> Iterable[Classes]:
    """Every likely set of causes named, every likely cause alone, and of two sets as large either cause of each."""
    ranked = sorted(beliefs, key=lambda one: -one.probability)[:_LIKELIEST]
    hidden = {UNKNOWN, *without_size}
    known = [one.names for one in ranked if one.names and not hidden & set(one.names)]
    alone = {(name,) for names in known for name in names}
    pairs = [
        (one, order) for one, other in combinations(known, 2) if len(one) == len(other) for order in permutations(other)
    ]
    either = [tuple(tuple(dict.fromkeys(own)) for own in zip(one, order, strict=True)) for one, order in pairs]
    named: list[Classes] = [tuple((name,) for name in names) for names in [*known, *sorted(alone)]]
    return [*named, *(classes for classes in either if _apart(classes))]


def _apart(classes: Classes) -> bool:
    """Whether no name is in two classes."""
    names = [name for own in classes for name in own]
    return len(set(names)) == len(names)


def _widened(classes: Classes, beliefs: Sequence[Belief], loss: Loss, without_size: AbstractSet[str]) -> Classes:
    """Classes with names added as long as that lowers the loss."""
    names = sorted({name for one in beliefs for name in one.names} - {UNKNOWN, *without_size})
    best = _of_classes(classes, beliefs, loss)
    while True:
        taken = {name for own in classes for name in own}
        wider = [
            (*classes[:i], (*own, name), *classes[i + 1 :])
            for i, own in enumerate(classes)
            for name in names
            if name not in taken
        ]
        options = [(_of_classes(option, beliefs, loss), option) for option in wider]
        if not options or min(options)[0] >= best:
            return classes
        best, classes = min(options)


def _of_unknown(beliefs: Sequence[Belief], loss: Loss) -> float:
    said = sum(one.probability * len(one.names) for one in beliefs if UNKNOWN not in one.names)
    nothing = sum(one.probability for one in beliefs if not one.names)
    return loss.unknown * said + loss.wrong_name * nothing


def _of_classes(classes: Classes, beliefs: Sequence[Belief], loss: Loss) -> float:
    """Expected loss of an answer."""
    total = loss.too_wide * sum(len(names) - 1 for names in classes)
    for one in beliefs:
        if not fits(classes, one.names):
            total += loss.wrong_name * one.probability
        else:
            total += loss.unknown * (len(one.names) - len(classes)) * one.probability
    return total


def fits(classes: Classes, names: Sequence[str]) -> bool:
    """Whether each class has a cause of its own among the names."""
    if len(classes) > len(names):
        return False
    return any(
        all(name in own for name, own in zip(order, classes, strict=True))
        for order in permutations(names, len(classes))
    )
