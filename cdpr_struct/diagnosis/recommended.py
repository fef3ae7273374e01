"""What to measure next."""

from collections.abc import Sequence
from dataclasses import dataclass

from cdpr_struct.diagnosis.decision import Decision
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.hypotheses.laws import UNKNOWN

_OF_HANDLING = {
    "unit_error": "asking who recorded the data for the unit of each column",
    "sign_error": "asking who recorded the data for the axes of the pose",
    "rotation_convention": "entering one pose that is turned by a large angle about a single axis",
    "swapped_channels": "pulling one cable by hand and watching its load cell and encoder",
    "pose_mismatch": "measuring that pose again",
    "cable_sag": "simulating with the model dsm or exact",
    "cable_dynamics": "simulating with the model dsm or exact",
    "attachment_geometric_stiffness": "simulating with the consistent assembly",
}
"""How handling errors and shortcuts of the simulation are told from their rivals."""


@dataclass(frozen=True, slots=True)
class Recommendation:
    """A measurement that would help.

    purpose : "tell_apart" causes of a class, "confirm" a cause, "repeat" readings that contradict the others, or
        "find" what no cause explains
    measurement : what to do, a noun phrase; "" where a reading is to be repeated
    causes : that it is about;  kind, case, cable : of the reading to repeat, cable from 0, -1 for none
    hertz : of that reading, 0 for none
    nats : log evidence that it is expected to bring, None where this was not computed
    """

    purpose: str
    measurement: str
    causes: tuple[str, ...] = ()
    kind: str = ""
    case: str = ""
    cable: int = -1
    nats: float | None = None
    hertz: float = 0.0


def recommended(decision: Decision, confirmed: bool, likeliest: Sequence[str]) -> list[Recommendation]:
    """What the library says of the causes left open, the likeliest of each class first.

    likeliest : of what no cause explains, the best candidates
    """
    if decision.status == "adequate":
        return []
    if decision.status == UNKNOWN:
        return [one for name in likeliest for one in _of_cause("find", name)]
    found = []
    for names in decision.classes:
        if len(names) > 1:
            found += [one for name in names for one in _of_cause("tell_apart", name)]
        elif decision.doubted or not confirmed:
            found += _of_cause("confirm", names[0])
    return _merged(found)


def _merged(found: Sequence[Recommendation]) -> list[Recommendation]:
    """Each measurement once, with all causes that it is about."""
    causes: dict[tuple[str, str], dict[str, None]] = {}
    for one in found:
        causes.setdefault((one.purpose, one.measurement), {}).update(dict.fromkeys(one.causes))
    return [Recommendation(purpose, what, tuple(names)) for (purpose, what), names in causes.items()]


def _of_cause(purpose: str, name: str) -> list[Recommendation]:
    cause = LIBRARY.get(name)
    text = cause.separated_by if cause is not None else _OF_HANDLING.get(name, "")
    return [Recommendation(purpose, step, (name,)) for step in text.split("; ") if step]
