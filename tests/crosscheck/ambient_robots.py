"""Twenty robots in random forces: the modes that their ambient records show, beside those of the finite-element model.

python -m tests.crosscheck.ambient_robots [MINUTES] [ROBOTS]     (two minutes for 10 min and 20 robots)

Eight robots that no one designed, six of six cables in three pairs at 120 degrees and six of eight cables at the corners of a
box: all but symmetric, so that pairs of modes nearly coincide. Forces are white and act on the platform, all modes have 0.5 %
damping, three accelerometers of three axes have noise of 2 % of the vibration.
"""

import sys
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

DAMPING, NOISE, SEED = 0.005, 0.02, 20261126
VISIBLE = 0.15  # share of the kinetic energy in the platform of the modes that must be found
LOWEST = 0.8  # Hz, of the first such mode: below it ten minutes do not hold a frequency to 0.2 %
ELEMENTS, MODES = 12, 120
NEAR = 0.03  # of a frequency: how far the identified mode may be
SINGLE, DOUBLE = (
    0.005,
    0.01,
)  # of a frequency: farther from all modes one is invented; nearer to each other two are a pair


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
    """Names, modes, masses [kg] and radii of gyration [m] of the first robots that rest in the middle of their frames."""
    generator, found = np.random.default_rng(SEED), []
    makers = [random_robot] * 8 + [_six] * 6 + [_box] * 6
    for number, make in enumerate(makers[:count]):
        while len(found) == number:
            robot = make(generator)
            modes = _modes(robot, generator)
            seen = () if modes is None else modes.frequencies_hz[modes.platform_energy > VISIBLE]
            if len(seen) >= 6 and seen[0] > LOWEST:
                body = robot.platform
                radius = float(np.sqrt(np.trace(body.inertia) / 3.0 / body.mass))
                found.append((f"{make.__name__.strip('_')} {number + 1}", modes, body.mass, radius))
    return found


def record_of(
    modes: fem.RobotModes, mass: float, radius: float, minutes: float, generator: np.random.Generator
) -> SignalRecord:
    """Ambient record of a robot, sampled for the sixth of its modes that move the platform."""
    seen = modes.frequencies_hz[modes.platform_energy > VISIBLE]
    rate = 3.5 * float(seen[5])
    count = round(60.0 * minutes * rate)
    force = mass * np.array([1.0, 1.0, 1.0, radius, radius, radius])
    places = radius * np.array([[1.0, 0.0, 0.0], [-0.5, 0.8, 0.3], [-0.5, -0.8, -0.3]])
    sensors = np.array([[*axis, *np.cross(place, axis)] for place in places for axis in np.eye(3)])
    signal = fem.ambient_record(modes, DAMPING, force, sensors, rate, count, generator)
    signal = signal + NOISE * signal.std() * generator.normal(size=signal.shape)
    names = tuple(f"a{axis}_{place}" for place in "123" for axis in "xyz")
    unknown = np.full(6, np.nan)
    return SignalRecord(
        AMBIENT, "wind", "wind.csv", np.arange(count) / rate, signal, names, unknown[:3], unknown[3:], 0.0, unknown
    )


def compared(name: str, modes: fem.RobotModes, radius: float, one: AmbientRecord) -> Compared:
    """Visible modes of the band beside the identified ones; pairs by nearness of frequencies and shapes."""
    inside = (modes.platform_energy > VISIBLE) & (modes.frequencies_hz < one.band[1])
    hertz, found = modes.frequencies_hz[inside], one.modes.hertz
    places = radius * np.array([[1.0, 0.0, 0.0], [-0.5, 0.8, 0.3], [-0.5, -0.8, -0.3]])
    sensors = np.array([[*axis, *np.cross(place, axis)] for place in places for axis in np.eye(3)])
    shapes = modes.platform_shapes[inside] @ sensors.T
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


