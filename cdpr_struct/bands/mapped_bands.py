"""Bands of a quantity at many poses, and with which probability it falls below a limit there."""

from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from cdpr_struct.bands.drawn_robots import drawn_rests, drawn_robots
from cdpr_struct.bands.frequency_bands import chance_above, drawn_changes, frequency_bands
from cdpr_struct.bands.likeliest_robot import about_the_means, likeliest_rests
from cdpr_struct.bands.locked_response import LockedStations, locked_response
from cdpr_struct.bands.mode_rates import mode_rates
from cdpr_struct.bands.pose_error_bands import ErringRobot
from cdpr_struct.bands.rest_quantities import REST_QUANTITIES
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.certified_modes import certified_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import stability_at
from cdpr_struct.errors import CdprError
from cdpr_struct.robot.fingerprint import fingerprint
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.tolerances import Spread
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.statics.pose_error import pose_error
from cdpr_struct.workspace.margins import stable_where_held
from cdpr_struct.workspace.quantities import evaluate, quantity_of
from cdpr_struct.workspace.work_list import Columns

FREQUENCIES: dict[str, CableModel] = {
    "first-frequency": "exact", "frequencies": "exact", "platform-frequency": "static",
}  # fmt: skip
POSE_ERRORS = {"pose-error": 2, "pose-error-axial": 5, "pose-error-sag": 8}
"""Where the error along z stands among the numbers of `PoseErrorBands`."""
BANDED = (*FREQUENCIES, *POSE_ERRORS, *REST_QUANTITIES)
"""Names of the quantities that have bands."""
ENDS = ("low", "high", "sigma")
DRAWN = ("drawn_low", "drawn_high")
BELOW, DRAWN_BELOW = "probability_below", "drawn_below"
SLACK, LOST = "slack_sigmas", "drawn_lost"
POSES_AT_ONCE = 16
"""Poses of a batch: some seconds, after which the progress is told and kept."""
_TINY = 1e-12
_Told: TypeAlias = dict[str, float]


def band_column(quantity: str, what: str) -> str:
    """Name of a column: ends, sigma and ends of drawn robots carry the quantity's name and unit."""
    if what not in (*ENDS, *DRAWN):
        return what
    own = quantity_of(quantity)
    unit = "_" + own.unit.replace("/", "_")
    return f"{own.column.removesuffix(unit)}_{what}{unit}"


