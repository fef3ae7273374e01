"""Which cables the printed limits are tried on."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.crosscheck.limits_groups import CableGroups, inside_printed_limits

MAX_STRAIN = 0.03  # tau / EA: steel ropes carry 0.5 %, aramid 2 %, high-modulus polyethylene breaks at 3.5 %
MAX_WEIGHT = 1.5  # mu g l_c / tau: a vertical cable goes slack at its lower end at 2


@dataclass(frozen=True, slots=True, eq=False)
class Domain:
    """A grid over inclination [deg], epsilon and lambda^2, each ascending."""

    inclination_deg: np.ndarray
    epsilon: np.ndarray
    lambda_squared: np.ndarray

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of inclinations, epsilons and lambda^2."""
        return len(self.inclination_deg), len(self.epsilon), len(self.lambda_squared)

    def cables(self) -> tuple[CableGroups, np.ndarray, np.ndarray]:
        """Cables of the grid that exist (strain and weight within bounds), their flat numbers and their volumes.

        Volume is measured in inclination, log epsilon and log lambda^2.
        """
        axes = np.meshgrid(self.inclination_deg, self.epsilon, self.lambda_squared, indexing="ij")
        groups = CableGroups.of(*axes)
        widths = [
            np.gradient(axis) for axis in (self.inclination_deg, np.log(self.epsilon), np.log(self.lambda_squared))
        ]
        volume = np.einsum("i,j,k->ijk", *widths).ravel()
        number = np.flatnonzero((groups.strain <= MAX_STRAIN) & (groups.weight <= MAX_WEIGHT))
        return groups.take(number), number, volume[number]


def _spread(first: float, last: float, count: int, *included: float) -> np.ndarray:
    """Logarithmic spread that contains `included` in place of the nearest members."""
    values = np.geomspace(first, last, count)
    for value in included:
        values[np.abs(np.log(values / value)).argmin()] = value
    return values


FULL = Domain(
    np.array([0.0, 10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 87.0]),
    _spread(0.003, 0.8, 20, 0.1, 0.24),
    _spread(0.05, 500.0, 36, 24.0, 4.0 * np.pi**2, 16.0 * np.pi**2),
)
SMALL = Domain(
    np.array([0.0, 30.0, 60.0, 80.0]),
    _spread(0.01, 0.5, 6, 0.1, 0.24),
    _spread(0.2, 100.0, 7, 24.0, 4.0 * np.pi**2),
)


def random_cables(count: int, seed: int = 2015) -> CableGroups:
    """About `count` random cables inside the printed limits, to check on what was read off the grid."""
    random = np.random.default_rng(seed)
    drawn = CableGroups.of(
        random.uniform(0.0, 60.0, 40 * count),
        np.exp(random.uniform(np.log(0.003), np.log(0.24), 40 * count)),
        np.exp(random.uniform(np.log(0.05), np.log(24.0), 40 * count)),
    )
    allowed = inside_printed_limits(drawn) & (drawn.strain <= MAX_STRAIN)
    return drawn.take(np.flatnonzero(allowed)[:count])
