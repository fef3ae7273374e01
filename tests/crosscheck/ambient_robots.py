"""Twenty robots in random forces: the modes that their ambient records show, beside those of the finite-element model.

python -m tests.crosscheck.ambient_robots [MINUTES] [ROBOTS]     (two minutes for 10 min and 20 robots)

Eight robots that no one designed, six of six cables in three pairs at 120 degrees, and six of eight cables at the
corners of a box: all but symmetric, so that pairs of modes nearly coincide. Forces are white and act on the platform,
all modes have 0.5 % damping, three accelerometers of three axes have noise of 2 % of the vibration.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError
from cdpr_struct.measurement.ambient_choice import AmbientChoice
from cdpr_struct.measurement.ambient_records import AmbientRecord, identified
from cdpr_struct.measurement.campaign import AMBIENT, Sigmas
from cdpr_struct.measurement.signal_records import SignalRecord
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.random_robots import random_robot

Maker = Callable[[np.random.Generator], Robot]

DAMPING, NOISE, SEED = 0.005, 0.02, 20261127
VISIBLE = 0.15  # share of the kinetic energy in the platform of the modes that must be found
LOWEST = 0.8  # Hz, of the first such mode: below it ten minutes do not hold a frequency to 0.2 %
ELEMENTS, MODES = 12, 120
NEAR = 0.03  # of a frequency: how far the identified mode may be
SINGLE, DOUBLE = (
    0.005,
    0.01,
)  # of a frequency: farther from all modes one is invented; nearer to each other two are a pair


CHANNELS = tuple(f"a{axis}_{place}" for place in "123" for axis in "xyz")


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """A robot's v visible modes beside the identified ones.

    hertz, found, sigma : (v,) [Hz] of the FEM, identified (nan: missed), its sigma;  pair (v,) bool, near another one
    invented : identified modes that no mode of the FEM is near;  more : identified modes of the cables
    """

    name: str
    hertz: np.ndarray
    found: np.ndarray
    sigma: np.ndarray
    pair: np.ndarray
    invented: int
    more: int

    @property
    def off(self) -> np.ndarray:
        """(v,) error in sigmas."""
        return np.asarray((self.found - self.hertz) / self.sigma)


def robots(count: int) -> list[tuple[str, fem.RobotModes, float, float]]:
    """Names, modes, masses [kg] and radii of gyration [m] of the first robots."""
    generator = np.random.default_rng(SEED)
    makers = [random_robot] * 8 + [six_cables] * 6 + [eight_cables] * 6
    return [(f"{make.__name__} {i + 1}", *vibrating(make, generator)) for i, make in enumerate(makers[:count])]


def vibrating(make: Maker, generator: np.random.Generator) -> tuple[fem.RobotModes, float, float]:
    """Modes, mass [kg] and radius of gyration [m] of the next robot that rests in the middle of its frame."""
    while True:
        robot = make(generator)
        modes = _modes(robot, generator)
        seen = () if modes is None else modes.frequencies_hz[modes.platform_energy > VISIBLE]
        if modes is not None and len(seen) >= 6 and seen[0] > LOWEST:
            body = robot.platform
            return modes, body.mass, float(np.sqrt(np.trace(body.inertia) / 3.0 / body.mass))


def record_of(
    modes: fem.RobotModes, mass: float, radius: float, minutes: float, generator: np.random.Generator
) -> SignalRecord:
    """Ambient record of a robot, sampled for the sixth of its modes that move the platform."""
    seen = modes.frequencies_hz[modes.platform_energy > VISIBLE]
    rate = 3.5 * float(seen[5])
    count = round(60.0 * minutes * rate)
    force = mass * np.array([1.0, 1.0, 1.0, radius, radius, radius])
    sensors = sensors_on(radius)
    signal = fem.ambient_record(modes, DAMPING, force, sensors, rate, count, generator)
    signal = signal + NOISE * signal.std() * generator.normal(size=signal.shape)
    unknown = np.full(6, np.nan)
    return SignalRecord(
        AMBIENT, "wind", "wind.csv", np.arange(count) / rate, signal, CHANNELS, unknown[:3], unknown[3:], 0.0, unknown
    )


def sensors_on(radius: float) -> np.ndarray:
    """(9, 6) what three accelerometers of three axes read of the platform's motion."""
    places = radius * np.array([[1.0, 0.0, 0.0], [-0.5, 0.8, 0.3], [-0.5, -0.8, -0.3]])
    return np.array([[*axis, *np.cross(place, axis)] for place in places for axis in np.eye(3)])


def compared(name: str, modes: fem.RobotModes, radius: float, one: AmbientRecord) -> Compared:
    """Visible modes of the band beside the identified ones; pairs by nearness of frequencies and shapes."""
    inside = (modes.platform_energy > VISIBLE) & (modes.frequencies_hz < one.band[1])
    hertz, found = modes.frequencies_hz[inside], one.modes.hertz
    shapes = modes.platform_shapes[inside] @ sensors_on(radius)[[CHANNELS.index(c) for c in one.channels]].T
    alike = np.abs(shapes @ one.modes.shape.T) ** 2
    alike /= (shapes**2).sum(axis=1)[:, None] * (np.abs(one.modes.shape) ** 2).sum(axis=1)
    apart = np.abs(found[None] / hertz[:, None] - 1.0)
    rows, columns = linear_sum_assignment(np.where(apart < NEAR, apart / NEAR + 1.0 - alike, 1e3))
    near = apart[rows, columns] < NEAR
    own, sigma = np.full(len(hertz), np.nan), np.full(len(hertz), np.nan)
    own[rows[near]], sigma[rows[near]] = found[columns[near]], one.sigma[columns[near]]
    gap = np.abs(hertz[:, None] / hertz - 1.0) + np.eye(len(hertz))
    lonely = np.abs(found[:, None] / modes.frequencies_hz - 1.0).min(axis=1)
    invented = lonely > np.maximum(SINGLE, 3.0 * one.sigma / found)
    return Compared(
        name, hertz, own, sigma, gap.min(axis=1) < DOUBLE, int(invented.sum()), len(found) - int(near.sum())
    )


