"""Bands of predictions: what was asked, and what results say of them."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from cdpr_struct.bands.drawn_robots import DrawnRobots, drawn_robots
from cdpr_struct.bands.frequency_bands import FrequencyBands, frequency_bands
from cdpr_struct.bands.likeliest_robot import at_the_means
from cdpr_struct.bands.locked_response import LockedResponse, locked_response
from cdpr_struct.bands.mode_rates import ModeRates, mode_rates
from cdpr_struct.bands.rest_bands import rest_bands
from cdpr_struct.crosscheck.robot_modes import MODELS, robot_modes
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.errors import CdprError, InputError
from cdpr_struct.interface.arguments import one_of, real, whole
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports.bands_told import frequencies_told, rest_told, slack_check
from cdpr_struct.reports.tolerances_told import of_a_robot
from cdpr_struct.reports.trust import Check
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.tolerances import Spread, Tolerances

MOST_SAMPLES = 100_000
FEWEST_SAMPLES = 20
BANDED_MODELS = ("sagging", "spring")
"""Cables at rest whose robots have bands."""
_LEVELS = "a level above 0 and below 100 in per cent, like 90"


@dataclass(frozen=True, slots=True)
class AskedBand:
    """Level of central bands, 0 to 1, and by how many drawn robots they are checked, 0 for none."""

    level: float
    samples: int = 0


def read_band(band: float | None, samples: int | None = None, name: str = "band") -> AskedBand | None:
    """What was asked; None if no band was.

    name : of the argument that says the level

    Raises
    ------
    InputError : no such level, or samples without a band.
    """
    if band is None:
        if samples is not None:
            raise InputError("samples", "", samples, f"it belongs to `{name}`; give that, too, or leave it out")
        return None
    level = 0.01 * real(band, name, f"give {_LEVELS}", 0.0, 100.0)
    return AskedBand(level, 0 if samples is None else whole(samples, "samples", FEWEST_SAMPLES, MOST_SAMPLES))


def spread_of(robot: Robot) -> Spread:
    """Robots that are probable at a rest: after a diagnosis its posterior, else those within the tolerances; with what
    it left unexplained."""
    known = robot.posterior or Spread.within(Tolerances(**robot.tolerances), len(robot.cables))
    return known if robot.remainder is None else robot.remainder.beside(known, len(robot.cables))


def known_from(robot: Robot) -> str:
    """What says which robots are probable: "diagnosis" or "tolerances"."""
    return "tolerances" if robot.posterior is None else "diagnosis"


def band_head(asked: AskedBand, robot: Robot) -> dict[str, Any]:
    """What every key `bands` says first: level, what is held, and which robots are probable."""
    return {
        "level": 100.0 * asked.level,
        "held": "locked lengths",
        "known_from": known_from(robot),
        "tolerances": of_a_robot(robot.tolerances),
    }


@dataclass(frozen=True, slots=True, eq=False)
class Banded:
    """A robot at rest whose numbers may be off: what its predictions do then.

    origin : as entered, or as a diagnosis extended it
    point : with its likeliest numbers, which are the same without a diagnosis
    spread : which robots are probable, about the likeliest
    """

    origin: OperatingPoint
    point: OperatingPoint
    asked: AskedBand
    response: LockedResponse
    spread: Spread
    model: str
    assembly: Assembly

    @classmethod
    def at(
        cls, point: OperatingPoint, asked: AskedBand, stable: bool, model: str = "sagging",
        assembly: Assembly = "consistent",
    ) -> "Banded":  # fmt: skip
        """Of a robot at rest with sagging or spring cables.

        Raises
        ------
        CdprError : the platform is not held there.
        InputError : ideal cables, or a winch that holds a tension.
        """
        one_of(model, "model", BANDED_MODELS)
        require_locked_lengths(point.entered, "a band is that of locked lengths")
        if not stable:
            raise CdprError("there is no band: the platform is not held there, and a small change moves it far")
        there, spread = at_the_means(point, spread_of(point.entered), model)
        return cls(point, there, asked, locked_response(there, assembly, model, spread), spread, model, assembly)

    def rest(self) -> tuple[dict[str, Any], list[Check]]:
        """Key `bands` of a result about a state of rest, and what is to be doubted."""
        found = rest_bands(self.point, self.response, self.spread, self.asked.level)
        drawn = self._drawn(None)
        return self._head() | rest_told(found, drawn, self.asked.level), self._checks(drawn)

    def frequencies(self, hertz: np.ndarray, model: str) -> tuple[dict[str, Any], list[Check]]:
        """The same of a result about frequencies (k,) [Hz], as a model of the cables has them."""
        vibrating = hertz > 0.0
        likeliest = hertz
        if self.point is not self.origin:
            likeliest = robot_modes(self.point, one_of(model, "model", MODELS), len(hertz), self.assembly).hertz
        found = _of_modes(self, likeliest[vibrating], model)
        drawn = self._drawn(hertz[vibrating] if vibrating.any() else None, model)
        told = frequencies_told(found, hertz, drawn, self.asked.level)
        return self._head() | told, self._checks(drawn)

    def rates(self, hertz: np.ndarray, model: str) -> ModeRates:
        """Rates of frequencies (k,) [Hz] above zero, as a model of the cables has them, and of some beyond."""
        return mode_rates(self.point, hertz, self.response, self.spread, self.assembly, vibrating_like(model))

    def _drawn(self, hertz: np.ndarray | None, model: str = "exact") -> DrawnRobots | None:
        if not self.asked.samples:
            return None
        models = self.assembly, self.model, vibrating_like(model)
        return drawn_robots(self.origin, spread_of(self.origin.entered), self.asked.samples, hertz, *models)

    def _head(self) -> dict[str, Any]:
        return band_head(self.asked, self.origin.entered)

    def _checks(self, drawn: DrawnRobots | None) -> list[Check]:
        return slack_check(self.point.cables.tension_at_platform, self.spread.sigma(self.response.tension), drawn)


def vibrating_like(model: str) -> CableModel:
    """The model whose rates the frequencies of a model have."""
    return "static" if model == "static" else "exact"


def _of_modes(banded: Banded, hertz: np.ndarray, model: str) -> FrequencyBands:
    if not len(hertz):
        return FrequencyBands(hertz, hertz, hertz, [])
    return frequency_bands(banded.rates(hertz, model), banded.spread, banded.asked.level)