def measured(minutes: float, count: int) -> list[Compared]:
    """All robots."""
    generator, found = np.random.default_rng(SEED + 1), []
    for name, modes, mass, radius in robots(count):
        one = identified(record_of(modes, mass, radius, minutes, generator), Sigmas(), AmbientChoice())
        found.append(compared(name, modes, radius, one))
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


def _six(generator: np.random.Generator) -> Robot:
    """Six cables in three crossed pairs at 120 degrees, above a platform that hangs."""
    turn = 2.0 * np.pi * np.repeat(np.arange(3), 2) / 3.0
    side, wide, high, size = np.tile([1.0, -1.0], 3), generator.uniform(2.0, 5.0), generator.uniform(3.0, 6.0), 0.3
    out, across = np.stack([np.cos(turn), np.sin(turn)], axis=1), np.stack([-np.sin(turn), np.cos(turn)], axis=1)
    frame = np.column_stack([wide * out + 0.8 * side[:, None] * across, np.full(6, high)])
    inner = np.column_stack([size * out - 0.7 * size * side[:, None] * across, np.where(side > 0.0, 0.2, -0.1)])
    return _light("six", frame, inner, generator)


def _box(generator: np.random.Generator) -> Robot:
    """Eight cables from the corners of a box with a square ground plan to those of a smaller one, crossed."""
    corners = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    half = generator.uniform(1.5, 4.0)
    frame = corners * [half, half, generator.uniform(1.5, 3.0)] + [0.0, 0.0, 3.0]
    inner = corners * [0.25, 0.25, -0.2]
    return _light("box", frame, inner, generator)


def _light(name: str, frame: np.ndarray, inner: np.ndarray, generator: np.random.Generator) -> Robot:
    """A platform of 20 to 60 kg on light cables, anchors a few millimetres off."""
    mass = generator.uniform(20.0, 60.0)
    cables = (Cable(10.0 ** generator.uniform(4.6, 5.3), generator.uniform(0.002, 0.01), force_min=3.0 * mass),) * len(
        frame
    )
    if name == "six":
        cables = tuple(Cable(c.axial_stiffness, c.linear_density) for c in cables)
    off = generator.normal(0.0, 0.003, frame.shape)
    return Robot(name, Platform(mass, np.zeros(3), 0.03 * mass * np.diag([1.0, 1.0, 1.2])), cables, inner, frame + off)


def told(found: list[Compared]) -> str:
    """One line a robot, and the sum."""
    lines = [
        f"{c.name:16s} {len(c.hertz):3d} modes, {np.isnan(c.found).sum()} missed, {int(c.pair.sum())} in pairs, {c.invented} invented,"
        f" {c.more} more; largest error {np.nanmax(np.abs(c.off)):.2f} sigma, sigma {100 * np.nanmedian(c.sigma / c.hertz):.3f} %"
        f" (largest {100 * np.nanmax(c.sigma / c.hertz):.3f} %), {c.hertz[0]:.2f} to {c.hertz[-1]:.2f} Hz"
        for c in found
    ]
    off = np.concatenate([c.off for c in found])
    sigma = np.concatenate([c.sigma / c.hertz for c in found])
    pair = np.concatenate([c.pair for c in found])
    known = np.isfinite(off)
    lines.append(
        f"{len(found)} robots, {len(off)} modes: {(~known).sum()} missed ({(~known & pair).sum()} of {pair.sum()} in pairs), "
        f"{sum(c.invented for c in found)} invented, {sum(c.more for c in found)} more; within 3 sigma {(np.abs(off[known]) < 3).mean():.3f}, "
        f"1 sigma {(np.abs(off[known]) < 1).mean():.3f}, largest {np.abs(off[known]).max():.2f}; rms {np.sqrt((off[known] ** 2).mean()):.2f}; "
        f"sigma median {100 * np.median(sigma[known]):.3f} %, 0.2 % or less for {(sigma[known] <= 0.002).mean():.3f}"
    )
    return "\n".join(lines)


if __name__ == "__main__":
    print(told(measured(float((sys.argv + ["10"])[1]), int((sys.argv + ["", "20"])[2] or 20))))
