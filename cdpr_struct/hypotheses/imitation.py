"""With which sizes does one cause do what another does? Beginnings of rivals where the likeliest one has come to lie.

Two causes that mean the same of the robot are equally probable only if both fits end in the same assignment of peaks.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cdpr_struct.hypotheses.alternatives import Offered
from cdpr_struct.hypotheses.hypothesis import Part
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.screening import Screen

_LOOSE = 0.01  # of the weight of a prior: it holds what the data say nothing of


@dataclass(frozen=True, slots=True, eq=False)
class Imitation:
    """A cause at sizes z (d,) in sigmas of its prior at its scale, and the share of another's effect that it makes."""

    part: Part
    z: np.ndarray
    share: float


def imitated(menu: Sequence[Offered], about: Judged, best: Judged, rivals: Sequence[Part]) -> list[Imitation]:
    """Each rival with the sizes that do most like the only cause of `best`.

    Least squares in the white rows about a fitted hypothesis, with wide priors of the rivals; to first order.
    """
    if not rivals:
        return []
    parts = [best.hypothesis.parts[0], *rivals]
    columns = {cause.cause.name: cause.columns for cause in menu}
    own = [[shelf @ part.pattern.basis * part.term.sigma for shelf in columns[part.cause.name]] for part in parts]
    screen = Screen.of(about.model, about.fit.noise, about.fit.soft)
    gram = screen.screened([np.concatenate(some, axis=-1) for some in zip(*own, strict=True)]).gram
    ends, size = np.cumsum([len(p.pattern.prior) for p in parts]), best.sizes[0]
    wanted, found = slice(0, ends[0]), []
    whole = float(size @ gram[wanted, wanted] @ size)
    for part, end in zip(rivals, ends[1:], strict=True):
        here = slice(end - len(part.pattern.prior), end)
        z = np.linalg.solve(_LOOSE * np.eye(end - here.start) + gram[here, here], gram[here, wanted] @ size)
        z = np.where(part.pattern.positive, np.maximum(z, 0.0), z)
        found.append(Imitation(part, z, float(z @ gram[here, here] @ z) / whole if whole else 0.0))
    return found


def alone(menu: Sequence[Offered], best: Judged) -> list[Part]:
    """The cause of `best` at each single cable, mast or axis, at its scale; none if that is what it is."""
    part = best.hypothesis.parts[0]
    own = next((one for one in menu if one.cause.name == part.cause.name), None)
    if own is None or len(part.pattern.prior) == 1:
        return []
    single = [i for i, p in enumerate(own.patterns) if p.of_one_carrier]
    return [own.part(i, part.scale) for i in single]
