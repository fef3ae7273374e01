"""Which cables hang slack?

A cable hangs slack if its chord tension is below its own weight, or if it does not pull at all. At that tension a level
cable sags by about an eighth of its chord; below it the cable holds up little but itself, and what stiffness it has
comes from its shape.
"""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.statics.cable_state import CableStates

DEEP = 0.1  # sag over chord from which on a cable's sag is told


def hangs_slack(states: CableStates) -> np.ndarray:
    """(..., m) bool: the chord tension is below the weight of the cable, or the cable does not pull."""
    return np.asarray(states.slack | (states.tension < states.whole_weight))


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


def sag_over_chord(states: CableStates) -> np.ndarray:
    """(..., m) largest distance from the chord over the chord; nan for a straight cable that does not pull."""
    return np.asarray(states.sag / states.chord)


def tension_over_weight(states: CableStates) -> np.ndarray:
    """(..., m) chord tension over the weight of the cable; inf for a weightless one that pulls."""
    weight = states.whole_weight
    return np.where(
        weight > 0.0, states.tension / np.where(weight > 0.0, weight, 1.0), np.where(states.slack, 0.0, np.inf)
    )


def sagging_cables(states: CableStates) -> list[dict[str, object]]:
    """Cables (m,) of one pose that hang slack or sag by a tenth of their chord, as results tell them."""
    slack, sag, tension = hangs_slack(states), sag_over_chord(states), tension_over_weight(states)
    told = np.flatnonzero(slack | (sag >= DEEP))
    return [
        {
            "cable": int(i) + 1,
            "sag_over_chord": float(sag[i]) if np.isfinite(sag[i]) else None,
            "tension_over_weight": float(tension[i]),
            "slack": bool(slack[i]),
        }
        for i in told
    ]


def sag_sentence(states: CableStates) -> str | None:
    """How deep the cables (m,) sag that hang slack or sag by a tenth of their chord; None if none does."""
    parts = [
        f"cable {one['cable']} by {one['sag_over_chord']:.2g} of its chord "
        f"(tension {one['tension_over_weight']:.2g} of its weight)"
        for one in sagging_cables(states)
        if one["sag_over_chord"] is not None
    ]
    return f"deep sag: {', '.join(parts)}." if parts else None
