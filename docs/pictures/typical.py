"""Every cause of the library at a typical size on one robot: what acts, and what sensors then read.

Effects are those at locked winches: the encoders say the same in the simulation and on the real robot.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import locked
import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.damping import DampingLaw, Hysteretic, Viscous
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.hypotheses.causes import internal_force
from cdpr_struct.hypotheses.causes.cause import Cause
from cdpr_struct.hypotheses.causes.library import LIBRARY
from cdpr_struct.observation.circumstances import Circumstances, exit_turns
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import rest, unbalanced, unfitting
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.masts import carriers

ROBOT = Path(__file__).parents[2] / "examples" / "box-robot" / "robot.toml"
POSE = Pose(np.array([0.4, 0.3, 1.3]), np.radians([1.0, -1.0, 2.0]))
TOP, SHOWN = 40.0, 30.0  # Hz: of the frequency response that is transformed, and of the modes and lines that are shown
MOST = 60.0  # N: a prior sigma that changes a tension by more is halved, until it does not
CABLE = 1  # from 0: where one cable alone is wrong
_ALONE = frozenset(
    ("frame_anchor_position", "platform_anchor_position", "unstrained_length_offset", "load_cell_bias", "brake_slip",
     "cable_added_mass")
)  # fmt: skip
_TIMES = {"accelerometer_gain": 4.0}  # sigmas of its prior: one is hardly seen on an axis of decades
_LINE = 8.0  # Hz
_TUNED = {"flexible_platform": [0.0, 0.0, np.sqrt(3.0), _LINE], "swinging_payload": [np.sqrt(3.0), 1.0, 0.0, 0.0, -0.1]}
"""Parameters of causes that add a mode: roots of masses [kg], frequencies [Hz], hook [m]."""
_NEAR = 0.3  # of ln f: modes farther apart are not the same mode
_KILOPOND = 9.80665  # N


@dataclass(frozen=True, slots=True, eq=False)
class Effect:
    """What a cause does, real less simulated at the same encoder lengths.

    size : in words;  tension (8,) [N];  balance (6,) [N, moments over the platform's radius];  length (8,) [mm]
    cable (8, 3), robot (M,) : of frequencies [%], robot at hertz (M,);  peak : a further one [Hz], nan without
    simulated, real : answers to a vertical force
    """

    size: str
    tension: np.ndarray
    balance: np.ndarray
    length: np.ndarray
    cable: np.ndarray
    hertz: np.ndarray
    robot: np.ndarray
    simulated: locked.Answer
    real: locked.Answer
    peak: float = np.nan

    def numbers(self) -> dict[str, list[float]]:
        """What is drawn as bars, and the largest change of the response, rounded to what can be seen."""
        gap = np.abs(np.log10(np.abs(self.real.response) / np.abs(self.simulated.response)))
        bars = {n: np.ravel(getattr(self, n)).tolist() for n in ("tension", "balance", "length", "cable", "robot")}
        return {n: [round(v, 4) + 0.0 for v in values] for n, values in bars.items()} | {
            "response": [round(float(gap.max()), 2)]
        }


@dataclass(frozen=True, slots=True, eq=False)
class Stand:
    """The robot with its winches locked, as a simulation or as it really is."""

    arrays: RobotArrays
    known: Circumstances
    commanded: Readings
    law: DampingLaw | None = None
    model: CableModel = "exact"
    assembly: Assembly = "consistent"
    misread: Callable[[Readings], Readings] = lambda readings: readings
    gain: float = 1.0


@lru_cache
def _readings(stand: Stand) -> Readings:
    """What tracker and load cells say, mistakes in the files left out."""
    return locked.locked(stand.arrays, stand.commanded, stand.known)


@lru_cache
def _point(stand: Stand) -> OperatingPoint:
    """The robot while it vibrates."""
    return locked.at_rest(stand.arrays, _readings(stand), stand.known)


@lru_cache
def _answer(stand: Stand) -> locked.Answer:
    """Of the height to a vertical force."""
    found = locked.answer(_point(stand), TOP, stand.law, stand.model, stand.assembly)
    return replace(found, response=stand.gain * found.response)


def entered(pulleys: bool = True) -> Stand:
    """The simulation under test, or the same without the pulleys of its robot file."""
    robot = load_robot(ROBOT)
    robot = robot if pulleys else replace(robot, pulleys=(None,) * len(robot.cables))
    held = inverse(robot, POSE.position, POSE.rotation)
    position, rotation = POSE.position[None], POSE.rotation[None]
    turns = exit_turns(robot, position, rotation)
    known = Circumstances(
        payload=np.zeros(1), hours=np.ones(1), clock=np.full(1, 60.0), rate=np.full((1, 8, 2), 0.1),
        pull=np.full((1, 8, 2), 20.0), inertial=np.zeros((1, 6)), acceleration=np.zeros(1),
        approach=np.ones((1, 8)), wrap=turns, center=POSE.position, mean_tension=float(held.tensions.mean()),
    )  # fmt: skip
    return Stand(RobotArrays.of(robot), known, Readings(position, rotation, held.tensions[None], held.lengths[None]))


def theta_of(cause: Cause, arrays: RobotArrays) -> tuple[np.ndarray, str]:
    """Basic parameters of a cause at one prior sigma, and where it acts."""
    if cause.tuned:
        return np.array(_TUNED[cause.name]), ""
    own = _TIMES.get(cause.name, 1.0) * np.array([p.prior for p in cause.parameters])
    if cause.name in (
        "accelerometer_gain",
        "tracker_frame",
        "pose_mismatch",
        "frame_compliance",
        "missing_pulleys",
        "nonlinear_elasticity",
        "pulley_friction",
        "sensor_delay",
        "clock_drift",
    ):
        own = own * (np.arange(len(own)) < {"tracker_frame": 6, "pose_mismatch": 3}.get(cause.name, 1))
    count = {"cable": 8, "mast": carriers(arrays.masts).shape[1], "axis": 3, "state": 1}.get(cause.carrier, 1)
    every = np.tile(own, (count, 1))
    if cause.name in _ALONE and cause.carrier:
        every[np.arange(count) != CABLE] = 0.0
        return every.ravel(), f"cable {CABLE + 1} alone"
    return every.ravel(), f"all {count} alike" if count > 1 else ""


def real_robot(cause: Cause, simulation: Stand) -> tuple[Stand, str]:
    """The robot with a cause, halved until its tensions change by less than `MOST`."""
    theta, where = theta_of(cause, simulation.arrays)
    before = _readings(simulation).tension
    for _ in range(8):
        gain = float(np.exp(theta[0])) if cause.name == "accelerometer_gain" else 1.0
        real = replace(simulation, arrays=cause.apply(simulation.arrays, theta[None]), gain=gain)
        try:
            fits = cause.tuned or np.abs(_readings(real).tension - before).max() < MOST
        except (ArithmeticError, np.linalg.LinAlgError):  # a cable would hang slack
            fits = False
        if fits:
            return real, ", ".join(part for part in (_words(cause, theta), where) if part)
        theta = 0.5 * theta
    raise ArithmeticError(f"{cause.name}: no size is small enough")


def _words(cause: Cause, theta: np.ndarray) -> str:
    axes = len(cause.parameters)
    own = theta.reshape(-1, axes) if theta.size >= axes else theta[None]
    first = own[int(np.abs(own).sum(axis=1).argmax())]
    shown = [(p, p.shown(float(v), 0.0)) for p, v in zip(cause.parameters, first, strict=True) if v]
    return ", ".join(f"{p.name} {said['value']:.5g} {'' if p.ratio else said['unit']}".strip() for p, said in shown)


def effect(simulation: Stand, real: Stand, size: str, *, linear: bool = True, peak: float = np.nan) -> Effect:
    """Real less simulated."""
    told, expected = real.misread(_readings(real)), _readings(simulation)
    model = rest(simulation.arrays, told, simulation.known)
    wrench = unbalanced(model, simulation.known)[0]
    there, here = _point(real), _point(simulation)
    same = all(getattr(real, n) is getattr(simulation, n) for n in ("arrays", "known", "commanded"))
    cable = np.zeros((8, 3)) if same else locked.cable_hertz(there) / locked.cable_hertz(here) - 1.0
    hertz, robot = _of_robot(simulation, real, linear)
    return Effect(
        size, (told.tension - expected.tension)[0], np.append(wrench[:3], wrench[3:] / locked.RADIUS),
        1e3 * unfitting(model, told, simulation.known)[0], 100.0 * cable, hertz, 100.0 * robot, _answer(simulation),
        _answer(real), peak,
    )  # fmt: skip


def _of_robot(simulation: Stand, real: Stand, linear: bool) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies of the modes that move the platform [Hz], and their relative change."""
    modes = locked.platform_modes(_point(simulation), SHOWN, simulation.model, simulation.assembly)
    some = (modes.share[0] > (0.1 if linear else 0.5)) & (np.exp(modes.log_hertz[0]) < SHOWN)
    hertz = np.exp(modes.log_hertz[0][some])
    if linear:
        return hertz, locked.changed(modes, _point(real))[some]
    others = locked.platform_modes(_point(real), SHOWN, real.model, real.assembly)
    own, theirs = modes.platform[0][some], others.platform[0]
    size = np.linalg.norm(own, axis=-1)[:, None] * np.linalg.norm(theirs, axis=-1)
    apart = np.abs(others.log_hertz[0] - np.log(hertz)[:, None])
    alike = np.abs(own @ theirs.T) / np.where(size > 0.0, size, 1.0) * others.share[0] * (apart < _NEAR)
    return hertz, np.exp(others.log_hertz[0])[alike.argmax(axis=1)] / hertz - 1.0


def effects() -> dict[str, Effect]:
    """Of all causes that have a picture, by name; `coulomb_damping` has none: it depends on the amplitude."""
    simulation = entered()
    found = {}
    for name in LIBRARY:
        found[name] = of_library(name, simulation)
    return dict(sorted((found | _beside(simulation)).items()))


def of_library(name: str, simulation: Stand) -> Effect:
    """Of a cause that changes the robot or a sensor."""
    cause = LIBRARY[name]
    simulation = simulation if cause.name != "missing_pulleys" else entered(pulleys=False)
    if cause.outside:
        return effect(simulation, simulation, f"{cause.parameters[0].name} {_LINE:g} Hz", peak=_LINE)
    real, size = real_robot(cause, simulation)
    return effect(
        simulation, real, size, linear=not cause.tuned, peak=_TUNED.get(name, [np.nan])[1 if cause.tried else -1]
    )


def _beside(entered_: Stand) -> dict[str, Effect]:
    """Of what is no change of the robot."""
    pull = _readings(entered_)
    swapped = np.array([0, 2, 1, 3, 4, 5, 6, 7])
    files = {
        "unit_error": (lambda r: replace(r, tension=r.tension / _KILOPOND), "tensions in kgf"),
        "sign_error": (lambda r: replace(r, position=r.position * [1.0, -1.0, 1.0]), "y of the pose, 0.3 m"),
        "rotation_convention": (_zyx, "angles about z, then y, then x"),
        "swapped_channels": (lambda r: replace(r, tension=r.tension[:, swapped]), "load cells 2 and 3"),
    }
    found = {n: effect(entered_, replace(entered_, misread=change), said) for n, (change, said) in files.items()}
    straight = replace(entered_, known=replace(entered_.known, sagging=False))
    left_out = {
        "cable_sag": (straight, "simulated: straight, weightless cables in statics"),
        "cable_dynamics": (replace(entered_, model="static"), "simulated: model static"),
        "attachment_geometric_stiffness": (replace(entered_, assembly="thesis"), "simulated: assembly thesis"),
    }
    found |= {n: effect(simulation, entered_, said, linear=False) for n, (simulation, said) in left_out.items()}
    ratio = 3.0 * np.broadcast_to(entered_.arrays.damping_ratio, (8,))
    found["viscous_damping"] = effect(entered_, replace(entered_, law=Viscous(ratio)), "damping_ratio_factor 3")
    found["hysteretic_damping"] = effect(entered_, replace(entered_, law=Hysteretic(0.05)), "loss_factor 0.05")
    other, newtons = _preloaded(entered_, pull), internal_force.PRIOR
    found["internal_force"] = effect(entered_, other, f"{newtons:g} N along the first direction of the null space")
    return found


def _zyx(read: Readings) -> Readings:
    """Rotations whose angles are entered as if they were about x, then y, then z."""
    angles = Rotation.from_matrix(read.rotation).as_euler("zyx")[:, ::-1]
    return replace(read, rotation=Rotation.from_euler("xyz", angles).as_matrix())


def _preloaded(simulation: Stand, pull: Readings) -> Stand:
    """Winches that hold the same pose with another internal force."""
    state = rest(simulation.arrays, pull, simulation.known)
    force = state.cables.force_on_platform[0] / state.cables.tension_at_platform[0][:, None]
    structure = np.concatenate([force, np.cross(state.arms.arms[0], force)], axis=1)
    null = np.linalg.svd(structure.T)[2][6]
    null = null * np.sign(null.sum())
    tighter = replace(pull, tension=pull.tension + internal_force.PRIOR * null)
    there = rest(simulation.arrays, tighter, simulation.known)
    return replace(simulation, commanded=replace(tighter, length=there.cables.total_length))
