"""The finite-element referee on single cables: is the catenary right where it condemns the closed form?"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.limits_closed_form import clamped_frequencies
from cdpr_struct.crosscheck.limits_errors import ACROSS_MODES, IN_PLANE_MODES
from cdpr_struct.crosscheck.limits_groups import CableGroups
from cdpr_struct.crosscheck.limits_reference import reference_planes
from cdpr_struct.statics.catenary_length import length_at_chord_tension

ELEMENTS = (40, 80, 160)
_BETWEEN_POLES = (0.25, 0.6, 1.4)  # of the first out-of-plane frequency, where the stiffness is compared


@dataclass(frozen=True, slots=True, eq=False)
class RefereeVerdict:
    """One cable before the referee, relative deviations [-].

    closed_form  : largest error of a clamped frequency of the closed form against the extrapolated FEM
    catenary     : the same of the catenary;  uncertainty : of the extrapolated FEM itself
    stiffness    : largest deviation of the catenary's end stiffness from the FEM's, both ends, scaled by the static one
    """

    closed_form: float
    catenary: float
    uncertainty: float
    stiffness: float


def judge(groups: CableGroups, elements: Sequence[int] = ELEMENTS) -> list[RefereeVerdict]:
    """Have each cable judged; units of chord, chord tension and density become 1 m, 1 N, 1 kg/m."""
    return [_judge(groups.take(np.array([i])), elements) for i in range(len(groups))]


def _judge(one: CableGroups, elements: Sequence[int]) -> RefereeVerdict:
    planes = reference_planes(one, np.array([0.5]))
    meshes = [hang(one, n, upwards=True) for n in elements]
    known = fem.extrapolate(elements, [_frequencies(mesh) for mesh in meshes])
    catenary = np.concatenate(
        [planes.in_plane.frequencies[0, :IN_PLANE_MODES], planes.across.frequencies[0, :ACROSS_MODES]]
    )
    model = np.concatenate([clamped_frequencies(one, IN_PLANE_MODES)[0], np.pi * np.arange(1, ACROSS_MODES + 1)])
    return RefereeVerdict(
        closed_form=float(np.abs(model / known.limit - 1.0).max()),
        catenary=float(np.abs(catenary / known.limit - 1.0).max()),
        uncertainty=float((known.error_estimate / known.limit).max()),
        stiffness=_stiffness_deviation(one, meshes, elements),
    )


def hang(one: CableGroups, elements: int, upwards: bool) -> fem.CableEquilibrium:
    """The cable held at the origin, its moving end above or below."""
    angle = float(np.arctan2(one.along[0], one.epsilon[0])) * (1.0 if upwards else -1.0)
    x, z, weight = float(np.cos(angle)), float(np.sin(angle)), float(one.weight[0])
    length = float(length_at_chord_tension(x, z, 1.0, 1.0 / one.strain[0], weight).length)
    cable = fem.CableData(length, 1.0 / float(one.strain[0]), 1.0)
    return fem.solve_cable(cable, np.zeros(3), np.array([x, 0.0, z]), elements, np.array([0.0, 0.0, -weight]))


def _frequencies(mesh: fem.CableEquilibrium) -> np.ndarray:
    """First in-plane and out-of-plane Omega."""
    modes = fem.cable_modes(mesh, 4 * IN_PLANE_MODES)
    omega = 2.0 * np.pi * modes.frequencies_hz
    inside = modes.in_plane_share > 0.5
    return np.concatenate([omega[inside][:IN_PLANE_MODES], omega[~inside][:ACROSS_MODES]])


def _stiffness_deviation(one: CableGroups, meshes: list[fem.CableEquilibrium], elements: Sequence[int]) -> float:
    planes = reference_planes(one, np.array([0.5]))
    omega = np.pi * np.array(_BETWEEN_POLES)
    scale = np.sqrt(np.append(np.diagonal(planes.in_plane.static[0, 0]), planes.across.static[0, 0, 0, 0]))
    worst = 0.0
    for end, upwards in enumerate((True, False)):
        used = meshes if upwards else [hang(one, n, upwards) for n in elements]
        known = fem.extrapolate(elements, [_in_chord_axes(mesh, omega) for mesh in used]).limit
        ours = np.zeros_like(known)
        ours[:, :2, :2] = planes.in_plane.stiffness(omega[None])[0, end]
        ours[:, 2, 2] = planes.across.stiffness(omega[None])[0, end, :, 0, 0]
        worst = max(worst, float(np.abs((ours - known) / np.outer(scale, scale)).max()))
    return worst


def _in_chord_axes(mesh: fem.CableEquilibrium, omega: np.ndarray) -> np.ndarray:
    """End stiffness (f, 3, 3) in the axes along the chord, across it in the plane (up), and out of the plane."""
    stiffness = fem.end_dynamic_stiffness(mesh, omega, "consistent")
    along = mesh.nodes[-1] - mesh.nodes[0]
    along = along / np.linalg.norm(along)
    axes = np.array([along, [-along[2], 0.0, along[0]], [0.0, 1.0, 0.0]])
    return axes @ stiffness @ axes.T
