"""Noise of readings as a mixture of scales: how far is each group of readings off what its sigma states?

A group g (one reading, or several that fail together) holds d_g readings in units of their stated sigma,

    u_g ~ N(0, kappa_g^2 tau^2 I),    P(kappa_g = KAPPA[c]) = pi_c,    pi ~ Dirichlet(PSEUDO_COUNTS),

with tau and pi common to a kind of sensor. pi is integrated out. In what remains, the Dirichlet-multinomial, each
ln Gamma(alpha + n) is bounded by its chord between the integers around the expected count: n is an integer and
ln Gamma is convex, so this is a bound, tighter than that of a variational Dirichlet factor and exact where counts
are certain. tau^2 keeps its conjugate factor, a scaled inverse chi-squared distribution.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.special import digamma, gammaln, xlogy

# Factors on the stated sigma [-]: as stated, and the sizes of outliers.
KAPPA = np.array([1.0, 2.0, 5.0, 15.0, 60.0])
# Readings' worth of prior knowledge about how often each factor occurs: 4 % outliers, all sizes alike.
PSEUDO_COUNTS = np.array([30.0, 0.3, 0.3, 0.3, 0.3])
# Readings' worth of prior knowledge that stated sigmas are right (tau = 1).
TAU_DEGREES = 4.0
# Rounds of kappa and tau against each other per update; they are cheap beside the Gaussian part.
ROUNDS = 3


@dataclass(frozen=True, slots=True, eq=False)
class NoiseGroups:
    """Which readings share a scale.

    index          : (K, q) group of each reading of each block, -1 for padding
    kind           : (G,) kind of sensor of each group, 0, 1, ...
    fixed_variance : (G,) variance in units of the stated one where it is given (a missing reading: 1e8), nan where
                     the scale is to be inferred
    size           : (G,) number of readings of each group
    members        : (kinds, G) 1 where the scale of a group of this kind is inferred, else 0
    """

    index: np.ndarray
    kind: np.ndarray
    fixed_variance: np.ndarray
    size: np.ndarray = field(init=False)
    members: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        index, kind = np.array(self.index, dtype=int), np.array(self.kind, dtype=int)
        fixed = np.array(self.fixed_variance, dtype=float)
        if index.ndim != 2 or kind.ndim != 1 or fixed.shape != kind.shape:
            shapes = f"index {index.shape}, kind {kind.shape}, fixed_variance {fixed.shape}"
            raise ValueError(f"NoiseGroups needs index (K, q), kind (G,), fixed_variance (G,), got {shapes}")
        if index.size and not (index.min() >= -1 and index.max() < len(kind)):
            raise ValueError(f"NoiseGroups.index must lie within -1 and {len(kind) - 1}")
        if (kind < 0).any() or not ((fixed > 0.0) & np.isfinite(fixed) | np.isnan(fixed)).all():
            raise ValueError("NoiseGroups.kind must not be negative, fixed_variance must be positive or nan")
        size = np.bincount(index.ravel() + 1, minlength=len(kind) + 1)[1:]
        inferred = np.isnan(fixed) & (size > 0)
        members = (np.arange(kind.max(initial=-1) + 1)[:, None] == kind) & inferred
        arrays = {"index": index, "kind": kind, "fixed_variance": fixed, "size": size, "members": 1.0 * members}
        for name, value in arrays.items():
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

    def sums(self, values: np.ndarray) -> np.ndarray:
        """Sum over the readings of each group, (K, q) to (G,)."""
        return self.sums_of(self.index, values[None])[0]

    def sums_of(self, index: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Sums of values (S, K, q) that belong to the groups `index` (K, q), to (S, G)."""
        sets, width = len(values), len(self.kind) + 1
        cell = (index + 1).ravel() + width * np.arange(sets)[:, None]
        return np.bincount(cell.ravel(), values.ravel(), minlength=sets * width).reshape(sets, width)[:, 1:]

    def spread(self, values: np.ndarray) -> np.ndarray:
        """Give each reading the value of its group, (G,) to (K, q); zero for padding."""
        return np.append(values, 0.0)[self.index]


