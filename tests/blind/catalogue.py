"""The effects that can be hidden: field, shape, how large it can plausibly be, and what it cannot be told from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.blind.deviations import field_sizes


@dataclass(frozen=True)
class Effect:
    """One hidden effect.

    name    : the cause's name, or a name of its own if it is outside the library
    unit    : of its size
    shapes  : ways to spread it, one is drawn: `common`, `one` entry, `point` (one anchor), `spread` (all, random),
              `direction` (a random unit vector)
    signed  : may also be negative
    largest : size beyond which it would be absurd
    rivals  : names that all data of a campaign leave equally likely
    typical : size to be multiplied where no smallest detectable one was measured
    """

    name: str
    unit: str
    shapes: tuple[str, ...]
    signed: bool = True
    largest: float = np.inf
    rivals: tuple[str, ...] = ()
    typical: float = 0.0


LIBRARY = {
    effect.name: effect
    for effect in (
        Effect("axial_stiffness", "ln ratio", ("common", "one"), largest=0.5),
        Effect("cable_linear_density", "ln ratio", ("common", "one"), largest=0.4),
        Effect("platform_mass", "kg", ("common",), largest=20.0),
        Effect("center_of_mass", "m", ("direction",), largest=0.1),
        Effect("platform_inertia", "ln ratio", ("common", "one"), largest=0.7),
        Effect("frame_anchor_position", "m", ("point", "spread"), largest=0.03),
        Effect("platform_anchor_position", "m", ("point", "spread"), largest=0.03),
        Effect("unstrained_length_offset", "m", ("one", "spread"), largest=0.03),
        Effect("drum_scale", "ratio - 1", ("common",), largest=0.005),
        Effect("temperature", "K", ("common",), largest=50.0),
        Effect("frame_compliance", "m/N", ("common", "one"), signed=False, largest=1e-4),
        Effect("pulley_radius", "m", ("common",), largest=0.04),
        Effect("joint_mass", "kg", ("common",), signed=False, largest=2.0),
        Effect("external_force", "N", ("direction",), largest=100.0),
        Effect("hose_stiffness", "N/m", ("common",), signed=False, largest=200.0),
        Effect("gravity_tilt", "rad", ("direction",), largest=0.1),
        Effect("tracker_frame", "m, rad", ("direction",), largest=0.05),
        Effect("load_cell_gain", "ratio - 1", ("one", "spread"), largest=0.3),
        Effect("load_cell_bias", "N", ("one", "spread"), largest=60.0),
        Effect("pulley_friction", "ln ratio per 90 deg", ("common", "one"), signed=False, largest=0.2),
        Effect("internal_force", "N", ("direction",), largest=60.0),
    )
}

EQUIVALENT = {
    effect.name: effect
    for effect in (
        Effect("joint_compliance", "m/N", ("common",), signed=False, largest=3e-5, rivals=("dead_length",)),
        Effect("dead_length", "m", ("common",), signed=False, largest=8.0, rivals=("joint_compliance",)),
        Effect("drum_scale", "ratio - 1", ("common",), largest=0.005, rivals=("temperature",)),
        Effect("platform_mass", "kg", ("common",), largest=20.0, rivals=("joint_mass", "external_force")),
        Effect("pulley_friction", "ln ratio per 90 deg", ("one",), False, 0.2, rivals=("load_cell_gain",)),
        Effect("tracker_frame", "m, rad", ("shift",), largest=0.05, rivals=("frame_anchor_position",)),
    )
}

OUTSIDE = {
    effect.name: effect
    for effect in (
        Effect("backlash", "m", ("common",), signed=False),
        Effect("wind_gradient", "N/m^2", ("horizontal",)),
        Effect("cell_quadratic", "N at 300 N", ("common",)),
        Effect("cell_crosstalk", "ratio", ("common",), signed=False),
        Effect("platform_hinge", "m", ("common",), signed=False),
        Effect("drum_eccentricity", "m", ("common",), signed=False),
    )
}

UNSEEN = {
    effect.name: effect
    for effect in (
        Effect("cable_warming", "K", ("common",), largest=40.0),
        Effect("construction_stretch", "strain", ("common",), signed=False, largest=2e-3),
        Effect("tracker_lens", "m at 3 m", ("common",), largest=0.05),
        Effect("tool_balancer", "N", ("common",), signed=False, largest=150.0),
        Effect("hook_offset", "m", ("direction",), largest=0.2),
        Effect("cell_settling", "share", ("common",), signed=False, largest=0.3),
    )
}

OUTSIDE_DEV = {
    effect.name: effect
    for effect in (
        Effect("gusts", "N, rms an axis", ("common",), signed=False),
        Effect("cell_tilt", "N at 0.1 rad", ("common",)),
        Effect("anchor_settling", "m", ("common",), signed=False),
        Effect("tracker_shear", "m at 3 m", ("common",)),
        Effect("encoder_quadratic", "m at 3 m", ("common",)),
        Effect("floor_magnet", "N at 1 m", ("common",), signed=False),
    )
}

OUTSIDE_HELD = {
    effect.name: effect
    for effect in (
        Effect("cell_fading", "ratio - 1 at the end", ("common",)),
        Effect("noon_frame", "m", ("common",)),
        Effect("tracker_heading", "rad at 3 m", ("common",)),
        Effect("second_layer", "m", ("common",), typical=1e-3),
        Effect("clamp_slip", "m", ("common",), signed=False),
        Effect("cubic_hose", "N at 1 m", ("common",), signed=False),
    )
}

STATIC_OUTSIDE = {**OUTSIDE_DEV, **OUTSIDE_HELD}  # of sets without frequencies

LAWS = {
    effect.name: effect
    for effect in (
        Effect("bearing_friction", "mu r / R", ("common",), signed=False, typical=0.03),
        Effect("backlash", "m", ("common",), signed=False, typical=1e-3),
        Effect("swinging_payload", "share of the mass", ("common",), signed=False, largest=0.4, typical=0.25),
        Effect("power_elasticity", "exponent", ("common",), signed=False, largest=0.5, typical=0.25),
    )
}  # of a set of its own: causes, or shapes of causes, that came into the library after the other sets had been drawn

RARE = {
    effect.name: effect
    for effect in (
        Effect("brake_slip", "m/h", ("one",), typical=2e-3),
        Effect("creep", "1 a decade", ("common",), signed=False, typical=0.15),
        Effect("accelerometer_mass", "kg", ("common",), signed=False, typical=6.0),
        Effect("cable_added_mass", "kg", ("one",), signed=False, typical=0.06),
        Effect("flexible_platform", "share of the mass", ("one",), signed=False, typical=0.4),
    )
}  # causes of the library that the other sets do not hide, in campaigns that note the time
LAWS |= RARE

CAME_IN = ("construction_stretch",)  # drawn as outside the library: a rope that stiffens as its wires bed down
CAUSES = {  # where the name differs
    "bearing_friction": "pulley_friction",
    "power_elasticity": "nonlinear_elasticity",
    "construction_stretch": "nonlinear_elasticity",
}

BEYOND = {**OUTSIDE, **UNSEEN, **STATIC_OUTSIDE}  # what no cause of the library explains

HANDLING = ("swapped_channels", "unit_error", "sign_error", "pose_mismatch")
CONVENTION = "rotation_convention"  # in a set of its own
STATICS_ONLY = ("platform_mass",)  # filed without robot frequencies; weighing the platform separates
UNSEEN_IN_STATICS = ("platform_inertia",)  # nothing at rest shows it
ONE_SIDED = ("pulley_friction",)  # equivalent if every cable is always approached from the same side


def drawn_pattern(effect: Effect, cables: int, rng: np.random.Generator) -> tuple[str, np.ndarray]:
    """Shape drawn, and the change of the field per unit size."""
    size = field_sizes(cables)[effect.name]
    shape = str(rng.choice(effect.shapes))
    pattern = _shaped(shape, size, rng)
    sign = rng.choice([-1.0, 1.0]) if effect.signed and shape in ("common", "one") else 1.0
    return shape, sign * pattern


def unknowns(shape: str, pattern: np.ndarray) -> int:
    """Numbers that somebody who knows the shape, but not the pattern, would have to find."""
    return 1 if shape == "common" else int(np.count_nonzero(pattern))


def _shaped(shape: str, size: int, rng: np.random.Generator) -> np.ndarray:
    """Unit pattern (size,): ones, one entry, or numbers of unit norm or unit rms."""
    pattern = np.zeros(size)
    if shape == "common":
        return np.ones(size)
    if shape == "one":
        pattern[rng.integers(size)] = 1.0
    elif shape == "point":
        first = 3 * int(rng.integers(size // 3))
        pattern[first : first + 3] = _unit(rng, 3)
    elif shape == "spread":
        pattern = _unit(rng, size) * np.sqrt(size)
    elif shape in ("shift", "horizontal"):
        held = 3 if shape == "shift" else 2
        pattern[:held] = _unit(rng, held)
    else:
        pattern = _unit(rng, size)
    return pattern


def _unit(rng: np.random.Generator, size: int) -> np.ndarray:
    drawn = rng.standard_normal(size)
    return np.asarray(drawn / np.linalg.norm(drawn))
