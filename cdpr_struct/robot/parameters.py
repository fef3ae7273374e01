"""Every number that describes a robot, in one table: shape, unit, neutral value, bounds, meaning, place in a file."""

import math
from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.cable import LARGEST_EXPANSION, STEEL

CABLES = "m"  # stands for the number of cables in a shape
LUMPS = "k"  # for the number of point masses on the cable that has most, at least one


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a robot with m cables.

    shape   : axes of its own, `CABLES` for m
    unit    : SI
    meaning : half a sentence
    place   : table and key of a robot file, "[]" where each cable has its own; "" if it follows from others
    neutral : value without effect, of all entries or of each; None where a robot has none
    least, above, most : bounds
    """

    shape: tuple[int | str, ...]
    unit: str
    meaning: str
    place: str
    neutral: float | tuple[float, ...] | None = None
    least: float = -np.inf
    above: float = -np.inf
    most: float = np.inf

    @property
    def axes(self) -> int:
        """Number of axes of its own; those before are a batch."""
        return len(self.shape)

    def entries(self, cables: int) -> int:
        """Numbers in it; 0 for a single number."""
        return math.prod(self._lengths(cables)) if self.shape else 0

    def without_effect(self, cables: int = 1) -> np.ndarray:
        """The neutral value as an array; one cable's broadcasts against those of all.

        Raises
        ------
        ValueError : every robot needs its own value.
        """
        if self.neutral is None:
            raise ValueError(f"there is no neutral value: {self.meaning}")
        return np.full(self._lengths(cables), self.neutral)

    def _lengths(self, cables: int) -> list[int]:
        named = {CABLES: cables, LUMPS: 1}
        return [n if isinstance(n, int) else named[n] for n in self.shape]

    @property
    def range(self) -> str:
        """What values may be, as the end of a sentence; "" if all may."""
        lowest = f", above {self.above:g}" if np.isfinite(self.above) else ""
        lowest = lowest or (f", not below {self.least:g}" if np.isfinite(self.least) else "")
        return lowest + (f", not above {self.most:g}" if np.isfinite(self.most) else "")


def _of_cables(unit: str, meaning: str, place: str, neutral: float | None = None, **bounds: float) -> Parameter:
    return Parameter((CABLES,), unit, meaning, place, neutral, **bounds)


def _extra(
    shape: tuple[int | str, ...], neutral: float | tuple[float, ...], unit: str, meaning: str, **bounds: float
) -> Parameter:
    return Parameter(shape, unit, meaning, "extensions", neutral, **bounds)


_EACH: tuple[int | str, ...] = (CABLES,)
_RULES: dict[str, Parameter] = {
    "platform_anchors": Parameter((CABLES, 3), "m", "where cables end, platform frame", "cables[].platform_anchor"),
    "frame_anchors": Parameter((CABLES, 3), "m", "where cables begin, world frame", "cables[].frame_anchor"),
    "axial_stiffness": _of_cables("N", "EA of the cable", "cable.axial_stiffness", above=0.0),
    "linear_density": _of_cables("kg/m", "mu of the cable, unstrained", "cable.linear_density", least=0.0),
    "pulley_radius": _of_cables("m", "of the swivelling pulley", "cables[].pulley.radius", 0.0, least=0.0),
    "pulley_axis": Parameter((CABLES, 3), "1", "unit vector of the swivel, world frame", "cables[].pulley.axis"),
    "mass": Parameter((), "kg", "of the platform", "platform.mass", above=0.0),
    "center_of_mass": Parameter((3,), "m", "of the platform, platform frame", "platform.center_of_mass", 0.0),
    "inertia": Parameter((3, 3), "kg m^2", "about the centre of mass, platform frame", "platform.inertia"),
    "gravity": Parameter((), "m/s^2", "size of gravity", "gravity", least=0.0),
    "down": Parameter((3,), "1", "unit vector along which gravity acts, world frame", "gravity", (0.0, 0.0, -1.0)),
    "guided": Parameter((6,), "1", "1 where a guide holds the platform: x, y, z, rx, ry, rz", "platform.guided", 0.0),
    "damping_ratio": _of_cables(
        "1", "viscous, referred to the cable's first frequency", "cable.damping_ratio", 0.0, least=0.0, most=1.0
    ),
    "thermal_expansion": _of_cables(
        "1/K",
        "of the cable's unstrained length",
        "cable.thermal_expansion",
        STEEL,
        least=-LARGEST_EXPANSION,
        most=LARGEST_EXPANSION,
    ),
    "force_min": _of_cables("N", "least tension at the platform to ask for", "cable.force_min", 0.0, least=0.0),
    "force_max": _of_cables("N", "largest tension at the platform", "cable.force_max", np.inf, above=0.0),
    "winch_tension": _of_cables(
        "N", "at the frame that the winch holds, 0: it holds the length", "cable.winch_tension", 0.0, least=0.0
    ),
    "lump_place": Parameter(
        (CABLES, LUMPS),
        "m",
        "of point masses on the cable, unstrained, from the platform on",
        "lumps[]",
        0.0,
        least=0.0,
    ),
    "lump_mass": Parameter((CABLES, LUMPS), "kg", "of them", "lumps[]", 0.0, least=0.0),
    "masts": Parameter((CABLES, CABLES), "1", "1 where cables share a mast, by the frame anchors", "", 1.0),
    "uprights": Parameter((CABLES, CABLES), "1", "U, exits moved by a unit compliance of uprights: U U^T F", "", 0.0),
}
EXTENSIONS: dict[str, Parameter] = {
    "series_compliance": _extra(_EACH, 0.0, "m/N", "spring in line with the cable, at its frame end",
                                least=0.0, most=0.1),
    "frame_compliance": _extra(_EACH, 0.0, "m/N", "of the mast, alike in all directions; one a mast",
                               least=0.0, most=0.1),
    "mast_bending": _extra(_EACH, 0.0, "m/N", "of the mast as an upright that bends sideways, at its highest exit",
                           least=0.0, most=0.1),
    "mast_mass": _extra(_EACH, 0.0, "kg", "moving with the exit on the mast, for vibration only", least=0.0),
    "mast_foot": _extra((), 0.0, "m", "height z, world, at which uprights are clamped"),
    "hose": _extra((), 0.0, "N/m", "stiffness that holds the platform origin to hose_center", least=0.0),
    "hose_center": _extra((3,), 0.0, "m", "where the hose is relaxed, world frame"),
    "force": _extra((3,), 0.0, "N", "constant force on the platform origin, world frame"),
    "moment": _extra((3,), 0.0, "N m", "constant moment on the platform, world frame, however it turns"),
    "drag_area": _extra((), 0.0, "m^2", "of the platform in wind: drag coefficient times area", least=0.0),
    "drag_width": _extra(_EACH, 0.0, "m", "of the cable in wind: drag coefficient times diameter", least=0.0),
    "wind": _extra((3,), 0.0, "m/s", "velocity of the air, world frame"),
    "air_density": _extra((), 1.225, "kg/m^3", "of drag_area and drag_width", least=0.0),
    "tilt": _extra((2,), 0.0, "rad", "of the platform's weight: m g (tilt_x, tilt_y, -1)"),
    "nonlinearity": _extra((), 0.0, "1", "k in EA (1 + k (T / T0 - 1)), T the tension at the platform"),
    "stiffening_exponent": _extra((), 0.0, "1", "n in EA (T / T0)^n, secant, T the tension at the platform",
                                  least=-0.9, most=0.9),
    "incremental_ratio": _extra((), 1.0, "1", "EA of small motion over the secant, 1 / (1 - n) of a power law",
                                above=0.0),
    "reference_tension": _extra((), 1.0, "N", "T0 of nonlinearity and stiffening_exponent", above=0.0),
    "length_offset": _extra(_EACH, 0.0, "m", "length paid out = encoder length * length_scale + length_offset"),
    "length_scale": _extra(_EACH, 1.0, "1", "see length_offset", above=0.0),
    "temperature_change": _extra((), 0.0, "K", "of the cables, above that at which their lengths are entered",
                                 least=-300.0, most=300.0),
    "bending_stiffness": _extra(_EACH, 0.0, "N m^2", "EI of the cable", least=0.0),
    "bending_fixity": _extra(_EACH, 1.0, "1", "of the ends of a cable that resists bending: 0 pinned, 1 clamped",
                             least=0.0, most=1.0),
    "added_mass": _extra(_EACH, 0.0, "kg", "on the free cable, for vibration only", least=0.0),
    "added_mass_place": _extra(_EACH, 0.5, "1", "of added_mass, share of the unstrained length from the platform end",
                               least=0.0, most=1.0),
    "cell_gain": _extra(_EACH, 1.0, "1", "load cell reading = cell_gain * tension + cell_bias", above=0.0),
    "cell_bias": _extra(_EACH, 0.0, "N", "see cell_gain"),
    "friction": _extra(_EACH, 0.0, "1", "load cell = tension * exp(friction * last direction * turn at the exit)"),
    "bearing_friction": _extra(_EACH, 0.0, "1", "mu r / R of the pulley at the exit, mu and r of its bearing",
                               least=0.0, most=0.9),
    "pulley_drag": _extra(_EACH, 0.0, "N", "constant friction at the rim of the pulley at the exit"),
    "backlash": _extra(_EACH, 0.0, "m", "of the drive: paid out is longer by half of it times the last direction"),
    "tracker": _extra((6,), 0.0, "m, rad", "true pose = tracker's pose, turned and shifted by this"),
    "creep": _extra((), 0.0, "1", "share of the elastic strain per decade of time after 1 min"),
    "slip": _extra(_EACH, 0.0, "m/h", "of the winch"),
    "swivel_zero": _extra(_EACH, 0.0, "rad", "reading of a pulley's swivel encoder = its swivel angle + swivel_zero"),
    "encoder_delay": _extra(_EACH, 0.0, "s", "by which lengths are older than the poses that are filed with them"),
    "cell_delay": _extra(_EACH, 0.0, "s", "by which tensions are older than the poses that are filed with them"),
    "clock_drift": _extra((), 0.0, "1", "by how much faster the clock of poses runs than that of lengths and tensions"),
    "clock_start": _extra((), 0.0, "s", "time_s at which these clocks agree"),
    "accelerometer_gain": _extra((6,), 1.0, "1", "accelerometer reading = gain * acceleration, x to rz", above=0.0),
    "sensor_mass": _extra((), 0.0, "kg", "on the platform origin while vibration is measured, not when tensions are",
                          least=0.0),
    "internal_mass": _extra((), 0.0, "kg", "of the platform's mass, what sits at its origin on an elastic mount",
                            least=0.0),
    "internal_frequency": _extra((), 0.0, "Hz", "of internal_mass on its mount, the platform held", least=0.0),
    "internal_direction": _extra((3,), (0.0, 0.0, 1.0), "1", "unit vector along which internal_mass moves, platform"),
    "swinging_mass": _extra((), 0.0, "kg", "of the platform's mass, what hangs from a point and swings", least=0.0),
    "swinging_frequency": _extra((), 0.0, "Hz", "of swinging_mass, the platform held: root of g / l of a pendulum",
                                 least=0.0),
    "swinging_place": _extra((3,), 0.0, "m", "where swinging_mass hangs and counts as a point mass, platform frame"),
}  # fmt: skip
"""Those that the table [extensions] of a robot file holds under their own names."""
PARAMETERS: dict[str, Parameter] = {**_RULES, **EXTENSIONS}
SENSORS = (
    "cell_gain", "cell_bias", "friction", "bearing_friction", "pulley_drag", "backlash", "tracker", "creep", "slip",
    "encoder_delay", "cell_delay", "clock_drift", "accelerometer_gain", "sensor_mass", "swivel_zero",
)  # fmt: skip
"""Act only where readings are compared: they describe sensors, or need the time of a reading."""
AUXILIARY = {
    "bending_fixity": ("bending_stiffness",),
    "added_mass_place": ("added_mass",),
    "mast_foot": ("mast_bending",),
    "clock_start": ("clock_drift",),
    "wind": ("drag_area", "drag_width"),
    "air_density": ("drag_area", "drag_width"),
    "hose_center": ("hose",),
    "reference_tension": ("nonlinearity", "stiffening_exponent"),
    "internal_frequency": ("internal_mass",),
    "internal_direction": ("internal_mass",),
    "swinging_frequency": ("swinging_mass",),
    "swinging_place": ("swinging_mass",),
}
"""Mean something only with one of the other parameters."""