@dataclass(frozen=True, slots=True, eq=False)
class NoiseState:
    """What is believed of the scales.

    responsibility : (G, 5) probability of each factor KAPPA
    tau            : (kinds,) 1/sqrt(E 1/tau^2), common factor on the stated sigmas of a kind
    variance       : (G,) effective variance in units of the stated one: 1/E[1/(kappa tau)^2], or the given one
    weight         : (kinds, 5) expected pi
    """

    responsibility: np.ndarray
    tau: np.ndarray
    variance: np.ndarray
    weight: np.ndarray

    @classmethod
    def of(cls, groups: NoiseGroups, responsibility: np.ndarray, tau: np.ndarray) -> "NoiseState":
        """The state with these responsibilities (G, 5) and factors tau (kinds,)."""
        if responsibility.shape != (len(groups.kind), len(KAPPA)) or tau.shape != groups.members.shape[:1]:
            raise ValueError(f"responsibility {responsibility.shape} and tau {tau.shape} do not fit the groups")
        inferred = tau[groups.kind] ** 2 / (responsibility @ KAPPA**-2)
        variance = np.where(np.isnan(groups.fixed_variance), inferred, groups.fixed_variance)
        counts = PSEUDO_COUNTS + groups.members @ responsibility
        return cls(responsibility, tau, variance, counts / counts.sum(axis=1, keepdims=True))

    @classmethod
    def stated(cls, groups: NoiseGroups) -> "NoiseState":
        """Every reading is as good as its sigma states."""
        certain = np.zeros((len(groups.kind), len(KAPPA)))
        certain[:, 0] = 1.0
        return cls.of(groups, certain, np.ones(len(groups.members)))


def updated_noise(groups: NoiseGroups, state: NoiseState, square: np.ndarray) -> NoiseState:
    """Scales given the expected squared length of the readings' errors; the bound does not fall.

    Parameters
    ----------
    square : (G,) E |u_g|^2 of each group, in units of the stated variance.
    """
    responsibility, tau = state.responsibility, state.tau
    for _ in range(ROUNDS):
        price = np.log(PSEUDO_COUNTS + np.floor(groups.members @ responsibility))[groups.kind]
        logit = price - groups.size[:, None] * np.log(KAPPA)
        logit -= 0.5 * (square / tau[groups.kind] ** 2)[:, None] * KAPPA**-2
        responsibility = np.exp(logit - logit.max(axis=1, keepdims=True))
        responsibility /= responsibility.sum(axis=1, keepdims=True)
        excess = groups.members @ (square * (responsibility @ KAPPA**-2))
        tau = np.sqrt((TAU_DEGREES + excess) / groups.tau_degrees)
    return NoiseState.of(groups, responsibility, tau)


def mixture_bound(groups: NoiseGroups, state: NoiseState) -> float:
    """What the scales add to the bound [nat], beside the Gaussian evidence at the effective variances.

    E ln p(u | kappa, tau) - ln N(u; 0, variance) does not depend on u here, as the effective variance is that of the
    expected precision; to it come E ln p(kappa), E ln p(tau^2) and the entropies. Zero if all variances are given.
    """
    free, size = groups.inferred, groups.size
    rho = state.responsibility[free]
    shape, prior_shape = 0.5 * groups.tau_degrees, 0.5 * TAU_DEGREES
    log_tau_square = np.log(shape * state.tau**2) - digamma(shape)
    scales = 0.5 * size * (np.log(state.variance) - log_tau_square[groups.kind])
    factors = -(rho * (size[free, None] * np.log(KAPPA)) + xlogy(rho, rho)).sum()
    return float(
        scales[free].sum() + factors + _weight_bound(groups, state) - _tau_divergence(shape, prior_shape, state.tau)
    )


def log_density_tau(tau: np.ndarray) -> np.ndarray:
    """Prior density of ln tau, up to a constant: tau^2 is scaled inverse chi-squared around 1."""
    return -TAU_DEGREES * (np.log(tau) + 0.5 / tau**2)


def _weight_bound(groups: NoiseGroups, state: NoiseState) -> float:
    """Bound of E ln p(kappa), pi integrated out: ln Gamma by its chord between neighbouring integer counts."""
    count = groups.members @ state.responsibility
    whole = np.floor(count)
    chord = gammaln(PSEUDO_COUNTS + whole) + (count - whole) * np.log(PSEUDO_COUNTS + whole) - gammaln(PSEUDO_COUNTS)
    total = PSEUDO_COUNTS.sum()
    return float(chord.sum() + (gammaln(total) - gammaln(total + groups.members.sum(axis=1))).sum())


def _tau_divergence(shape: np.ndarray, prior_shape: float, tau: np.ndarray) -> float:
    """Kullback-Leibler divergence of the posterior of tau^2 from its prior, both scaled inverse chi-squared."""
    rate, prior_rate = shape * tau**2, prior_shape
    divergence = (shape - prior_shape) * digamma(shape) - gammaln(shape) + gammaln(prior_shape)
    divergence += prior_shape * np.log(rate / prior_rate) + shape * (prior_rate - rate) / rate
    return float(divergence.sum())
