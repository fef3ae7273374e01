"""The sentence and the result: named, class, unknown or adequate."""

from dataclasses import dataclass
from itertools import permutations

import numpy as np

from cdpr_struct.diagnosis.diagnose import ADEQUATE, NAMED, Diagnosis
from cdpr_struct.diagnosis.next_measurement import next_measurement
from cdpr_struct.diagnosis.prepared import SIGNIFICANT
from cdpr_struct.diagnosis.refit import Fit
from cdpr_struct.diagnosis.significance import OUTSIDE
from cdpr_struct.diagnosis.stray_peaks import SEVERAL, strays_left
from cdpr_struct.diagnosis.suspect_reading import in_words
from cdpr_struct.diagnosis.whole_change import whole_change
from cdpr_struct.diagnosis.wording import agreement, corrected, described, listed, rest_words

LARGEST_CLASS = 4
TEMPER = 0.7  # of the evidence between causes: the model of noise and tolerances is a model too
CREDIBLE = 0.95  # probability that a class holds together
CONFIRMED = 1.0  # nats that a cause keeps whichever group of states is left out, or it is not named
UNCONFIRMED = 0.6  # largest probability of a cause that hangs on one group of states
_LEFT = 4.0  # nats that a law outside the library must add to them
_INSTEAD = 3.0  # nats that one such law must bring more than several causes in its place
_FAR = 30.0  # sigmas, rms, of what no cause explains, from which the robot or the units may be others
_BETTER = 1.05  # times smaller error from which a prediction is better
_PRIOR_OUTSIDE = -4.6  # ln prior of the best channel, one in fourteen of one in seven, beside that of no further cause
_PLACES = {
    "EQ": "the wrench balance (forces and moments on the platform)", "CO": "the cable lengths",
    "NS": "the null space of the structure matrix (internal force)", "LP": "the poses at locked lengths",
    "CF": "the cable frequencies", "RF": "the robot frequencies",
    "FA": "the modal constants of the FRFs",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Verdict:
    """status is named, class, unknown or adequate; `classes` lists, per effect, the causes not told apart."""

    status: str
    causes: tuple[str, ...]
    classes: tuple[tuple[str, ...], ...]
    probability: float
    location: str
    next_measurement: str
    sentence: str


def verdict(found: Diagnosis) -> Verdict:
    """What to tell the user."""
    if found.p_value >= SIGNIFICANT:
        text = agreement(found) + _aside(found)
        again = "; ".join(f"read again {in_words(found.campaign, wrong)}" for wrong in found.aside)
        return Verdict("adequate", (), (), 0.99, "", again, text)
    fit, mended = found.selection.fit, [c for c, _ in found.corrections]
    place = location(found)
    if is_unknown(found):
        repeat = "; ".join(filter(None, (f"repeat what is worst: {place}", _next(found, ()))))
        return Verdict("unknown", (), (), _probability(found), place, repeat, _unknown_sentence(found, place))
    names = tuple(c.cause for c in mended) + (fit.names if fit else ())
    classes = (*((c.cause, *c.rivals) for c in mended), *classes_of(found))
    separable = all(len(c) == 1 for c in classes)
    status = "named" if separable and confirmed(found) else "class"
    if any(len(c) > LARGEST_CLASS for c in classes):
        text = f"Something is wrong in {place}; these data leave open {_many(classes[len(mended) :])}."
        text = " ".join([*(f"{said[:1].upper()}{said[1:]}." for said in corrected(found)), text]) + _aside(found)
        return Verdict("class", names, classes, _probability(found), place, _next(found, classes), text)
    return Verdict(status, names, classes, _probability(found), place, _next(found, classes), _sentence(found, classes))


def _next(found: Diagnosis, classes: tuple[tuple[str, ...], ...]) -> str:
    """What to measure next: of peaks that are set aside, then of the causes."""
    own = [c.next_measurement for c, _ in found.corrections if c.next_measurement]
    more = next_measurement(found, classes) if found.selection.fit is not None or not (own and classes) else ""
    return "; ".join(filter(None, [*own, more]))


def is_unknown(found: Diagnosis) -> bool:
    """Significant, and no cause in the library explains it."""
    fit = found.selection.fit
    if fit is None:
        return not found.corrections or found.p_value_left < ADEQUATE
    outside = found.outside
    structured = outside.gain > max(outside.limit, _LEFT)
    return found.p_adequate < ADEQUATE or structured or outside.instead > _INSTEAD


def _many(classes: tuple[tuple[str, ...], ...]) -> str:
    """The causes of classes too large to lead with one of them."""
    said = [f"{len(names)} causes ({', '.join(n.replace('_', ' ') for n in names)})" for names in classes]
    return " and, beside them, ".join(said)


def _unknown_sentence(found: Diagnosis, place: str) -> str:
    fit, outside = found.selection.fit, found.outside
    text = f"Something is wrong in {place}, and no cause in the library explains it."
    text += "".join(
        f" Beside it {c.sentence}." if c.place else f" That {c.sentence} would explain a part, and does not suffice."
        for c, _ in found.corrections
    )
    text += _far_off(found)
    if outside.instead > _INSTEAD:
        together = listed(fit.names) if fit else ""
        return f"{text} One law explains it better than {together} together: {outside.one_law}." + _aside(found)
    if fit:
        text += f" The best candidate, {' with '.join(fit.names).replace('_', ' ')}, leaves a structured remainder."
    strays = strays_left(found.ground, fit)
    if strays > SEVERAL:
        text += f" {strays:.0f} of the robot's measured frequencies are none of the model's:"
        text += " a platform that flexes, a mode of the frame or false peaks would do that."
    clear = outside.gain + (0.0 if fit else OUTSIDE) > _LEFT
    return text + (f" It looks like {outside.words}." if clear else "") + _aside(found)


def _far_off(found: Diagnosis) -> str:
    """What to look at where readings and robot have hardly anything to do with each other."""
    fit = found.selection.fit
    left = found.ground.z if fit is None else fit.white
    far = float(np.sqrt(np.mean(left**2)))
    if far < _FAR:
        return ""
    text = f" With all causes {far:.0f} sigmas are left in the rms, more than any wear or slip leaves: see whether the"
    return text + " campaign names the robot that was measured, and whether all files use its axes and units."


def _aside(found: Diagnosis) -> str:
    """Which readings contradict all others, and whether their noise wanders."""
    places = [f"{in_words(found.campaign, wrong)} (off by {wrong.sigmas:.0f} sigma)" for wrong in found.aside]
    text = f" Contradicts all other readings: {'; '.join(places)}." if places else ""
    return text + (" The noise of the sensors wanders from reading to reading." if found.campaign.memory else "")


def confirmed(found: Diagnosis) -> bool:
    """A fitted cause is a claim of transfer: it must not hang on one group of states."""
    fit = found.selection.fit
    if fit is None:
        return True
    return fit.gain >= NAMED and bool((found.weakest >= CONFIRMED).all())


def location(found: Diagnosis) -> str:
    """Where the error sits, block, state, cable: what the chosen causes take away, or what exceeds noise."""
    null, labels, fit = found.entered, found.entered_setting.labels, found.selection.fit
    known = [c.place for c, _ in found.corrections if c.place]
    if known and fit is None and not is_unknown(found):
        return known[0]
    explained = fit is not None and not found.corrections and not is_unknown(found)
    after = fit.left if fit is not None and explained else np.zeros_like(null.r)
    score = {}
    for block in dict.fromkeys(labels.block.tolist()):
        rows = labels.block == block
        before, left = (float(z @ z) for z in null.white_among(rows, np.stack([null.r, after], axis=1)).T)
        score[block] = (before - (left if explained else rows.sum())) / np.sqrt(2.0 * rows.sum())
    worst = max(score, key=lambda b: score[b])
    rows = np.flatnonzero(labels.block == worst)
    size = (np.abs(null.r) - np.abs(after))[rows] / np.sqrt(np.diagonal(null.covariance)[rows])
    top = rows[size.argmax()]
    where = f"case {found.campaign.states.names[labels.state[top]]}"
    if labels.cable[top] >= 0:
        where += f", cable {labels.cable[top] + 1}"
    return f"{_PLACES[worst]}, most in {where}"


def classes_of(found: Diagnosis) -> list[tuple[str, ...]]:
    """The class of each chosen cause."""
    fit = found.selection.fit
    return [] if fit is None else [_class(found, fit, i) for i in range(len(fit.names))]


def _class(found: Diagnosis, fit: Fit, i: int) -> tuple[str, ...]:
    """The i-th chosen cause with the likeliest others in its place, until they hold `CREDIBLE` together."""
    rivals: dict[str, float] = {}
    for rival in found.selection.rivals[i]:
        if rival.names[-1] not in fit.names:
            rivals.setdefault(rival.names[-1], rival.gain)
    weights = np.exp(TEMPER * (np.array([fit.gain, *rivals.values()]) - fit.gain))
    held = np.cumsum(weights / weights.sum())
    return (fit.names[i], *(name for name, before in zip(rivals, held[:-1], strict=True) if before < CREDIBLE))


def _probability(found: Diagnosis) -> float:
    """Of the answer: the chosen causes (with their class) among all that was fitted, null and outside included."""
    fit, outside = found.selection.fit, found.outside
    if fit is None:
        return _most(found) if found.corrections and not is_unknown(found) else 0.5
    gains = {fit.names: fit.gain}
    for row in found.selection.rivals:
        for rival in row:
            gains.setdefault(rival.names, rival.gain)
    beyond = fit.gain + max(outside.gain + _PRIOR_OUTSIDE, outside.instead)
    classes = classes_of(found)
    answer = [gain for names, gain in gains.items() if answers(names, classes)]
    logs = np.array([0.0, beyond, *gains.values()])
    said = TEMPER * beyond if is_unknown(found) else float(np.logaddexp.reduce(TEMPER * np.array(answer)))
    share = float(np.exp(said - np.logaddexp.reduce(TEMPER * logs)))
    if is_unknown(found) and found.p_adequate < ADEQUATE:
        share = max(share, 0.9)
    return float(np.round(min(share, _most(found) if is_unknown(found) or confirmed(found) else UNCONFIRMED), 2))


def _most(found: Diagnosis) -> float:
    """The largest probability that is said of an answer."""
    return min([0.99, *(c.most for c, _ in found.corrections)])


def answers(names: tuple[str, ...], classes: list[tuple[str, ...]]) -> bool:
    """Whether every class has one of the names, and no name is left over."""
    return len(names) == len(classes) and any(
        all(name in group for name, group in zip(order, classes, strict=True)) for order in permutations(names)
    )


def _sentence(found: Diagnosis, classes: tuple[tuple[str, ...], ...]) -> str:
    fit, parts = found.selection.fit, corrected(found)
    if fit is not None:
        whole, alone = fit.split(whole_change(fit)[0]), "" if confirmed(found) else "best candidate: "
        for choice, theta, names in zip(fit.choices, whole, classes[len(parts) :], strict=True):
            lead = "best candidate of its class: " if len(names) > 1 else alone
            parts.append(lead + described(choice, theta))
    text = "; ".join(parts)
    text = text[:1].upper() + text[1:] + "."
    for names in (names for names in classes if len(names) > 1):
        text += f" These data do not tell {listed(names)} apart."
    text += rest_words(found) if fit is None else _standing(found, fit)
    return text + _aside(found)


def _standing(found: Diagnosis, fit: Fit) -> str:
    """What the chosen causes explain of what is not noise, if chi^2 shows any, and whether what was left out agrees."""
    share = 100.0 * fit.explained(found.ground.z)
    explained = f"This explains {share:.0f} % of the significant error" if share >= 0.5 else ""
    joint, outcome, single = "", "", len(found.campaign.states.names) == 1
    if found.held is not None and not confirmed(found):
        joint, outcome = ", but ", "it hangs on one state: nothing that was left out confirms it"
        if single:
            outcome = "with a single state nothing can be left out to confirm it"
    elif found.held is not None:
        ratio = found.held.ratio(found.held.concerned)
        where = "from the other kinds of data alone" if single else "in states that were not fitted"
        better = f"{ratio:.1f} times better" if ratio > _BETTER else "no better"
        joint, outcome = "; ", f"what it concerns is predicted {better} {where}"
    text = explained + (joint if explained else "") + outcome
    return f" {text[:1].upper()}{text[1:]}." if text else ""
