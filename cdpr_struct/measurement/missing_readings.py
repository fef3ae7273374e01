"""What a campaign's states lack, in sentences for a person: readings of single cables, positions, angles."""

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import States

_SHOWN = 5  # states named before the rest is counted


def missing_notes(states: States) -> tuple[str, ...]:
    """Sentences on tensions and lengths of states that were read of some cables only, and on poses that lack a number.

    A quantity that a state does not have at all is not missing: lengths alone are a campaign, too.
    """
    placed = states.static | states.loaded
    notes = [_of_cables("tension", states.tension[states.static]), _of_cables("length", states.length[placed])]
    notes += [_of_poses("position", states.names, states.position), _of_poses("rotation", states.names, states.angles)]
    return tuple(note for note in notes if note)


def check_placed(source: str, states: States, vibrating: np.ndarray) -> None:
    """Refuse frequencies of a state that nothing places.

    vibrating : numbers of the states where frequencies were measured

    Raises
    ------
    InputError : a state of them without any number of a position, and without the lengths of all cables.
    """
    placed = np.isfinite(states.position).any(axis=1) | states.has_length
    for state in vibrating[~placed[vibrating]].tolist()[:1]:
        expected = (
            "frequencies of a state whose position, or whose lengths of all cables, some file of the campaign gives"
        )
        raise InputError(source, f"case {states.names[state]}", "no pose", expected)


def _of_cables(name: str, values: np.ndarray) -> str:
    """Sentence on values (S, m)."""
    known = np.isfinite(values)
    own = known[known.any(axis=1)]
    lacking = int((~own).sum())
    if not lacking:
        return ""
    never = (np.flatnonzero(~own.any(axis=0)) + 1).tolist()
    cables = f"; cable {', '.join(map(str, never))} has none" if never else ""
    return f"{lacking} of {own.size} {name} readings are missing{cables}."


def _of_poses(name: str, states: tuple[str, ...], values: np.ndarray) -> str:
    """Sentence on values (S, 3)."""
    lacking = [state for state, row in zip(states, values, strict=True) if not np.isfinite(row).all()]
    if not lacking:
        return ""
    more = f" and {len(lacking) - _SHOWN} more" if len(lacking) > _SHOWN else ""
    return f"The {name} of {', '.join(lacking[:_SHOWN])}{more} was not measured in full: taken as unknown."
