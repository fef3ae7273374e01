"""The optimum of a tension distribution at fixed poses: a batch of small programs, solved together.

At a fixed pose the chord tension tau_i of a cable fixes its shape, length and force, so (5.1)-(5.9) become

    minimise  sum_i phi(T_i(tau_i))   subject to   sum_i wrench_i(tau_i) + load = 0,   floor_i <= tau_i <= ceiling_i:

force, frequency and length bounds alike are bounds on tau_i, found beforehand cable by cable. Cost and balance are
sums over the cables, so the second derivative of the Lagrangian is diagonal. Each step is a quadratic program with the
exact linearised balance and that diagonal.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.statics.batch_items import BatchItems
from cdpr_struct.statics.cable_models import HeldCables
from cdpr_struct.statics.equilibrium import cable_wrench
from cdpr_struct.statics.guessed_programs import solve_guessed, unbounded_dual
from cdpr_struct.statics.holding_tensions import HoldingProblem
from cdpr_struct.statics.minimum_norm import QuadraticPrograms
from cdpr_struct.statics.tension_cost import TensionCost

SETTLED = 1e-11  # last step over the largest chord tension
BALANCED = 1e-9  # unbalanced wrench over load and tensions that counts as none
_FALL = 0.7  # of a chord tension: most that a step takes from it
_GAIN = 1e4  # a relative gain of 1e-15 counts as a relative step of 1e-11
_STRIDE = 8  # every eighth pose of a batch is solved first
_INSIDE = 0.9  # of the distance to a bound that a step may use where the cost keeps off the bounds
_MARGIN = 1e-3  # of the bounds' distance, for the start of such a cost
_CONVEX = 0.1  # least curvature of the Lagrangian over the cost's own


@dataclass(frozen=True, slots=True)
class Effort:
    """How long a search goes on: rounds, of which so many in a row that neither reduce an unbalanced wrench nor slacken
    a cable to the limit end it, and how often a step may be halved."""

    rounds: int = 60
    stalled: int = 4
    halvings: int = 8


USUAL = Effort()
PATIENT = Effort(300, 50, 16)  # where cables as heavy as what they pull bend the balance


@dataclass(frozen=True, slots=True, eq=False)
class Optimum(BatchItems):
    """Where the search ended, flat batch (k).

    chord_tension : (k, m) [N]
    multiplier    : (k, 6) of the balance, scaled by the problem's unit
    last_step     : (k,) step that would still improve the cost, over the largest chord tension
    unbalanced    : (k,) unbalanced wrench over load and tensions
    iterations    : (k,)
    """

    chord_tension: np.ndarray
    multiplier: np.ndarray
    last_step: np.ndarray
    unbalanced: np.ndarray
    iterations: np.ndarray

    @property
    def found(self) -> np.ndarray:
        """(k,) bool: the conditions of an optimum hold."""
        return (self.last_step <= SETTLED) & (self.unbalanced <= BALANCED)


@dataclass(frozen=True, slots=True, eq=False)
class Tangent(BatchItems):
    """Cost and balance at chord tensions (k, m), with their derivatives by them.

    wrench, matrix : (k, 6), (k, 6, m) scaled by the unit;  size : (k,) load and tensions [N]
    value, slope   : (k,), (k, m) of the cost;  own : (k, m) its second derivative with the bend of the force left out
    pull_bend      : (k, m) what the bend adds to it;  bend : (k, m) second derivative of the cables' vertical forces
    """

    wrench: np.ndarray
    matrix: np.ndarray
    size: np.ndarray
    value: np.ndarray
    slope: np.ndarray
    own: np.ndarray
    pull_bend: np.ndarray
    bend: np.ndarray

    @property
    def unbalanced(self) -> np.ndarray:
        """(k,) unbalanced wrench over load and tensions."""
        return np.linalg.norm(self.wrench, axis=1) / self.size

    def improvement(self, step: np.ndarray, multiplier: np.ndarray) -> np.ndarray:
        """(k,) gain of the Lagrangian by a step, over the cost's scale, on the scale of a relative step."""
        pulled = self.slope - np.einsum("knm,kn->km", self.matrix, multiplier)
        scale = np.abs(self.slope).sum(axis=1) * self.size
        return _GAIN * np.abs((pulled * step).sum(axis=1)) / np.maximum(scale, 1e-300)


