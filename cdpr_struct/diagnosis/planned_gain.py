"""How much better would causes be told apart with one more measurement?

Rows of new residuals are stacked on those at hand. All are linear in tolerances (shared by old and new rows), in noise
(each its own) and in causes, so covariance and signatures of the whole are known without measuring. The expected log
evidence of a cause of given size against a rival of any size is then `left_over`, in nats.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.diagnosis.causes.sensors import COMMON, internal_force
from cdpr_struct.diagnosis.detectable import noncentrality
from cdpr_struct.diagnosis.evidence import Choice
from cdpr_struct.diagnosis.null_model import null_with_bending, reading_count, tolerance_count, tolerated
from cdpr_struct.diagnosis.plan import WIDE, left_over, plainest
from cdpr_struct.diagnosis.planned_checks import CHECKS, Check
from cdpr_struct.diagnosis.planned_series import series
from cdpr_struct.diagnosis.planned_states import Proposal, proposals
from cdpr_struct.diagnosis.readings import Readings
from cdpr_struct.diagnosis.refit import Ground
from cdpr_struct.diagnosis.residuals import Setting, residuals
from cdpr_struct.diagnosis.setting import make_setting, with_equilibria
from cdpr_struct.diagnosis.world import World
from cdpr_struct.errors import CdprError
from cdpr_struct.side_by_side import side_by_side

ENOUGH = 5.0  # nats of a pair beyond which more are worth nothing: a cause is named then
_DRAWS, _SEED, _STEP = 12, 20240229, 0.05
_INTERNAL = "internal_force"
Apply = Callable[[World, np.ndarray], World]


@dataclass(frozen=True, slots=True, eq=False)
class NewRows:
    """n new residuals: effect of t tolerances (n, t), of noise (n, k), of each cause's basic parameters (n, d0).

    fresh : (n, d) free parameters of their own that internal force brings along, in prior sigmas
    """

    tolerance: np.ndarray
    noise: np.ndarray
    signature: dict[str, np.ndarray]
    fresh: np.ndarray


@dataclass(frozen=True, slots=True)
class Separation:
    """A pair of causes and the expected log evidence for the first against the second, before and after [nats]."""

    cause: str
    rival: str
    before: float
    after: float


@dataclass(frozen=True, slots=True)
class Gain:
    """A measurement and what it is worth: nats over all pairs, each counted up to `ENOUGH`; pairs, best first."""

    measurement: str
    family: str
    nats: float
    separations: tuple[Separation, ...]


def next_measurements(ground: Ground, pairs: list[tuple[str, str]]) -> list[Gain]:
    """Measurements that would tell confused pairs of causes apart, best first; of each family the best one."""
    if not pairs:
        return []
    named = {name for pair in pairs for name in pair}
    ground = replace(ground, candidates=[c for c in ground.candidates if c.name in named])
    judge = Judge(ground, pairs)
    found = [judge.gain(c.text, c.text, checked(ground, c)) for c in CHECKS]
    campaign = ground.setting.campaign
    for proposal, rows in possible(ground, [*proposals(campaign), *series(campaign)]):
        found.append(judge.gain(proposal.text, proposal.family, rows))
    best: dict[str, Gain] = {}
    for gain in sorted(found, key=lambda g: -g.nats):
        best.setdefault(gain.family, gain)
    return [gain for gain in best.values() if gain.nats > 0.1]


def possible(ground: Ground, several: list[Proposal]) -> list[tuple[Proposal, NewRows]]:
    """Proposals with their rows; a state that the model cannot compute is not proposed."""

    def rows(proposal: Proposal) -> NewRows | None:
        try:
            return simulated(ground, proposal)
        except (CdprError, ValueError):
            return None

    found = zip(several, side_by_side(rows, several, ground.known), strict=True)
    return [(proposal, own) for proposal, own in found if own is not None]


class Judge:
    """Pairs of causes with their sizes, and what is known of them before any new measurement.

    sized  : pattern and size theta (d,) of each cause, in prior sigmas; by default the plainest at twice detectable
    beside : causes that are there whichever of a pair is true, of any size
    """

    def __init__(
        self,
        ground: Ground,
        pairs: list[tuple[str, str]],
        sized: Mapping[str, tuple[Choice, np.ndarray]] | None = None,
        beside: Sequence[Choice] = (),
    ) -> None:
        self.pairs, self.lower, self.beside = pairs, ground.null.lower, beside
        named = {name for pair in pairs for name in pair}
        self.wide = dict.fromkeys(named, WIDE)
        if sized is None:
            plain = [plainest(c) for c in ground.candidates if c.name in named]
            sized = {choice.candidate.name: (choice, size_of(choice)) for choice in plain}
        else:
            self.wide = {name: max(WIDE, 2.0 * float(np.abs(theta).max())) for name, (_, theta) in sized.items()}
        self.choices = {name: choice for name, (choice, _) in sized.items()}
        self.theta = {name: theta for name, (_, theta) in sized.items()}
        start = reading_count(ground.setting)
        self.tolerance = ground.null.columns[:, start : start + tolerance_count(ground.setting)]
        self.covariance = ground.null.covariance
        blank = np.zeros((0, self.tolerance.shape[1]))
        self.before = self.nats(NewRows(blank, np.zeros((0, 0)), {}, np.zeros((0, 0))))

    def gain(self, text: str, family: str, rows: NewRows) -> Gain:
        """What the rows are worth."""
        after = self.nats(rows)
        useful = np.minimum(after, ENOUGH) - np.minimum(self.before, ENOUGH)
        order = np.argsort(-(after - self.before))
        rows_of = zip(self.pairs, self.before.tolist(), after.tolist(), strict=True)
        found = [Separation(cause, rival, before, now) for (cause, rival), before, now in rows_of]
        return Gain(text, family, float(np.maximum(useful, 0.0).sum()), tuple(found[i] for i in order))

    def nats(self, rows: NewRows) -> np.ndarray:
        """(pairs,) expected log evidence with the rows added."""
        cross = self.tolerance @ rows.tolerance.T
        own = rows.tolerance @ rows.tolerance.T + rows.noise @ rows.noise.T
        lower = np.linalg.cholesky(np.block([[self.covariance, cross], [cross.T, own]]))
        white = {name: np.linalg.solve(lower, self._signature(choice, rows)) for name, choice in self.choices.items()}
        always = [WIDE * np.linalg.solve(lower, self._signature(choice, rows)) for choice in self.beside]
        fresh = np.vstack([np.zeros((len(self.lower), rows.fresh.shape[1])), rows.fresh])
        inner = np.linalg.solve(lower, fresh) if fresh.size else np.zeros((len(lower), 0))
        nats = []
        for cause, rival in self.pairs:
            free = _own_of_states([self.choices[rival], *self.beside])
            other = [self.wide[rival] * white[rival], *always] + ([WIDE * inner] if free else [])
            nats.append(left_over(white[cause] @ self.theta[cause], np.hstack(other)))
        return np.array(nats)

    def _signature(self, choice: Choice, rows: NewRows) -> np.ndarray:
        """(n, d) effect of a cause's parameters, in prior sigmas, on old and new rows."""
        old = self.lower @ choice.signature
        new = rows.signature.get(choice.candidate.name)
        if new is None:
            return np.vstack([old, np.zeros((len(rows.tolerance), old.shape[1]))])
        return np.vstack([old, (new @ choice.pattern.basis) * choice.prior])


