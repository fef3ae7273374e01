"""Curves of robots drawn within the tolerances, each brought to rest and computed anew: responses and vibrations.

Near a resonance no curve is linear in the robot's numbers, and a response that symmetry makes small is ruled by what
breaks the symmetry. So nothing here is to first order.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.bands.drawn_robots import drawn_rests
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.damping import Damping, ModalDamping
from cdpr_struct.dynamics.frequency_sweep import ResponseSweep, ShakenRobot, modes_below
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.dynamics.vibration_record import VibratingRobot, VibrationRecord
from cdpr_struct.robot.tolerances import Spread

MOST_LINES = 2000
"""Frequencies or instants at which bands are computed, evenly among those asked for."""


@dataclass(frozen=True, slots=True, eq=False)
class CurveBands:
    """Central bands of r curves over n places, each place by itself.

    place : (n,) frequencies [Hz] or instants [s];  low, middle, high : (r, n), the median in the middle
    largest : (r, 2) ends of the band of each curve's largest size;  largest_at : (r, 2) and of the place where it is
    count : drawn robots at rest;  lost : further ones that did not come to a stable rest
    """

    place: np.ndarray
    low: np.ndarray
    middle: np.ndarray
    high: np.ndarray
    largest: np.ndarray
    largest_at: np.ndarray
    count: int
    lost: int

    @classmethod
    def of(cls, place: np.ndarray, curves: np.ndarray, level: float, lost: int) -> "CurveBands":
        """Of curves (robots, n, r)."""
        ends = [0.5 - 0.5 * level, 0.5, 0.5 + 0.5 * level]
        low, middle, high = np.swapaxes(np.quantile(curves, ends, axis=0), 1, 2)
        size = np.abs(curves)
        largest = np.quantile(size.max(axis=1), ends[::2], axis=0).T
        largest_at = np.quantile(place[size.argmax(axis=1)], ends[::2], axis=0).T
        return cls(place, low, middle, high, largest, largest_at, len(curves), lost)


def thinned_lines(values: np.ndarray) -> np.ndarray:
    """Numbers of at most `MOST_LINES` of some values, evenly chosen, both ends among them."""
    count = min(len(values), MOST_LINES)
    return np.unique(np.linspace(0, len(values) - 1, count).round().astype(int))


def response_bands(
    sweep: ResponseSweep, law: Damping, spread: Spread, level: float, samples: int, assembly: Assembly = "consistent"
) -> CurveBands:
    """Magnitudes of frequency responses, SI units, at even lines.

    sweep : of the robot as entered;  law : of damping, that of every drawn robot, too
    """
    response, even = sweep.response, sweep.evenly.hertz
    hertz = even[thinned_lines(even)]
    band = float(hertz[0]), float(hertz[-1])

    def magnitude(point: OperatingPoint) -> np.ndarray:
        cables = cable_dynamics(point, sweep.model, 2.0 * np.pi * band[1] * ShakenRobot.margin(response.excite))
        known = np.zeros(0)
        if isinstance(law, ModalDamping):
            known = modes_below(point, cables, band[1], assembly).hertz
        shaken = ShakenRobot(point, cables, law, response.excite, response.respond, response.quantity, assembly)
        return np.abs(shaken.function(band, known).at(hertz))

    return _bands(sweep.point, magnitude, hertz, spread, level, samples)


def vibration_bands(
    vibrating: VibratingRobot,
    record: VibrationRecord,
    again: Callable[[VibratingRobot], np.ndarray],
    spread: Spread,
    level: float,
    samples: int,
) -> CurveBands:
    """Displacements of every port over time [m], [rad].

    vibrating : the robot as entered;  record : of its vibration;  again : displacements (n, r) of a drawn one
    """
    time = record.vibration.time
    chosen = thinned_lines(time)

    def displacement(point: OperatingPoint) -> np.ndarray:
        return again(replace(vibrating, point=point))[chosen]

    return _bands(record.point, displacement, time[chosen], spread, level, samples)


def _bands(
    point: OperatingPoint,
    curve: Callable[[OperatingPoint], np.ndarray],
    place: np.ndarray,
    spread: Spread,
    level: float,
    samples: int,
) -> CurveBands:
    rests, kept = drawn_rests(point, spread, samples)
    curves = np.array([curve(one) for one in each_robot(rests)]).reshape((len(kept), len(place), -1))
    return CurveBands.of(place, curves, level, samples - len(kept))


def each_robot(rests: OperatingPoint) -> Iterator[OperatingPoint]:
    """Robots at rest (n), one by one and without a batch axis."""
    for number in range(len(rests.position)):
        robot, cables = rests.arrays.take(np.array(number)), rests.cables.at(number)
        yield OperatingPoint(robot, rests.position[number], rests.rotation[number], cables)
