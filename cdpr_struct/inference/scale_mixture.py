"""Noise of readings as a mixture of scales: how far is each group of readings off what its sigma states?

A group g (one reading, or several that fail together) holds d_g readings in units of their stated sigma,

    u_g ~ N(0, kappa_g^2 tau^2 I),    P(kappa_g = KAPPA[c]) = pi_c,    pi ~ Dirichlet(PSEUDO_COUNTS),

with tau and pi common to a kind of sensor. pi is integrated out. In what remains, the Dirichlet-multinomial, each
ln Gamma(alpha + n) is bounded by its chord between the integers around the expected count: n is an integer and
ln Gamma is convex, so this is a bound, tighter than that of a variational Dirichlet factor and exact where counts
are certain. tau^2 keeps its conjugate factor, a scaled inverse chi-squared distribution.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.special import digamma, gammaln, xlogy

# Factors on the stated sigma [-]: as stated, and the sizes of outliers.
KAPPA = np.array([1.0, 2.0, 5.0, 15.0, 60.0])
# Readings' worth of prior knowledge about how often each factor occurs: 4 % outliers, all sizes alike.
PSEUDO_COUNTS = np.array([30.0, 0.3, 0.3, 0.3, 0.3])
# Readings' worth of prior knowledge that stated sigmas are right (tau = 1).
TAU_DEGREES = 4.0
# Factor from which a reading is wrong rather than unlucky.
OUTLIER = 5.0
# Rounds of kappa and tau against each other per update; they are cheap beside the Gaussian part.
ROUNDS = 3


# What stands in an index in place of a group: no reading, and noise of the stated variance that is never inferred.
PADDING = -1
UNIT = -2


@dataclass(frozen=True, slots=True, eq=False)
class NoiseGroups:
    """Groups of readings that share a scale.

    kind           : (G,) kind of sensor of each group, 0, 1, ...
    fixed_variance : (G,) variance in units of the stated one where it is given (a missing reading: 1e8), nan where
                     the scale is to be inferred
    """

    kind: np.ndarray
    fixed_variance: np.ndarray

    def __post_init__(self) -> None:
        kind, fixed = np.array(self.kind, dtype=int), np.array(self.fixed_variance, dtype=float)
        if kind.ndim != 1 or fixed.shape != kind.shape:
            raise ValueError(f"NoiseGroups needs kind (G,), fixed_variance (G,), got {kind.shape}, {fixed.shape}")
        if (kind < 0).any() or not ((fixed > 0.0) & np.isfinite(fixed) | np.isnan(fixed)).all():
            raise ValueError("NoiseGroups.kind must not be negative, fixed_variance must be positive or nan")
        for name, value in (("kind", kind), ("fixed_variance", fixed)):
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    @property
    def kinds(self) -> int:
        """Number of kinds of sensors."""
        return int(self.kind.max(initial=-1)) + 1


@dataclass(frozen=True, slots=True, eq=False)
class GroupedReadings:
    """Which readings share a scale. Values per reading are tuples of (K_i, q_i), one for each stack of blocks.

    groups  : the scales
    index   : group of each reading, PADDING or UNIT
    size    : (G,) number of readings of each group
    members : (kinds, G) 1 where the scale of a group of this kind is inferred, else 0
    """

    groups: NoiseGroups
    index: tuple[np.ndarray, ...]
    size: np.ndarray = field(init=False)
    members: np.ndarray = field(init=False)
    flat: np.ndarray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        kind = self.groups.kind
        flat = np.concatenate([index.ravel() for index in self.index])
        if flat.size and not (flat.min() >= UNIT and flat.max() < len(kind)):
            raise ValueError(f"the index of readings must lie within {UNIT} and {len(kind) - 1}")
        size = np.bincount(flat - UNIT, minlength=len(kind) - UNIT)[-UNIT:]
        inferred = np.isnan(self.groups.fixed_variance) & (size > 0)
        members = 1.0 * ((np.arange(self.groups.kinds)[:, None] == kind) & inferred)
        for name, value in (("size", size), ("members", members), ("flat", flat)):
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    @property
    def inferred(self) -> np.ndarray:
        """(G,) whether the scale of a group is inferred."""
        return self.members.sum(axis=0) > 0.0

    @property
    def tau_degrees(self) -> np.ndarray:
        """(kinds,) degrees of freedom of the posterior of tau^2."""
        return TAU_DEGREES + self.members @ self.size

    def sums(self, values: Sequence[np.ndarray]) -> np.ndarray:
        """Sum over the readings of each group, to (G,)."""
        return self.sums_of(self.flat, np.concatenate([value.ravel() for value in values])[None])[0]

    def sums_of(self, owner: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Sums of values (S, Q) that belong to the groups `owner` (Q,), to (S, G)."""
        sets, width = len(values), len(self.size) - UNIT
        cell = owner - UNIT + width * np.arange(sets)[:, None]
        return np.bincount(cell.ravel(), values.ravel(), minlength=sets * width).reshape(sets, width)[:, -UNIT:]

    def spread(self, values: np.ndarray) -> tuple[np.ndarray, ...]:
        """Give each reading the value (G,) of its group; zero for padding, one for noise that is never inferred."""
        whole = np.append(values, (1.0, 0.0))
        return tuple(whole[index] for index in self.index)


