"""The exact cables of a robot at rest without some of the effects that the closed form neglects.

    pulleys        off: the cables start from fixed points, where they leave their pulleys
    static_strain  off: the cables at rest are inextensible, and vibrate with their EA
    axial_inertia  off: motion along a cable has no inertia
    along_weight   off: the weight along the chord is taken away, the tension varies with the sag only
    geometric_term off: eq. (3.8) as printed, without the work of the static forces on the turning lever arms

Chord, chord tension, EA and density stay. `limits_reference` has the same switches for one cable in units of its own.
"""

from dataclasses import replace

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at, frame_ends
from cdpr_struct.dynamics.catenary_expansion import LeftOut, expand_catenaries
from cdpr_struct.dynamics.modal_expansion import ModalExpansion
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.catenary_length import length_at_chord_tension

CABLE_EFFECTS = ("static_strain", "axial_inertia", "along_weight")
_INEXTENSIBLE = 1e9  # EA over chord tension
_WEIGHTLESS = 1e-6  # least share of the weight that stays across the chord: a vertical cable keeps a direction of sag


def neglected(point: OperatingPoint, model: str, assembly: Assembly) -> tuple[str, ...]:
    """The effects that the model ("dsm" or "exact") with this assembly lacks at this robot."""
    effects: tuple[str, ...] = ("geometric_term",) if assembly == "thesis" else ()
    if model == "exact":
        return effects
    return (*(("pulleys",) if point.arrays.has_pulleys else ()), *CABLE_EFFECTS, *effects)


def assembly_without(off: frozenset[str]) -> Assembly:
    """The assembly of the reference without some effects."""
    return "thesis" if "geometric_term" in off else "consistent"


def expansion_without(point: OperatingPoint, off: frozenset[str], order: int) -> ModalExpansion:
    """Expansion of the exact cables (m,) without the effects `off`, in polynomials of this order."""
    base = _without_pulleys(point) if "pulleys" in off else point
    if not off.intersection(CABLE_EFFECTS):
        return expand_catenaries_at(base, order)
    cables = _shape_at_rest(base.cables, off)
    stiffness = np.broadcast_to(base.cables.axial_stiffness, cables.length.shape)
    left_out = LeftOut(stiffness if "static_strain" in off else None, "axial_inertia" in off)
    density = np.broadcast_to(base.arrays.linear_density, cables.length.shape)
    return expand_catenaries(cables, density, order, np.zeros((len(density), 3, 3)), frame_ends(base), None, left_out)


def _without_pulleys(point: OperatingPoint) -> OperatingPoint:
    arrays = replace(point.arrays, pulley_radius=np.zeros_like(point.arrays.pulley_radius))
    cables = replace(point.cables, wrapped_length=np.zeros_like(point.cables.wrapped_length))
    return OperatingPoint(arrays, point.position, point.rotation, cables)


def _shape_at_rest(cables: CableStates, off: frozenset[str]) -> CableStates:
    """The cables through the same end points with the same tension along the chord, without some effects."""
    if not off.intersection(("static_strain", "along_weight")):
        return cables
    heading, up, span, rise, weight = cables.heading, cables.up, cables.span, cables.rise, cables.weight
    if "along_weight" in off:
        chord = cables.chord
        heading = cables.offset / chord[:, None]
        up = np.cross(heading, np.cross(cables.up, cables.heading))
        span, rise = chord, np.zeros_like(chord)
        weight = weight * np.maximum(np.cos(cables.inclination), _WEIGHTLESS)
    tension = cables.tension
    stiffness = np.broadcast_to(cables.axial_stiffness, tension.shape)
    stiffness = _INEXTENSIBLE * tension if "static_strain" in off else stiffness
    held = length_at_chord_tension(span, rise, tension, stiffness, weight)
    return replace(
        cables, heading=heading, up=up, weight=weight, length=held.length, force_x=held.force_x, force_z=held.force_z,
        axial_stiffness=stiffness,
    )  # fmt: skip
