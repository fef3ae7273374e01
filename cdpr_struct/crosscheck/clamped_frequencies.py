"""Natural frequencies of one cable between held ends, without the limits of the closed form: catenary, and FEM."""

import numpy as np

import cdpr_struct.fem_reference as fem
from cdpr_struct.dynamics.clamped_catenary import clamped_frequencies, enough_polynomials
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.pulled_cables import pulled_cables

MESHES = (40, 80, 160, 320)
"""Numbers of elements from which the FEM is extrapolated."""


def pulled_cable(
    force: tuple[float, float], end: tuple[float, float], length: float, axial_stiffness: float, weight: float
) -> CableStates:
    """One cable (1,) from the origin to `end` (x, z) [m], held there by a force (x, z) [N]; x turned positive."""
    one = np.ones(1)
    return pulled_cables(np.array([force]), np.array([end]), length * one, axial_stiffness * one, weight * one)


def catenary_frequencies(cable: CableStates, density: float, count: int, finer: float = 1.0) -> dict[str, list[float]]:
    """The first `count` of each plane [Hz], of the linearised elastic catenary: any sag, any inclination.

    finer : times the usual order of polynomials, to see what that changes
    """
    order = int(finer * enough_polynomials(cable, count))
    in_plane, across = clamped_frequencies(cable, np.array([density]), order)
    hertz = {"out_of_plane": across, "in_plane": in_plane}
    return {plane: (omega[0, :count] / (2.0 * np.pi)).tolist() for plane, omega in hertz.items()}


def fem_frequencies(cable: CableStates, density: float, gravity: float, count: int) -> list[float]:
    """The first `count` of both planes together [Hz], of bar elements, extrapolated to infinitely many."""
    data = fem.CableData(float(cable.length[0]), float(cable.axial_stiffness[0]), density)
    meshes = (fem.solve_cable(data, np.zeros(3), cable.offset[0], n, (0.0, 0.0, -gravity)) for n in MESHES)
    hertz = np.array([fem.cable_modes(mesh, count).frequencies_hz for mesh in meshes])
    return np.asarray(fem.extrapolate(MESHES, hertz).limit).tolist()