def _own_of_states(picked: list[Choice]) -> bool:
    """Whether an internal force is among the causes that is another one in every state, new ones too."""
    return any(c.candidate.name == _INTERNAL and c.pattern.label != COMMON for c in picked)


def size_of(choice: Choice) -> np.ndarray:
    """(d,) twice the size that would be found, all parameters alike, but at most `WIDE` prior sigmas."""
    d = choice.signature.shape[1]
    seen = float(np.linalg.norm(choice.signature.sum(axis=1))) / np.sqrt(d)
    size = min(2.0 * np.sqrt(noncentrality(1)) / max(seen, 1e-12), WIDE * np.sqrt(d))
    return np.full(d, size / np.sqrt(d))


def checked(ground: Ground, check: Check) -> NewRows:
    """Rows of a direct reading."""
    world, t = ground.world, tolerance_count(ground.setting)
    basics = {c.name: np.array([p.prior for p in c.cause.basic(ground.setting)]) for c in ground.candidates}
    reads = check.reads
    if reads is None:
        d = len(basics.get(check.cause, ()))
        return NewRows(np.zeros((d, t)), check.sigma * np.eye(d), {check.cause: np.eye(d)}, np.zeros((d, 0)))
    plain = reads(world)
    k = plain.shape[-1]

    def effect(moved: World, count: int, step: np.ndarray | float) -> np.ndarray:
        change: np.ndarray = (np.broadcast_to(reads(moved), (count, k)) - plain).T / step
        return change

    signature = {
        c.name: effect(
            c.cause.apply(world, _STEP * np.diag(basics[c.name])), len(basics[c.name]), _STEP * basics[c.name]
        )
        for c in ground.candidates
    }
    tolerance = effect(tolerated(ground.setting, world, _STEP * np.eye(t)), t, _STEP)
    return NewRows(tolerance, check.sigma * np.eye(k), signature, np.zeros((k, 0)))