@dataclass(frozen=True, slots=True, eq=False)
class DistributionProblem:
    """A flat batch (k) of poses.

    holding        : poses, load and force bounds
    floor, ceiling : (k, m) bounds on the chord tensions [N]
    size           : (k, 1) rough size of the tensions [N]
    """

    holding: HoldingProblem
    floor: np.ndarray
    ceiling: np.ndarray
    cost: TensionCost
    size: np.ndarray

    def take(self, index: np.ndarray) -> "DistributionProblem":
        rest = self.floor[index], self.ceiling[index], self.cost, self.size[index]
        return DistributionProblem(self.holding.take(index), *rest)

    def start(self) -> np.ndarray:
        """(k, m) chord tensions [N] within the bounds from which the search may begin."""
        low, high = self.floor, np.minimum(self.ceiling, np.maximum(4.0 * self.floor, self.size))
        if self.cost.interior:
            return 0.5 * (low + self.ceiling)
        return np.clip(0.5 * (low + high), low, self.ceiling)

    def solve(self) -> Optimum:
        """Optima of all poses: some first, the others started at their neighbours."""
        count = len(self.floor)
        every = np.arange(count)
        if count < 2 * _STRIDE:
            return self.search(self.start(), None)
        some = np.unique(np.append(every[::_STRIDE], count - 1))
        first = self.take(some).search(self.take(some).start(), None)
        share = np.interp(every, some, np.arange(len(some)))
        left = np.minimum(share.astype(int), len(some) - 2)
        share = (share - left)[:, None]
        near = np.where(share[:, 0] < 0.5, left, left + 1)
        guess = (1.0 - share) * first.chord_tension[left] + share * first.chord_tension[left + 1]
        usable = np.isfinite(guess).all(axis=1, keepdims=True) & first.found[near][:, None]
        guess = np.where(usable, guess, self.start())
        solved = np.isin(every, some)
        optimum = Optimum(*(np.repeat(getattr(first, name)[:1], count, axis=0) for name in Optimum.__slots__))
        rest = np.flatnonzero(~solved)
        second = self.take(rest).search(guess[rest], first.multiplier[near[rest]])
        return optimum.replaced(some, first).replaced(rest, second)

    def search(self, start: np.ndarray, dual: np.ndarray | None = None, effort: Effort = USUAL) -> Optimum:
        """Search from chord tensions (k, m) and multipliers (k, 6)."""
        tension = self._inside(start)
        count = len(tension)
        tangent, items = self.tangent(tension), np.arange(count)
        if dual is None:
            dual = unbounded_dual(self._program(tension, tangent, np.zeros((count, 6))))
        least, stalled = np.full(count, np.inf), np.zeros(count, dtype=int)
        end = Optimum(tension, dual, np.full(count, np.inf), np.full(count, np.inf), np.zeros(count, dtype=int))
        for round_ in range(1, effort.rounds + 1):
            part = self.take(items)
            program = part._program(end.chord_tension[items], tangent, end.multiplier[items])
            step, multiplier = solve_guessed(program, end.multiplier[items])
            before = end.chord_tension[items]
            last = np.minimum(np.abs(step).max(axis=1) / before.max(axis=1), tangent.improvement(step, multiplier))
            moved, off = before + step, tangent.unbalanced
            going = (last > SETTLED) | (off > (1e-3 * BALANCED if round_ < 8 else BALANCED))
            if going.any():
                part, tangent = part.take(going), tangent.take(going)
                moved[going], tangent = part._advance(
                    before[going], step[going], tangent, multiplier[going], effort.halvings
                )
                off[going] = tangent.unbalanced
            iterations = np.full(len(items), round_)
            end = end.replaced(items, Optimum(moved, multiplier, last, off, iterations))
            falling = (step <= -0.99 * _FALL * before).any(axis=1)
            idle = (off > 0.9 * least[items]) & (off > BALANCED) & ~falling
            stalled[items] = np.where(idle, stalled[items] + 1, 0)
            least[items] = np.minimum(off, least[items])
            rest = stalled[items[going]] < effort.stalled
            items, tangent = items[going][rest], tangent.take(rest)
            if not items.size:
                break
        return end

    def hold(self, tension: np.ndarray) -> HeldCables:
        """Cables at chord tensions (k, m)."""
        return self.holding.model.hold(self.holding.arrays, self.holding.arms.points, tension)

    def tangent(self, tension: np.ndarray) -> Tangent:
        """Cost and balance around chord tensions (k, m)."""
        return self.tangent_of(self.hold(tension))

    def tangent_of(self, held: HeldCables) -> Tangent:
        """Cost and balance around cables that are held."""
        holding = self.holding
        force, rate = held.states.force_on_platform, held.force_rate
        pull = np.maximum(held.states.tension_at_platform, 1e-300)
        growth = (force * rate).sum(axis=-1) / pull
        value, slope, curvature = self.cost.terms(pull, holding.low, holding.high, self.size)
        turning = np.maximum((rate**2).sum(axis=-1) - growth**2, 0.0) / pull
        matrix = np.swapaxes(np.concatenate([rate, np.cross(holding.arms.arms, rate)], axis=-1), -1, -2)
        wrench = (cable_wrench(held.states, holding.arms) + holding.load) / holding.unit
        return Tangent(
            wrench=wrench,
            matrix=matrix / holding.unit[..., None],
            size=np.linalg.norm(holding.load / holding.unit, axis=1) + pull.sum(axis=1),
            value=value.sum(axis=1),
            slope=slope * growth,
            own=curvature * growth**2 + slope * turning,
            pull_bend=slope * (force * holding.up).sum(axis=-1) / pull * held.bend,
            bend=held.bend,
        )

    def vertical_share(self, along: np.ndarray) -> np.ndarray:
        """(k, m) part of each cable's vertical force that shows in the scaled wrench direction `along` (k, 6)."""
        scaled, lever = (along / self.holding.unit)[:, None, :], self.holding.arms.arms
        up = self.holding.up
        share: np.ndarray = (scaled[..., :3] * up + scaled[..., 3:] * np.cross(lever, up)).sum(axis=-1)
        return share

    def curvature(self, tangent: Tangent, dual: np.ndarray) -> np.ndarray:
        """(k, m) second derivative of the Lagrangian with multipliers (k, 6) by each chord tension."""
        return tangent.own + tangent.pull_bend - self.vertical_share(dual) * tangent.bend

    def own_terms(self, tension: np.ndarray, dual: np.ndarray) -> np.ndarray:
        """(k, m) what each cable adds to the Lagrangian with multipliers (k, 6)."""
        states = self.hold(tension).states
        value = self.cost.terms(states.tension_at_platform, self.holding.low, self.holding.high, self.size)[0]
        return np.asarray(value - self.shares(states.force_on_platform, dual))

    def shares(self, force: np.ndarray, along: np.ndarray) -> np.ndarray:
        """(k, m) part of the wrench of each cable's force (k, m, 3) in the scaled wrench direction `along` (k, 6)."""
        wrench = np.concatenate([force, np.cross(self.holding.arms.arms, force)], axis=-1)
        return np.asarray(np.einsum("kmn,kn->km", wrench, along / self.holding.unit))

    def _inside(self, tension: np.ndarray) -> np.ndarray:
        """Chord tensions moved into their bounds, and off them where the cost asks for it."""
        if not self.cost.interior:
            return np.clip(tension, self.floor, self.ceiling)
        margin = _MARGIN * (self.ceiling - self.floor)
        return np.clip(tension, self.floor + margin, self.ceiling - margin)

    def room(self, tension: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How far each chord tension may change in one step."""
        share = _INSIDE if self.cost.interior else 1.0
        low = np.maximum(share * (self.floor - tension), -_FALL * tension)
        return np.minimum(low, 0.0), np.minimum(share * (self.ceiling - tension), 4.0 * tension + 10.0 * self.size)

    def _program(self, tension: np.ndarray, tangent: Tangent, dual: np.ndarray) -> QuadraticPrograms:
        """The quadratic programs around chord tensions (k, m), for their change."""
        own = np.maximum(tangent.own, 1e-9 * np.abs(tangent.own).max(axis=1, keepdims=True))
        curvature = np.maximum(self.curvature(tangent, dual) + (own - tangent.own), _CONVEX * own)
        low, high = self.room(tension)
        return QuadraticPrograms(curvature, tangent.slope, tangent.matrix, -tangent.wrench, low, high)

    def _advance(
        self, tension: np.ndarray, step: np.ndarray, tangent: Tangent, dual: np.ndarray, halvings: int
    ) -> tuple[np.ndarray, Tangent]:
        """Chord tensions and tangent after the step, shortened where it neither balances nor improves."""
        price = 2.0 * np.abs(dual).max(axis=1)
        before = tangent.value + price * np.abs(tangent.wrench).sum(axis=1)
        moved = tension + step
        after = self.tangent(moved)
        factor, items = 1.0, np.arange(len(tension))
        for _ in range(halvings):
            merit = after.value[items] + price[items] * np.abs(after.wrench[items]).sum(axis=1)
            worse = merit > before[items] + 1e-9 * np.abs(before[items]) + 1e-12 * self.size[items, 0] ** 2
            items = items[worse]
            if not items.size:
                break
            factor *= 0.5
            moved[items] = tension[items] + factor * step[items]
            after = after.replaced(items, self.take(items).tangent(moved[items]))
        return moved, after