@dataclass(frozen=True, slots=True, eq=False)
class NoiseState:
    """What is believed of the scales.

    responsibility : (G, 5) probability of each factor KAPPA
    tau            : (kinds,) 1/sqrt(E 1/tau^2), common factor on the stated sigmas of a kind
    variance       : (G,) effective variance in units of the stated one: 1/E[1/(kappa tau)^2], or the given one
    """

    responsibility: np.ndarray
    tau: np.ndarray
    variance: np.ndarray

    @classmethod
    def of(cls, groups: NoiseGroups, responsibility: np.ndarray, tau: np.ndarray) -> "NoiseState":
        """The state with these responsibilities (G, 5) and factors tau (kinds,)."""
        if responsibility.shape != (len(groups.kind), len(KAPPA)) or tau.shape != (groups.kinds,):
            raise ValueError(f"responsibility {responsibility.shape} and tau {tau.shape} do not fit the groups")
        inferred = tau[groups.kind] ** 2 / (responsibility @ KAPPA**-2)
        return cls(responsibility, tau, np.where(np.isnan(groups.fixed_variance), inferred, groups.fixed_variance))

    @classmethod
    def stated(cls, groups: NoiseGroups) -> "NoiseState":
        """Every reading is as good as its sigma states."""
        certain = np.zeros((len(groups.kind), len(KAPPA)))
        certain[:, 0] = 1.0
        return cls.of(groups, certain, np.ones(groups.kinds))

    @property
    def outlying(self) -> np.ndarray:
        """(G,) bool, groups that are more likely than not outliers."""
        return np.asarray(self.responsibility[:, KAPPA >= OUTLIER].sum(axis=1) > 0.5)


def updated_noise(readings: GroupedReadings, state: NoiseState, square: np.ndarray) -> NoiseState:
    """Scales given the expected squared length of the readings' errors; the bound does not fall.

    Parameters
    ----------
    square : (G,) E |u_g|^2 of each group, in units of the stated variance.
    """
    responsibility, tau, kind = state.responsibility, state.tau, readings.groups.kind
    for _ in range(ROUNDS):
        price = np.log(PSEUDO_COUNTS + np.floor(readings.members @ responsibility))[kind]
        logit = price - readings.size[:, None] * np.log(KAPPA)
        logit -= 0.5 * (square / tau[kind] ** 2)[:, None] * KAPPA**-2
        responsibility = np.exp(logit - logit.max(axis=1, keepdims=True))
        responsibility /= responsibility.sum(axis=1, keepdims=True)
        excess = readings.members @ (square * (responsibility @ KAPPA**-2))
        tau = np.sqrt((TAU_DEGREES + excess) / readings.tau_degrees)
    return NoiseState.of(readings.groups, responsibility, tau)


def mixture_bound(readings: GroupedReadings, state: NoiseState) -> float:
    """What the scales add to the bound [nat], beside the Gaussian evidence at the effective variances.

    E ln p(u | kappa, tau) - ln N(u; 0, variance) does not depend on u here, as the effective variance is that of the
    expected precision; to it come E ln p(kappa), E ln p(tau^2) and the entropies. Zero if all variances are given.
    """
    free, size, kind = readings.inferred, readings.size, readings.groups.kind
    rho = state.responsibility[free]
    shape, prior_shape = 0.5 * readings.tau_degrees, 0.5 * TAU_DEGREES
    log_tau_square = np.log(shape * state.tau**2) - digamma(shape)
    scales = 0.5 * size * (np.log(state.variance) - log_tau_square[kind])
    factors = -(rho * (size[free, None] * np.log(KAPPA)) + xlogy(rho, rho)).sum()
    return float(
        scales[free].sum() + factors + _weight_bound(readings, state) - _tau_divergence(shape, prior_shape, state.tau)
    )


def log_density_tau(tau: np.ndarray) -> np.ndarray:
    """Prior density of ln tau, up to a constant: tau^2 is scaled inverse chi-squared around 1."""
    return -TAU_DEGREES * (np.log(tau) + 0.5 / tau**2)


def _weight_bound(readings: GroupedReadings, state: NoiseState) -> float:
    """Bound of E ln p(kappa), pi integrated out: ln Gamma by its chord between neighbouring integer counts."""
    count = readings.members @ state.responsibility
    whole = np.floor(count)
    chord = gammaln(PSEUDO_COUNTS + whole) + (count - whole) * np.log(PSEUDO_COUNTS + whole) - gammaln(PSEUDO_COUNTS)
    total = PSEUDO_COUNTS.sum()
    return float(chord.sum() + (gammaln(total) - gammaln(total + readings.members.sum(axis=1))).sum())


def _tau_divergence(shape: np.ndarray, prior_shape: float, tau: np.ndarray) -> float:
    """Kullback-Leibler divergence of the posterior of tau^2 from its prior, both scaled inverse chi-squared."""
    rate, prior_rate = shape * tau**2, prior_shape
    divergence = (shape - prior_shape) * digamma(shape) - gammaln(shape) + gammaln(prior_shape)
    divergence += prior_shape * np.log(rate / prior_rate) + shape * (prior_rate - rate) / rate
    return float(divergence.sum())
