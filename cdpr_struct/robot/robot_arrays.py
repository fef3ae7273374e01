"""The robot as arrays, any of which may carry batch axes: what statics, dynamics and observation compute with."""

from dataclasses import dataclass, field, fields, replace
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from cdpr_struct.robot.extensions import drag, drag_across, masts_of, uprights_of
from cdpr_struct.robot.lump import lump_arrays
from cdpr_struct.robot.parameters import EXTENSIONS, PARAMETERS
from cdpr_struct.robot.platform import joined_masses
from cdpr_struct.robot.robot import Robot

_KEPT = 16  # robots whose arrays are kept
_LEAST_MODULUS = 0.05  # of E as entered: the law is a straight line and would end below zero
_LEAST_TENSION = 1e-3  # of the reference: below it a power law stays as it is there, and a slack cable has some EA


@dataclass(frozen=True, slots=True, eq=False)
class RobotArrays:
    """Robot with m cables; leading axes (...) of any field are batch axes, for parameter studies and Monte Carlo.

    `robot/parameters.py` has unit, bounds and meaning of each field.

    platform_anchors, frame_anchors : (..., m, 3) platform frame, world frame [m]
    axial_stiffness : (..., m) EA [N]
    linear_density  : (..., m) mu [kg/m]
    pulley_radius   : (..., m) [m], 0 where the cable starts at a fixed point
    pulley_axis     : (..., m, 3) unit, world; the cable passes the frame anchor travelling along +axis
    mass            : (...) [kg]
    center_of_mass  : (..., 3) platform frame [m];  inertia : (..., 3, 3) about it, platform frame [kg m^2]
    gravity         : (...) g [m/s^2], along down (..., 3) unit, world
    guided          : (..., 6) 1 where a guide holds the platform: x, y, z, rx, ry, rz, world axes at its origin
    damping_ratio   : (..., m) xi [-];  thermal_expansion : (..., m) [1/K]
    force_min, force_max : (..., m) [N], limits of the tension at the platform
    winch_tension   : (..., m) [N] at the frame that the winch holds, 0 where it holds the length
    lump_place      : (..., m, k) [m] of point masses lump_mass (..., m, k) [kg], ascending, from the platform on

    Extensions, without effect unless given:
    series_compliance, length_offset, length_scale, bending_stiffness, added_mass : (..., m)
    frame_compliance, mast_bending : (..., m) [m/N] of each cable's mast;  mast_foot : (...) [m]
    mast_mass : (..., m) [kg] that moves with each cable's exit on its mast
    masts : (m, m) 1 where cables share one;  uprights : (m, m) how they bend, as `uprights_of` says
    hose            : (...) [N/m], relaxed at hose_center (..., 3) [m];  force : (..., 3) [N];  moment : (..., 3) [N m]
    tilt            : (..., 2) [rad];  temperature_change : (...) [K]
    drag_area       : (...) [m^2], drag_width : (..., m) [m] in wind (..., 3) [m/s] of air_density (...) [kg/m^3]
    nonlinearity, stiffening_exponent : (...) k and n with reference_tension (...) [N];  incremental_ratio : (...)
    cell_gain, cell_bias, friction, bearing_friction, pulley_drag, backlash, slip, encoder_delay, cell_delay,
    swivel_zero : (..., m)
    clock_drift, clock_start : (...) [-], [s]
    tracker, accelerometer_gain : (..., 6)
    creep, sensor_mass : (...)
    internal_mass, internal_frequency : (...) [kg], [Hz];  internal_direction : (..., 3) unit, platform frame
    swinging_mass, swinging_frequency : (...) [kg], [Hz];  swinging_place : (..., 3) platform frame [m]
    """

    platform_anchors: np.ndarray
    frame_anchors: np.ndarray
    axial_stiffness: np.ndarray
    linear_density: np.ndarray
    pulley_radius: np.ndarray
    pulley_axis: np.ndarray
    mass: np.ndarray
    center_of_mass: np.ndarray
    inertia: np.ndarray
    gravity: np.ndarray
    down: np.ndarray = field(default_factory=PARAMETERS["down"].without_effect)
    guided: np.ndarray = field(default_factory=PARAMETERS["guided"].without_effect)
    damping_ratio: np.ndarray = field(default_factory=PARAMETERS["damping_ratio"].without_effect)
    thermal_expansion: np.ndarray = field(default_factory=PARAMETERS["thermal_expansion"].without_effect)
    force_min: np.ndarray = field(default_factory=PARAMETERS["force_min"].without_effect)
    force_max: np.ndarray = field(default_factory=PARAMETERS["force_max"].without_effect)
    winch_tension: np.ndarray = field(default_factory=PARAMETERS["winch_tension"].without_effect)
    lump_place: np.ndarray = field(default_factory=PARAMETERS["lump_place"].without_effect)
    lump_mass: np.ndarray = field(default_factory=PARAMETERS["lump_mass"].without_effect)
    series_compliance: np.ndarray = field(default_factory=PARAMETERS["series_compliance"].without_effect)
    length_offset: np.ndarray = field(default_factory=PARAMETERS["length_offset"].without_effect)
    length_scale: np.ndarray = field(default_factory=PARAMETERS["length_scale"].without_effect)
    frame_compliance: np.ndarray = field(default_factory=PARAMETERS["frame_compliance"].without_effect)
    mast_bending: np.ndarray = field(default_factory=PARAMETERS["mast_bending"].without_effect)
    mast_mass: np.ndarray = field(default_factory=PARAMETERS["mast_mass"].without_effect)
    mast_foot: np.ndarray = field(default_factory=PARAMETERS["mast_foot"].without_effect)
    uprights: np.ndarray = field(default_factory=PARAMETERS["uprights"].without_effect)
    masts: np.ndarray = field(default_factory=PARAMETERS["masts"].without_effect)
    hose: np.ndarray = field(default_factory=PARAMETERS["hose"].without_effect)
    hose_center: np.ndarray = field(default_factory=PARAMETERS["hose_center"].without_effect)
    force: np.ndarray = field(default_factory=PARAMETERS["force"].without_effect)
    moment: np.ndarray = field(default_factory=PARAMETERS["moment"].without_effect)
    drag_area: np.ndarray = field(default_factory=PARAMETERS["drag_area"].without_effect)
    drag_width: np.ndarray = field(default_factory=PARAMETERS["drag_width"].without_effect)
    wind: np.ndarray = field(default_factory=PARAMETERS["wind"].without_effect)
    air_density: np.ndarray = field(default_factory=PARAMETERS["air_density"].without_effect)
    tilt: np.ndarray = field(default_factory=PARAMETERS["tilt"].without_effect)
    nonlinearity: np.ndarray = field(default_factory=PARAMETERS["nonlinearity"].without_effect)
    stiffening_exponent: np.ndarray = field(default_factory=PARAMETERS["stiffening_exponent"].without_effect)
    incremental_ratio: np.ndarray = field(default_factory=PARAMETERS["incremental_ratio"].without_effect)
    reference_tension: np.ndarray = field(default_factory=PARAMETERS["reference_tension"].without_effect)
    temperature_change: np.ndarray = field(default_factory=PARAMETERS["temperature_change"].without_effect)
    bending_stiffness: np.ndarray = field(default_factory=PARAMETERS["bending_stiffness"].without_effect)
    bending_fixity: np.ndarray = field(default_factory=PARAMETERS["bending_fixity"].without_effect)
    added_mass: np.ndarray = field(default_factory=PARAMETERS["added_mass"].without_effect)
    added_mass_place: np.ndarray = field(default_factory=PARAMETERS["added_mass_place"].without_effect)
    cell_gain: np.ndarray = field(default_factory=PARAMETERS["cell_gain"].without_effect)
    cell_bias: np.ndarray = field(default_factory=PARAMETERS["cell_bias"].without_effect)
    friction: np.ndarray = field(default_factory=PARAMETERS["friction"].without_effect)
    bearing_friction: np.ndarray = field(default_factory=PARAMETERS["bearing_friction"].without_effect)
    pulley_drag: np.ndarray = field(default_factory=PARAMETERS["pulley_drag"].without_effect)
    backlash: np.ndarray = field(default_factory=PARAMETERS["backlash"].without_effect)
    tracker: np.ndarray = field(default_factory=PARAMETERS["tracker"].without_effect)
    creep: np.ndarray = field(default_factory=PARAMETERS["creep"].without_effect)
    slip: np.ndarray = field(default_factory=PARAMETERS["slip"].without_effect)
    encoder_delay: np.ndarray = field(default_factory=PARAMETERS["encoder_delay"].without_effect)
    swivel_zero: np.ndarray = field(default_factory=PARAMETERS["swivel_zero"].without_effect)
    cell_delay: np.ndarray = field(default_factory=PARAMETERS["cell_delay"].without_effect)
    clock_drift: np.ndarray = field(default_factory=PARAMETERS["clock_drift"].without_effect)
    clock_start: np.ndarray = field(default_factory=PARAMETERS["clock_start"].without_effect)
    accelerometer_gain: np.ndarray = field(default_factory=PARAMETERS["accelerometer_gain"].without_effect)
    sensor_mass: np.ndarray = field(default_factory=PARAMETERS["sensor_mass"].without_effect)
    internal_mass: np.ndarray = field(default_factory=PARAMETERS["internal_mass"].without_effect)
    internal_frequency: np.ndarray = field(default_factory=PARAMETERS["internal_frequency"].without_effect)
    internal_direction: np.ndarray = field(default_factory=PARAMETERS["internal_direction"].without_effect)
    swinging_mass: np.ndarray = field(default_factory=PARAMETERS["swinging_mass"].without_effect)
    swinging_frequency: np.ndarray = field(default_factory=PARAMETERS["swinging_frequency"].without_effect)
    swinging_place: np.ndarray = field(default_factory=PARAMETERS["swinging_place"].without_effect)

    @classmethod
    def of(cls, robot: "Robot | RobotArrays", mass: np.ndarray | float | None = None) -> "RobotArrays":
        """Arrays of a robot; `mass` (...) [kg] replaces the platform's."""
        arrays = robot if isinstance(robot, RobotArrays) else _entered(robot)
        return arrays if mass is None else replace(arrays, mass=np.asarray(mass, dtype=float))

    @property
    def weight(self) -> np.ndarray:
        """(..., m) of the cables, w = mu g [N/m]."""
        return self.linear_density * self.gravity[..., None]

    def cable_load(self, chord: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Weight and drag per unstrained length of cables along chords (..., m, 3): size (..., m) [N/m] of the sum and
        unit vector (..., m, 3) against it."""
        if not self.has_cable_drag:
            return self.weight, np.broadcast_to(self.up, chord.shape)
        pushed = drag_across(self.wind[..., None, :], chord, self.drag_width, self.air_density[..., None])
        against = self.weight[..., None] * self.up - pushed
        size = np.linalg.norm(against, axis=-1)
        return size, np.where(size[..., None] > 0.0, against / np.maximum(size, 1e-300)[..., None], self.up)

    @property
    def constant_force(self) -> np.ndarray:
        """(..., 3) on the platform origin, with the drag of wind, world [N]."""
        if not self.drag_area.any():
            return self.force
        return self.force + drag(self.wind, self.drag_area, self.air_density)

    @property
    def has_lumps(self) -> bool:
        """Whether point masses sit on cables."""
        return bool(self.lump_mass.any())

    @property
    def lump_weight(self) -> np.ndarray:
        """(..., m, k) of the point masses on cables [N]."""
        return self.lump_mass * self.gravity[..., None, None]

    @property
    def cable_count(self) -> int:
        """m."""
        return int(self.platform_anchors.shape[-2])

    @property
    def has_pulleys(self) -> bool:
        """Whether any cable runs over a pulley."""
        return bool((self.pulley_radius > 0.0).any())

    @property
    def has_yielding_frame_ends(self) -> bool:
        """Whether the length of a free cable depends on its tension: a pulley, something elastic in line, a winch."""
        return self.has_pulleys or bool(self.series_compliance.any()) or self.has_tension_winches

    @property
    def has_tension_winches(self) -> bool:
        """Whether any winch holds the tension of its cable instead of its length."""
        return bool(self.winch_tension.any())

    @property
    def up(self) -> np.ndarray:
        """(..., 1, 3) unit vector against gravity, world frame; one for all cables."""
        return -self.down[..., None, :]

    @property
    def is_tilted(self) -> bool:
        """Whether gravity acts in another direction than world -z."""
        return bool((self.down[..., 2] != -1.0).any())

    @property
    def has_cable_drag(self) -> bool:
        """Whether wind pushes the cables, so that each hangs in a plane of its own."""
        return bool(self.drag_width.any() and self.wind.any())

    @property
    def is_weightless(self) -> bool:
        """Whether there is no gravity."""
        return not self.gravity.any()

    @property
    def has_guides(self) -> bool:
        """Whether a guide holds the platform in any direction."""
        return bool(self.guided.any())

    @property
    def free(self) -> np.ndarray:
        """(..., 6) 1 where the platform can move, 0 where a guide holds it."""
        return 1.0 - self.guided

    @property
    def has_masts(self) -> bool:
        """Whether masts give way."""
        return bool(self.frame_compliance.any() or self.mast_bending.any())

    @property
    def has_internal_mass(self) -> bool:
        """Whether a part of the platform sits on an elastic mount."""
        return bool(self.internal_mass.any())

    @property
    def has_swinging_mass(self) -> bool:
        """Whether a part of the platform hangs from a point of it and swings."""
        return bool(self.swinging_mass.any())

    @property
    def has_moving_parts(self) -> bool:
        """Whether any part moves inside the platform."""
        return self.has_internal_mass or self.has_swinging_mass

    @property
    def has_force_limits(self) -> bool:
        """Whether any cable must do more than pull."""
        return bool(self.force_min.any() or np.isfinite(self.force_max).any())

    @property
    def thermal_growth(self) -> np.ndarray:
        """(..., m) of unstrained lengths, 1 + alpha dT."""
        return 1.0 + self.thermal_expansion * self.temperature_change[..., None]

    def paid_out(self, reading: np.ndarray) -> np.ndarray:
        """(..., m) length paid out when encoders say `reading` (..., m), or that is commanded [m]."""
        return (reading * self.length_scale + self.length_offset) * self.thermal_growth

    def reading(self, paid_out: np.ndarray) -> np.ndarray:
        """(..., m) what encoders say at lengths paid out (..., m) [m]."""
        return (paid_out / self.thermal_growth - self.length_offset) / self.length_scale

    def stiffness_at(self, tension: np.ndarray) -> np.ndarray:
        """(..., m) secant EA [N] of cables with tensions (..., m) at the platform [N]: E may change with it."""
        relative = tension / self.reference_tension[..., None]
        factor = np.maximum(1.0 + self.nonlinearity[..., None] * (relative - 1.0), _LEAST_MODULUS)
        if self.stiffening_exponent.any():
            factor = factor * np.maximum(relative, _LEAST_TENSION) ** self.stiffening_exponent[..., None]
        return self.axial_stiffness * factor

    @property
    def stiffens(self) -> bool:
        """Whether EA changes with the tension."""
        return bool(self.nonlinearity.any() or self.stiffening_exponent.any())

    def with_rigid_ends(self) -> "RobotArrays":
        """Nothing elastic but the cables themselves, and these alike at all tensions."""
        rigid = np.zeros(1)
        elastic = {name: PARAMETERS[name].without_effect() for name in ("nonlinearity", "stiffening_exponent")}
        return replace(self, series_compliance=rigid, frame_compliance=rigid, mast_bending=rigid, **elastic)

    def stiffened(self, factor: float) -> "RobotArrays":
        """Cables, what is in line with them, and masts all `factor` times stiffer."""
        names = ("series_compliance", "frame_compliance", "mast_bending")
        soft = {name: getattr(self, name) / factor for name in names}
        return replace(self, axial_stiffness=factor * self.axial_stiffness, **soft)

    def with_point_masses(self, masses: npt.ArrayLike, places: npt.ArrayLike) -> "RobotArrays":
        """The platform with point masses (..., p) [kg] fixed at places (..., p, 3) of its frame [m]."""
        added = np.asarray(masses, dtype=float)
        if not added.any():
            return self
        body = joined_masses(self.mass, self.center_of_mass, self.inertia, added, np.asarray(places, dtype=float))
        return replace(self, **dict(zip(("mass", "center_of_mass", "inertia"), body, strict=True)))

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """Broadcast batch axes of all fields."""
        return np.broadcast_shapes(*{_batch(self, f.name) for f in fields(self)})

    def flattened(self, shape: tuple[int, ...]) -> "RobotArrays":
        """The batch axes broadcast to `shape` and flattened to one; fields without batch axes keep none."""
        if not self.batch_shape:
            return self
        return replace(self, **{f.name: self._flat(f.name, shape) for f in fields(self)})

    def take(self, index: np.ndarray) -> "RobotArrays":
        """Items of a flattened batch."""
        batched = {f.name: getattr(self, f.name)[index] for f in fields(self) if _batch(self, f.name)}
        return replace(self, **batched) if batched else self

    def _flat(self, name: str, shape: tuple[int, ...]) -> np.ndarray:
        value: np.ndarray = getattr(self, name)
        batch = _batch(self, name)
        core = value.shape[len(batch) :]
        return np.broadcast_to(value, shape + core).reshape((-1, *core)) if batch else value


@lru_cache(maxsize=_KEPT)
def _entered(robot: Robot) -> RobotArrays:
    """Arrays of a robot, kept for the last few: what follows from the frame anchors is computed once."""
    vertical, more = np.array([0.0, 0.0, 1.0]), robot.extensions
    return RobotArrays(
        platform_anchors=robot.platform_anchors,
        frame_anchors=robot.frame_anchors,
        axial_stiffness=robot.axial_stiffness,
        linear_density=robot.linear_density,
        pulley_radius=np.array([0.0 if p is None else p.radius for p in robot.pulleys]),
        pulley_axis=np.array([vertical if p is None else p.axis for p in robot.pulleys]),
        mass=np.asarray(robot.platform.mass, dtype=float),
        center_of_mass=robot.platform.center_of_mass,
        inertia=robot.platform.inertia,
        gravity=np.asarray(robot.gravity, dtype=float),
        down=robot.down,
        guided=robot.held_freedoms.astype(float),
        damping_ratio=robot.damping_ratio,
        thermal_expansion=np.array([cable.thermal_expansion for cable in robot.cables]),
        force_min=robot.force_min,
        force_max=robot.force_max,
        winch_tension=np.array([cable.winch_tension for cable in robot.cables]),
        **lump_arrays(robot.lumps, len(robot.cables)),
        masts=masts_of(robot.frame_anchors),
        uprights=uprights_of(robot.frame_anchors, more.mast_foot),
        **{name: np.asarray(getattr(more, name), dtype=float) for name in EXTENSIONS},
    )


def _batch(arrays: RobotArrays, name: str) -> tuple[int, ...]:
    shape: tuple[int, ...] = getattr(arrays, name).shape
    return shape[: len(shape) - PARAMETERS[name].axes]
