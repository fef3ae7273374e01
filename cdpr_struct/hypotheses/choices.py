"""Which way has each carrier, where a cause has several of which each carrier has one?

K ways of m carriers are K^m patterns. Of one common size, what each adds follows in closed form from gram and score of
the ways; the best one is found by changing one carrier at a time, from many patterns on.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cdpr_struct.hypotheses.alternatives import Offered
from cdpr_struct.hypotheses.causes.cause import Cause, Pattern, Seen
from cdpr_struct.hypotheses.detectable import noncentrality
from cdpr_struct.hypotheses.hypothesis import SCALES, Part
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.inference.screening import Screen

_STRAIGHT = 0.5  # probability that ways do not bend; half of the rest that they bend a little
_MIXED = 0.4  # probability that carriers differ in their ways
_LITTLE = 0.2  # of the prior by which ways bend, where they bend a little
_SEED, _STARTS = 20251125, 200  # of mixes that are improved, beside the uniform ones
_ROUNDS = 20  # changes of every carrier's way; each round that changes one adds to a bounded sum


def with_choices(menu: Sequence[Offered], about: Judged, noises: Sequence[NoiseState], seen: Seen) -> list[Offered]:
    """The causes with one more way to occur for those whose carriers have one of several: the best mix of ways."""
    if not any(one.cause.one_of for one in menu):
        return list(menu)
    each = [*noises, NoiseState.stated(about.model.groups)]
    screens = [Screen.of(about.model, noise, about.fit.soft) for noise in each]
    return [_mixed(one, screens, seen) if one.cause.one_of else one for one in menu]


def _mixed(offered: Offered, screens: Sequence[Screen], seen: Seen) -> Offered:
    """With the best mixes at each noise."""
    cause, ways = offered.cause, len(offered.cause.one_of)
    carriers = offered.columns[0].shape[-1] // len(cause.parameters)
    mixes = {mix: None for screen in screens for mix in _best_mixes(offered, screen) if len(set(mix)) > 1}
    others = max(float(ways) ** carriers - ways, 1.0)
    share = _MIXED * ways / others  # of one mix; `in_one_way` divides by the ways itself
    patterns = [replace(p, weight=_STRAIGHT * (1.0 - _MIXED) * p.weight) for p in offered.patterns]
    patterns += [replace(p, weight=_STRAIGHT * share * p.weight) for mix in mixes for p in cause.in_one_way(seen, mix)]
    return replace(offered, patterns=tuple(patterns))


def _best_mixes(offered: Offered, screen: Screen) -> list[tuple[int, ...]]:
    """The best mix, and the best beside what may go along."""
    cause, ways, stride = offered.cause, len(offered.cause.one_of), len(offered.cause.parameters)
    said = screen.screened(offered.columns)
    starts = stride * np.arange(len(said.score) // stride)
    place = (starts[:, None] + np.arange(ways)).ravel()
    prior, shape = cause.parameters[0].prior, (len(starts), ways)
    gram, score = said.gram[np.ix_(place, place)] * prior**2, said.score[place] * prior
    found = [best_mix(gram.reshape(shape * 2), score.reshape(shape))]
    if cause.along:
        along, size = starts + ways, cause.parameters[ways].prior
        cross = said.gram[np.ix_(place, along)] * prior * size
        inner = said.gram[np.ix_(along, along)] * size**2 + np.eye(len(along)) / SCALES[-1] ** 2
        taken = np.linalg.solve(inner, np.column_stack([cross.T, said.score[along] * size]))
        gram, score = gram - cross @ taken[:, :-1], score - cross @ taken[:, -1]
        found.append(best_mix(gram.reshape(shape * 2), score.reshape(shape)))
    return found


def best_mix(gram: np.ndarray, score: np.ndarray) -> tuple[int, ...]:
    """Way of each carrier that together add most, all of one size that cannot be negative.

    gram (m, K, m, K), score (m, K) : of columns in prior sigmas
    """
    carriers, ways = score.shape
    uniform = np.repeat(np.arange(ways)[:, None], carriers, axis=1)
    mixes = np.concatenate([uniform, np.random.default_rng(_SEED).integers(0, ways, (_STARTS, carriers))])
    for _ in range(_ROUNDS):
        before = mixes.copy()
        for i in range(carriers):
            mixes[:, i] = _added(gram, score, mixes, i).argmax(axis=1)
        if (mixes == before).all():
            break
    values = _added(gram, score, mixes, 0).max(axis=1)
    return tuple(mixes[values.argmax()].tolist())


def _added(gram: np.ndarray, score: np.ndarray, mixes: np.ndarray, i: int) -> np.ndarray:
    """(N, K) what mixes (N, m) add with each way of carrier i, at the largest scale."""
    others = np.delete(np.arange(mixes.shape[1]), i)
    own = mixes[:, others]
    inner = gram[others[:, None], own[:, :, None], others, own[:, None, :]].sum(axis=(1, 2))
    cross = gram[others, own, i].sum(axis=1)
    g = inner[:, None] + 2.0 * cross + np.diagonal(gram[i, :, i])
    s = np.maximum(score[others, own].sum(axis=1)[:, None] + score[i], 0.0)
    return np.asarray(0.5 * s**2 / (g + SCALES[-1] ** -2) - 0.5 * np.log1p(SCALES[-1] ** 2 * g))


def occurs(found: Judged) -> bool:
    """Whether the mean size of each cause in one of several ways would be found alone, and no size is too small or
    larger than any that occurs.

    What goes along may act alone: then another cause says the same without it.
    """
    parts = found.hypothesis.parts
    return all(_occurs(found, i) for i, part in enumerate(parts) if part.cause.one_of) and _none_too_large(found)


def _none_too_large(found: Judged) -> bool:
    """Whether no size is larger by more than two sigmas than what occurs."""
    parts = found.hypothesis.parts
    factor = np.concatenate([np.zeros(0), *(part.scale * part.pattern.prior for part in parts)])
    most = np.concatenate([np.zeros(0), *([p.most for p in part.pattern.parameters] for part in parts)])
    last = len(found.fit.z_mean) - len(factor)
    sigma = factor * np.sqrt(np.diagonal(found.fit.z_covariance)[last:])
    return bool((np.abs(factor * found.fit.z_mean[last:]) - 2.0 * sigma <= most).all())


def _occurs(found: Judged, i: int) -> bool:
    part, parts = found.hypothesis.parts[i], found.hypothesis.parts
    start = len(found.fit.z_mean) - sum(len(p.pattern.prior) for p in parts[i:])
    sizes = [k for k, p in enumerate(part.pattern.parameters) if p.least > 0.0]
    own, factor = start + np.array(sizes), part.scale * part.pattern.prior[sizes] / len(sizes)
    mean = float(factor @ found.fit.z_mean[own])
    sigma = float(np.sqrt(factor @ found.fit.z_covariance[np.ix_(own, own)] @ factor))
    return mean > max(part.pattern.parameters[sizes[0]].least, np.sqrt(noncentrality(1)) * sigma)


def same(one: Cause, other: Cause) -> bool:
    """Whether one of two causes has the numbers of the other in half of its patterns: with it, both say no more."""
    return any(a.along and b.name in a.becomes for a, b in ((one, other), (other, one)))


def bent(part: Part, seen: Seen) -> list[Part]:
    """A part with the numbers by which each carrier's way may bend: by as much as their prior says, or little."""
    return [_bent(part, seen, size) for size in (1.0, _LITTLE)]


def _bent(part: Part, seen: Seen, size: float) -> Part:
    cause = part.cause
    basic, ways = cause.basic(seen), len(cause.one_of)
    free = [i for i in range(len(basic)) if i % len(cause.parameters) >= ways + bool(cause.along)]
    basis = np.concatenate([part.pattern.basis, np.eye(len(basic))[:, free]], axis=1)
    more = (replace(basic[i], prior=size * basic[i].prior) for i in free)
    label = f"{part.pattern.label}, leaning" + ("" if size == 1.0 else " a little")
    pattern = Pattern(label, basis, (*part.pattern.parameters, *more), 0.5 * part.pattern.weight)
    return replace(part, pattern=pattern)