@dataclass(frozen=True, slots=True, eq=False)
class BandedQuantity:
    """What computes a batch of a map with bands; it can be sent to another process.

    quantity : one of `BANDED`;  spread : which robots are probable, about the one as entered
    level    : of the central bands, 0 to 1;  limit : below which the quantity may fall, in its unit, or None
    samples  : so many robots drawn at each pose, brought to rest anew, 0 for none

    Columns beside those of the quantity, nan where the pose is not held or not stable, or the likeliest robot not:
    `ENDS` and with samples `DRAWN`, in its unit (`band_column`); with a limit `BELOW` and `DRAWN_BELOW`; `SLACK`, the
    least tension of a cable in sigmas of itself; `LOST`, the drawn robots without a stable rest.
    """

    quantity: str
    spread: Spread
    level: float
    limit: float | None = None
    samples: int = 0
    about: Spread = field(init=False)
    changes: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "about", about_the_means(self.spread))
        object.__setattr__(self, "changes", drawn_changes(self.about))

    def __str__(self) -> str:
        """Everything that the columns depend on beside robot and poses."""
        asked = f"band {self.level!r} limit {self.limit!r} samples {self.samples}"
        own = self.spread
        found = " ".join(one.field for one in own.found)
        return f"{asked} within {fingerprint(f'spread {found}', own.root, own.mean, np.array(own.scatter))}"

    def __call__(
        self, robot: Robot, position: np.ndarray, rotation: np.ndarray, found: InverseSolution | None = None
    ) -> Columns:
        turned = np.broadcast_to(rotation, (len(position), 3, 3))
        if self.quantity in POSE_ERRORS:
            columns = evaluate(self.quantity, robot, position, rotation)
            good = columns["held"] & columns["stable"]
            told = self._pose_errors(robot, position[good], turned[good])
        else:
            solution = inverse(robot, position, rotation, allow_unheld=True) if found is None else found
            columns = evaluate(self.quantity, robot, position, rotation, solution)
            good = stable_where_held(robot, position, turned, solution)
            value = columns[quantity_of(self.quantity).column]
            good &= np.isfinite(value)
            points = [
                OperatingPoint(robot, position[i], turned[i], solution.cables.at(int(i))) for i in np.flatnonzero(good)
            ]
            told = self._at_rests(robot, points, value[good])
        return columns | self._columns(good, told)

    def _columns(self, good: np.ndarray, told: list[_Told]) -> Columns:
        names = [*ENDS, SLACK, *([] if self.limit is None else [BELOW])]
        if self.samples:
            names += [*DRAWN, LOST, *([] if self.limit is None else [DRAWN_BELOW])]
        columns = {}
        for name in names:
            values = np.full(len(good), np.nan)
            values[good] = [row.get(name, np.nan) for row in told]
            columns[band_column(self.quantity, name)] = values
        return columns

    def _at_rests(self, robot: Robot, entered: list[OperatingPoint], value: np.ndarray) -> list[_Told]:
        """The robot as entered at rest at n poses, where the quantity has values (n,)."""
        rests = likeliest_rests(entered, self.spread)
        if self.quantity not in FREQUENCIES:
            return [self._at_rest(robot, *both) for both in zip(entered, rests, strict=True)]
        return [self._frequency(*at) for at in zip(entered, value, rests, strict=True)]

    def _at_rest(self, robot: Robot, entered: OperatingPoint, point: OperatingPoint | None) -> _Told:
        """A robot at rest as entered and as it most probably is."""
        if point is None:
            return {}
        quantity, stations = REST_QUANTITIES[self.quantity], LockedStations.about(point, spread=self.about)
        there = OperatingPoint(point.arrays, point.position[None], point.rotation[None], point.cables.at(None))
        rates = stations.slope(quantity.smooth(stations.rests))
        drawn = quantity.reduced(robot, quantity.smooth(there) + self.changes @ rates)
        told = self._of_draws(drawn) | self._slack(point, stations.slope(stations.rests.cables.tension_at_platform))
        if not self.samples:
            return told
        rests, kept = drawn_rests(entered, self.spread, self.samples)
        return told | self._of_robots(quantity.reduced(robot, quantity.smooth(rests)), self.samples - len(kept))

    def _frequency(self, entered: OperatingPoint, hertz: float, point: OperatingPoint | None) -> _Told:
        """The first frequency of a robot, hertz as entered [Hz], about the robot as it most probably is."""
        if point is None:
            return {}
        response, model = locked_response(point, spread=self.about), FREQUENCIES[self.quantity]
        first = np.array([hertz])
        try:
            likeliest = first if point is entered else _first_above_zero(point, model)
            rates = mode_rates(point, likeliest, response, self.about, model=model)
        except CdprError:  # no band where the rates are those of another mode
            return {}
        bands = frequency_bands(rates, self.about, self.level)
        told = dict(zip(ENDS, (bands.low[0], bands.high[0], bands.sigma[0] * likeliest[0]), strict=True))
        if self.limit is not None:
            told[BELOW] = 1.0 - chance_above(rates, self.about, 0, max(self.limit, _TINY))
        told |= self._slack(point, response.tension)
        if not self.samples:
            return told
        drawn = drawn_robots(entered, self.spread, self.samples, first, vibrating=model)
        return told | self._of_robots(drawn.hertz[:, 0], drawn.lost)

    def _pose_errors(self, robot: Robot, position: np.ndarray, rotation: np.ndarray) -> list[_Told]:
        """The errors along z at reference poses (n, 3), (n, 3, 3) [mm]."""
        poses = zip(position, rotation, strict=True)
        entered = [ErringRobot.of(robot, pose_error(robot, *pose)) for pose in poses]
        likeliest = ErringRobot.likeliest(entered, self.spread)
        return [self._pose_error(*both) for both in zip(entered, likeliest, strict=True)]

    def _pose_error(self, entered: ErringRobot, erring: ErringRobot | None) -> _Told:
        if erring is None:
            return {}
        response, which = locked_response(erring.sagging, spread=self.about), POSE_ERRORS[self.quantity]
        drawn = 1e3 * (erring.numbers().components + self.changes @ erring.rates(response, self.about))[:, which]
        told = self._of_draws(drawn) | self._slack(erring.sagging, response.tension)
        if not self.samples:
            return told
        errors, rests = entered.drawn(self.spread, self.samples)
        return told | self._of_robots(1e3 * errors[:, which], rests.lost)

    def _of_draws(self, drawn: np.ndarray) -> _Told:
        told = dict(zip(ENDS, (*self._ends(drawn), float(drawn.std())), strict=True))
        return told if self.limit is None else told | {BELOW: float((drawn < self.limit).mean())}

    def _of_robots(self, values: np.ndarray, lost: int) -> _Told:
        told = dict(zip(DRAWN, self._ends(values), strict=True)) | {LOST: float(lost)}
        return told if self.limit is None else told | {DRAWN_BELOW: float((values < self.limit).mean())}

    def _ends(self, values: np.ndarray) -> tuple[float, float]:
        low, high = np.quantile(values, [0.5 - 0.5 * self.level, 0.5 + 0.5 * self.level])
        return float(low), float(high)

    def _slack(self, point: OperatingPoint, rates: np.ndarray) -> _Told:
        """Least tension of a cable in sigmas of itself; rates (p, m) of the tensions."""
        sigma = np.maximum(self.about.sigma(rates), _TINY)
        return {SLACK: float((point.cables.tension_at_platform / sigma).min())}


def _first_above_zero(point: OperatingPoint, model: CableModel) -> np.ndarray:
    """(1,) frequency of a robot at rest [Hz]."""
    return certified_frequencies(point, model, 1 + int(stability_at(point).neutral)).hertz[-1:]
