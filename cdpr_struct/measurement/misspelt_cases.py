"""Cases that two files perhaps mean by different names: each name is a state of its own, which is said."""

import re
from collections.abc import Mapping, Sequence
from difflib import SequenceMatcher
from itertools import combinations

_ALIKE = 0.8  # ratio of letters in the same order, from which two names differ by a slip


def misspelt_notes(cases: Mapping[str, Sequence[str]]) -> tuple[str, ...]:
    """Sentences on cases of one file that another one perhaps has under a similar name.

    cases : names in each data file, in order

    Names alike but for spaces, signs and capitals are the same; a slip is suspected between files that share cases.
    """
    notes = []
    for (first, own), (second, others) in combinations(cases.items(), 2):
        left = [name for name in dict.fromkeys(own) if name not in others]
        right = [name for name in dict.fromkeys(others) if name not in own]
        shared = bool(set(own) & set(others))
        for name in right:
            for meant in left:
                if _plain(name) == _plain(meant) or (shared and _slip(name, meant)):
                    notes.append(
                        f"Case {name} of {second} has no row in {first}, which has {meant}: they are taken as two "
                        "states. If they are one, give it one name."
                    )
    return tuple(notes)


def _plain(name: str) -> str:
    return re.sub(r"[\W_]", "", name).lower()


def _slip(one: str, other: str) -> bool:
    """Whether two names have the same numbers and nearly the same letters."""
    if re.findall(r"\d+", one) != re.findall(r"\d+", other):
        return False
    return SequenceMatcher(None, _plain(one), _plain(other)).ratio() >= _ALIKE
