"""A single reading that contradicts all others: a slip of pen, a cell that caught, a peak of the wrong cable.

One such reading makes a campaign significant and looks a little like many causes, none of which it confirms. Its
hypothesis is that one number, any of them, is off by far more than its sigma; it is set aside by widening its sigma to
what it is off by, so that nothing else changes and the reading can still be seen.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from cdpr_struct.diagnosis.null_model import reading_count, tolerance_count
from cdpr_struct.diagnosis.refit import Ground
from cdpr_struct.measurement.campaign import Campaign

_WRONG = np.array([[5.0], [30.0], [200.0]])  # sigmas by which a wrong reading is off, to an order of magnitude
_CLEAR = 3.0  # nats that it must bring
_CHECKED = 0.05  # share of a reading's variance that the rest must see, or it contradicts nothing


@dataclass(frozen=True, slots=True)
class Suspect:
    """A wrong reading: tension, length or cable_frequency of a cable (from 0) in a case, by how many sigmas it is off.

    row  : of the cable frequencies, or -1;  gain : log evidence against the null, all readings alike before
    """

    kind: str
    state: int
    cable: int
    row: int
    sigmas: float
    gain: float


def suspect(ground: Ground) -> Suspect | None:
    """The reading that alone explains most of what is not noise, if there is one."""
    columns, places = _readings(ground)
    seen, z = ground.null.white(columns), ground.z
    weight, b = (seen**2).sum(axis=0), seen.T @ z
    checked = weight > _CHECKED
    if not checked.any():
        return None
    spread = 1.0 + _WRONG**2 * weight
    gain = logsumexp(0.5 * (_WRONG**2 * b**2 / spread - np.log(spread)), axis=0) - np.log(len(_WRONG) * checked.sum())
    best = int(np.where(checked, gain, -np.inf).argmax())
    if gain[best] < _CLEAR:
        return None
    kind, state, cable, row = places[best]
    return Suspect(kind, state, cable, row, float(abs(b[best]) / weight[best]), float(gain[best]))


def _readings(ground: Ground) -> tuple[np.ndarray, list[tuple[str, int, int, int]]]:
    """Changes of the residuals (n, k) by one sigma of each tension, length and cable frequency, and which it is."""
    setting, columns = ground.setting, ground.null.columns
    states, m = setting.campaign.states, ground.world.cables
    s, held = len(states.names), reading_count(setting)
    first = {int(lock): int(i) for i, lock in reversed(list(enumerate(states.lock))) if lock >= 0}
    places = [("tension", i, c, -1) for i in range(s) for c in range(m)]
    places += [("length", first[k], c, -1) for k in sorted(first) for c in range(m)]
    rows, start = setting.cable_rows, held + tolerance_count(setting)
    places += [
        ("cable_frequency", int(i), int(c), k) for k, (i, c) in enumerate(zip(rows.state, rows.cable, strict=True))
    ]
    own = columns[:, start : start + len(rows.hertz)]
    return np.concatenate([columns[:, 6 * s : held], own], axis=1), places


def set_aside(campaign: Campaign, wrong: Suspect) -> Campaign:
    """The campaign with the sigma of the wrong reading widened to what it is off by."""
    wider = float(np.hypot(1.0, wrong.sigmas))
    if wrong.kind == "cable_frequency":
        sigma = campaign.cable_frequencies.sigma.copy()
        sigma[wrong.row] *= wider
        return replace(campaign, cable_frequencies=replace(campaign.cable_frequencies, sigma=sigma))
    states = campaign.states
    if wrong.kind == "tension":
        sigma = states.tension_sigma.copy()
        sigma[wrong.state, wrong.cable] *= wider
        return replace(campaign, states=replace(states, tension_sigma=sigma))
    sigma = states.length_sigma.copy()
    sigma[states.lock == states.lock[wrong.state], wrong.cable] *= wider
    return replace(campaign, states=replace(states, length_sigma=sigma))


def in_words(campaign: Campaign, wrong: Suspect) -> str:
    """Which reading it is, for a person."""
    name = wrong.kind.replace("_", " ")
    if wrong.row >= 0:
        name = f"frequency {campaign.cable_frequencies.mode[wrong.row]}"
    return f"the {name} of cable {wrong.cable + 1} in case {campaign.states.names[wrong.state]}"