def measured(minutes: float, count: int, progress: Callable[[str], None] = print) -> list[Compared]:
    """All robots; `progress` is called with a line on each."""
    generator, found = np.random.default_rng(SEED + 1), []
    for name, modes, mass, radius in robots(count):
        one = identified(record_of(modes, mass, radius, minutes, generator), Sigmas(), AmbientChoice())
        found.append(compared(name, modes, radius, one))
        progress(_line(found[-1]))
    return found


def _modes(robot: Robot, generator: np.random.Generator) -> fem.RobotModes | None:
    """Modes in the middle of the frame, a few per cent beside it; None where the robot does not rest there."""
    low, high = robot.frame_anchors.min(axis=0), robot.frame_anchors.max(axis=0)
    place = 0.5 * (low + high) * [1.0, 1.0, 0.7] + generator.uniform(-0.01, 0.01, 3) * (high - low)
    try:
        held = inverse(robot, place, np.eye(3))
        return fem.robot_modes(solve_in_fem(OperatingPoint(robot, place, np.eye(3), held.cables), ELEMENTS), MODES)
    except (CdprError, fem.FemError, ValueError):
        return None


def six_cables(generator: np.random.Generator) -> Robot:
    """Six cables in three crossed pairs at 120 degrees, above a platform that hangs."""
    turn = 2.0 * np.pi * np.repeat(np.arange(3), 2) / 3.0
    side, wide, high, size = np.tile([1.0, -1.0], 3), generator.uniform(2.0, 5.0), generator.uniform(3.0, 6.0), 0.3
    out, across = np.stack([np.cos(turn), np.sin(turn)], axis=1), np.stack([-np.sin(turn), np.cos(turn)], axis=1)
    frame = np.column_stack([wide * out + 0.8 * side[:, None] * across, np.full(6, high)])
    inner = np.column_stack([size * out - 0.7 * size * side[:, None] * across, np.where(side > 0.0, 0.2, -0.1)])
    return _light("six", frame, inner, generator)


def eight_cables(generator: np.random.Generator) -> Robot:
    """Eight cables from the corners of a box with a square ground plan to those of a smaller one, crossed."""
    corners = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    half = generator.uniform(1.5, 4.0)
    frame = corners * [half, half, generator.uniform(1.5, 3.0)] + [0.0, 0.0, 3.0]
    inner = corners * [0.25, 0.25, -0.2]
    return _light("box", frame, inner, generator)


def _light(name: str, frame: np.ndarray, inner: np.ndarray, generator: np.random.Generator) -> Robot:
    """A platform of 20 to 60 kg on light cables, anchors a few millimetres off."""
    mass = generator.uniform(20.0, 60.0)
    preload = 0.0 if name == "six" else 3.0 * mass  # N
    cable = Cable(10.0 ** generator.uniform(4.6, 5.3), generator.uniform(0.002, 0.01), force_min=preload)
    off = generator.normal(0.0, 0.003, frame.shape)
    body = Platform(mass, np.zeros(3), 0.03 * mass * np.diag([1.0, 1.0, 1.2]))
    return Robot(name, body, (cable,) * len(frame), inner, frame + off)


def _line(c: Compared) -> str:
    share = 100.0 * c.sigma / c.hertz
    return (
        f"{c.name:15s} {len(c.hertz):2d} modes, {c.hertz[0]:.2f} to {c.hertz[-1]:.2f} Hz, {int(c.pair.sum())} in pairs"
        f": {int(np.isnan(c.found).sum())} missed, {c.invented} invented, {c.more} of cables; largest error "
        f"{np.nanmax(np.abs(c.off)):.2f} sigma; sigma {np.nanmedian(share):.3f} %, largest {np.nanmax(share):.3f} %"
    )


def total(found: list[Compared]) -> str:
    """What all robots say together."""
    off, pair = (np.concatenate([getattr(c, name) for c in found]) for name in ("off", "pair"))
    share = np.concatenate([c.sigma / c.hertz for c in found])
    known = np.isfinite(off)
    size = np.abs(off[known])
    return (
        f"{len(found)} robots, {len(off)} modes: {(~known).sum()} missed ({(~known & pair).sum()} of the {pair.sum()} "
        f"in pairs), {sum(c.invented for c in found)} invented, {sum(c.more for c in found)} of cables. Within 1 sigma "
        f"{(size < 1.0).mean():.3f}, 2 sigma {(size < 2.0).mean():.3f}, 3 sigma {(size < 3.0).mean():.3f}; largest "
        f"{size.max():.2f}. Sigma: median {100.0 * np.median(share[known]):.3f} %, at most 0.2 % in "
        f"{(share[known] <= 0.002).mean():.3f}, largest {100.0 * share[known].max():.3f} %"
    )


if __name__ == "__main__":
    words = [*sys.argv[1:], "10", "20"] if len(sys.argv) < 2 else [*sys.argv[1:], "20"]
    print(total(measured(float(words[0]), int(words[1]))))