def simulated(ground: Ground, proposal: Proposal) -> NewRows:
    """Rows of new states; what refers to the campaign as a whole (mean pose and tension) stays the campaign's."""
    setting, _ = make_setting(proposal.campaign)
    old = ground.setting.known
    setting = replace(setting, known=replace(setting.known, center=old.center, mean_tension=old.mean_tension))
    states = setting.campaign.states
    entered, readings = World.of(proposal.campaign.robot, len(states.names)), Readings.of(states)
    world = tolerated(setting, entered, ground.likeliest)
    setting = with_equilibria(setting, world)
    null, _ = null_with_bending(setting, world, readings, _DRAWS, _SEED)
    start, t = reading_count(setting), tolerance_count(setting)
    noise = np.delete(null.columns, np.s_[start : start + t], axis=1)
    effect = _effects(setting, world, readings)
    signature = {
        c.name: effect(proposal.acts.get(c.name, c.cause.apply), np.array([p.prior for p in c.cause.basic(setting)]))
        for c in ground.candidates
        if c.cause.count is None and c.name != _INTERNAL
    }
    fresh = np.zeros((len(null.r), 0))
    internal = [c for c in ground.candidates if c.name == _INTERNAL]
    if setting.sent.null_space.any() and internal:
        force, common = internal_force(setting), world.internal_force.shape[-1]
        moved = effect(force.apply, np.array([p.prior for p in force.parameters]))
        elsewhere = np.zeros((len(null.r), len(internal[0].patterns[0].basis) - common))
        signature[_INTERNAL] = np.hstack([moved[:, :common], elsewhere])
        fresh = moved[:, common:] * [p.prior for p in force.parameters[common:]]
    return NewRows(null.columns[:, start : start + t], noise, signature, fresh)


def _effects(setting: Setting, world: World, readings: Readings) -> Callable[[Apply, np.ndarray], np.ndarray]:
    """Function of a cause and the sizes (d,) of its parameters: (n, d) change of the residuals per unit of each."""
    base = residuals(setting, world, readings, small=True)

    def effect(apply: Apply, sizes: np.ndarray) -> np.ndarray:
        moved = residuals(setting, apply(world, _STEP * np.diag(sizes)), readings, small=True)
        change: np.ndarray = (moved - base).T / (_STEP * sizes)
        return change

    return effect
