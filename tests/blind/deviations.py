"""By how much the real robot and its sensors differ from what was entered. All zero is the entered robot.

Tolerances and hidden effects are both changes of these fields, so that an effect of size zero is the null.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

EXPANSION = 1.2e-5  # 1/K, steel: cables and frame


NUMBERS_PER_CABLE = {
    "frame_anchor_position": 3,  # m, cable by cable, x y z
    "platform_anchor_position": 3,  # m
    "unstrained_length_offset": 1,  # m
    "axial_stiffness": 1,  # ln ratio
    "cable_linear_density": 1,  # ln ratio
    "joint_compliance": 1,  # m/N, a spring in series with each cable
    "dead_length": 1,  # m of cable between winch and exit
    "pulley_radius": 1,  # m
    "joint_mass": 1,  # kg at each platform anchor
    "load_cell_gain": 1,  # ratio - 1
    "load_cell_bias": 1,  # N
    "pulley_friction": 1,  # ln of the ratio winch side : platform side, per 90 degrees of wrap
    "brake_slip": 1,  # m/h that a winch pays out although its encoder stands still
    "cable_added_mass": 1,  # kg at ADDED_AT of the cable's length from the platform
    "bearing_friction": 1,  # mu r / R of the wheel at the exit, mu and r of its bearing
}
NUMBERS_PER_ROBOT = {
    "drum_scale": 1,  # ratio - 1
    "temperature": 1,  # K, cables and frame expand
    "platform_mass": 1,  # kg
    "center_of_mass": 3,  # m
    "platform_inertia": 3,  # ln ratio, axes of the platform
    "frame_compliance": 4,  # m/N, one a mast
    "external_force": 3,  # N, world, at the platform origin
    "hose_stiffness": 1,  # N/m, towards the home position
    "gravity_tilt": 2,  # rad, gravity turned about x, y
    "tracker_frame": 6,  # m, rad: shift and turn of what the tracker calls the world
    "internal_force": 2,  # N, along two directions of the null space
    "creep": 1,  # share of the elastic strain that a decade of time adds after the first minute
    "accelerometer_mass": 1,  # kg at the platform origin while vibration is measured, and only then
    "flexible_platform": 3,  # share of the platform's mass that sits on a spring along an axis of the platform
    "swinging_payload": 1,  # share of the platform's mass that hangs on a cord from its origin
    "power_elasticity": 1,  # exponent of EA over the tension, of an elastic rope
    # outside the library of causes when the sets were drawn
    "backlash": 1,  # m, with the sign of the last motion of the winch
    "wind_gradient": 3,  # N a metre from home, squared distance
    "cell_quadratic": 1,  # N at 300 N
    "cell_crosstalk": 1,  # share of the next cable's tension
    "platform_hinge": 1,  # m, the centre of mass tips over with the platform
    "drum_eccentricity": 1,  # m, periodic in the paid-out length
    # outside the library and unseen by those who wrote it
    "cable_warming": 1,  # K, of the cables alone, from the first state filed to the last
    "construction_stretch": 1,  # strain that a rope gains when its wires bed down under tension
    "tracker_lens": 1,  # m at 3 m from the middle of the picture, with the cube of that distance
    "tool_balancer": 1,  # N, a line of constant force towards a hook above the platform
    "hook_offset": 2,  # m, x y of the platform: the payload hangs beside the origin
    "cell_settling": 1,  # share of the last state's reading that is still in this one
    # outside the library, of sets without frequencies
    "gusts": 1,  # N, a force that is drawn anew at every state
    "cell_tilt": 1,  # N at 0.1 rad of platform tilt, cells in turn with and against it
    "anchor_settling": 1,  # m by which the first two exits sink, most of it early in the campaign
    "tracker_shear": 1,  # m in x at 3 m in y
    "encoder_quadratic": 1,  # m of cable at 3 m from the middle of the drum, with the square of that distance
    "floor_magnet": 1,  # N at 1 m, pulls down to a place on the floor with the inverse square of the distance
    "cell_fading": 1,  # ratio - 1 of all cells at the last state, nothing at the first
    "noon_frame": 1,  # m by which exits at 5 m from the middle are farther out at noon, half way through the campaign
    "tracker_heading": 1,  # rad about the vertical that the tracker adds at 3 m in x
    "second_layer": 1,  # m that a drum pays out more beyond its length at home, where its rope lies in one layer
    "clamp_slip": 1,  # m by which the third cable is longer in the later half of the campaign
    "cubic_hose": 1,  # N at 1 m from home, with the cube of that distance
}


def field_sizes(cables: int) -> dict[str, int]:
    """Length of every field for a robot of m cables."""
    return {name: count * cables for name, count in NUMBERS_PER_CABLE.items()} | NUMBERS_PER_ROBOT


@dataclass(frozen=True, eq=False)
class Deviations:
    """Values of all fields."""

    fields: Mapping[str, np.ndarray]

    @classmethod
    def none(cls, cables: int) -> Deviations:
        """The robot exactly as entered."""
        return cls({name: np.zeros(size) for name, size in field_sizes(cables).items()})

    def __getitem__(self, name: str) -> np.ndarray:
        return self.fields[name]

    def plus(self, name: str, change: np.ndarray) -> Deviations:
        """The same with one field changed."""
        changed = self.fields[name] + change
        return Deviations({**self.fields, name: changed})


# 1 sigma of what is never exactly known, by the keys of a campaign file
TOLERANCES = {
    "anchor_m": 0.0005,
    "length_m": 0.0005,
    "axial_stiffness": 0.03,
    "linear_density": 0.01,
    "platform_mass_kg": 0.1,
    "center_of_mass_m": 0.002,
    "platform_inertia": 0.05,
    "load_cell_gain": 0.005,
    "load_cell_bias_N": 0.5,
    "pulley_radius_m": 0.0002,
}

# which fields each tolerance fills, and whether half of the variance is common to all cables
TOLERANCE_FIELDS = {
    "anchor_m": (("frame_anchor_position", "platform_anchor_position"), False),
    "length_m": (("unstrained_length_offset",), False),
    "axial_stiffness": (("axial_stiffness",), True),
    "linear_density": (("cable_linear_density",), True),
    "platform_mass_kg": (("platform_mass",), False),
    "center_of_mass_m": (("center_of_mass",), False),
    "platform_inertia": (("platform_inertia",), False),
    "load_cell_gain": (("load_cell_gain",), False),
    "load_cell_bias_N": (("load_cell_bias",), False),
    "pulley_radius_m": (("pulley_radius",), False),
}


def tolerance_columns(cables: int) -> list[tuple[str, np.ndarray]]:
    """(field, change) per standard normal number of the null; their squares sum to its covariance."""
    columns = []
    sizes = field_sizes(cables)
    for key, (names, reel) in TOLERANCE_FIELDS.items():
        own = TOLERANCES[key] * (np.sqrt(0.5) if reel else 1.0)
        for name in names:
            columns += [(name, own * row) for row in np.eye(sizes[name])]
            if reel:
                columns.append((name, np.full(sizes[name], own)))
    return columns


def drawn_tolerances(cables: int, rng: np.random.Generator) -> Deviations:
    """One robot as it may leave the workshop."""
    drawn = Deviations.none(cables)
    columns = tolerance_columns(cables)
    for (name, change), number in zip(columns, rng.standard_normal(len(columns)), strict=True):
        drawn = drawn.plus(name, number * change)
    return drawn
