"""Which cables hang slack?

A cable hangs slack if its chord tension is below its own weight, or if it does not pull at all. At that tension a level
cable sags by about an eighth of its chord; below it the cable holds up little but itself, and what stiffness it has
comes from its shape.
"""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.statics.cable_state import CableStates


def hangs_slack(states: CableStates) -> np.ndarray:
    """(..., m) bool: the chord tension is below the weight of the cable, or the cable does not pull."""
    return np.asarray(states.slack | (states.tension < states.weight * states.length))


def slack_count(states: CableStates, known: np.ndarray) -> np.ndarray:
    """(...) number of cables that hang slack; nan where the states (..., m) are not `known` (...)."""
    return np.where(known, hangs_slack(states).sum(axis=-1), np.nan)


def slack_sentence(slack: np.ndarray) -> str | None:
    """What to say of cables that hang slack, (m,) bool; None if there are none. Without a full stop."""
    numbers = (np.flatnonzero(slack) + 1).tolist()
    if not numbers:
        return None
    one = len(numbers) == 1
    who = "it pulls with less than its own weight" if one else "they pull with less than their own weight"
    return f"{cables_named(numbers)} {'hangs' if one else 'hang'} slack ({who})"


def cables_named(numbers: Sequence[int]) -> str:
    """Cables by their numbers, like `cables 5, 6 and 8`."""
    *first, last = [str(number) for number in numbers]
    return f"cables {', '.join(first)} and {last}" if first else f"cable {last}"
