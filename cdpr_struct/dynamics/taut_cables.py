"""The cables as the closed-form DSM sees them: taut, with a small parabolic sag about the chord."""

from dataclasses import dataclass, fields

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError
from cdpr_struct.generated import cable_dsm
from cdpr_struct.statics.cable_state import CableStates


@dataclass(frozen=True, slots=True, eq=False)
class TautCables:
    """The parameters of the small-sag dynamic stiffness, arrays (..., m), SI.

    `frame` (..., m, 3, 3) has the cable axes as columns in the world: x along the chord from the frame to the
    platform, y across the plane in which the cable hangs (horizontal without wind), z in that plane and upwards.
    """

    chord: np.ndarray
    tension: np.ndarray
    axial_stiffness: np.ndarray
    effective_length: np.ndarray
    linear_density: np.ndarray
    perpendicular_weight: np.ndarray
    damping_ratio: np.ndarray
    epsilon: np.ndarray
    lambda_squared: np.ndarray
    frame: np.ndarray

    @property
    def frequency_scale(self) -> np.ndarray:
        """omega / Omega = sqrt(tau / mu) / l_c [rad/s], eq. (2.38)."""
        return np.sqrt(self.tension / self.linear_density) / self.chord

    def flattened(self) -> "TautCables":
        """The same cables with the batch of poses and m in one axis."""
        shape = self.chord.shape
        flat = {f.name: np.broadcast_to(getattr(self, f.name), shape).reshape(-1) for f in fields(self)[:-1]}
        return TautCables(**flat, frame=self.frame.reshape((-1, 3, 3)))


def taut_cables(point: OperatingPoint) -> TautCables:
    """Parameters (2.36)-(2.38) of the cables' closed-form dynamic stiffness.

    Along the chord this model has no inertia, so the change of tension is the same all along the cable and an element
    in line adds its compliance to that of the cable, L_e / EA.

    Raises
    ------
    CdprError : a cable carries no tension along its chord, so it has no small-sag stiffness; or its winch holds the
        tension, so that it slides along its chord, where this model has no inertia.
    """
    cables, robot = point.cables, point.arrays
    if robot.has_tension_winches:
        number = int(np.argwhere(np.broadcast_to(robot.winch_tension > 0.0, cables.chord.shape))[0][-1]) + 1
        raise CdprError(
            f"cable {number} has a winch_tension: the closed-form DSM has no inertia along the cable, where such a "
            "cable slides; use the model exact"
        )
    if robot.has_lumps:
        raise CdprError("the closed-form DSM knows no masses on cables (lumps); use the model exact")
    slack = ~(np.asarray(cables.tension) > 0.0)
    if slack.any():
        number = int(np.argwhere(slack)[0][-1]) + 1
        raise CdprError(f"cable {number} carries no tension along its chord: the closed-form DSM needs taut cables")
    weight = robot.cable_load(cables.offset)[0] * np.cos(cables.inclination)
    epsilon = cable_dsm.epsilon(cables.chord, cables.tension, weight)
    effective = cable_dsm.effective_length_integral(cables.chord, epsilon)
    ea = cables.axial_stiffness / (1.0 + robot.series_compliance * cables.axial_stiffness / effective)
    return TautCables(
        chord=cables.chord,
        tension=cables.tension,
        axial_stiffness=ea,
        effective_length=effective,
        linear_density=np.broadcast_to(robot.linear_density, epsilon.shape),
        perpendicular_weight=weight,
        damping_ratio=np.broadcast_to(robot.damping_ratio, epsilon.shape),
        epsilon=epsilon,
        lambda_squared=cable_dsm.lambda_squared(cables.chord, cables.tension, ea, effective, weight),
        frame=_chord_frame(cables),
    )


def _chord_frame(cables: CableStates) -> np.ndarray:
    along = cables.offset / cables.chord[..., None]
    sideways = np.cross(cables.up, cables.heading)
    return np.stack([along, sideways, np.cross(along, sideways)], axis=-1)


def closed_form_stiffness(cables: TautCables, omega_c_squared: np.ndarray) -> np.ndarray:
    """Force that holds the platform end of each cable against a unit harmonic displacement.

    Parameters
    ----------
    cables : shape (..., m)
    omega_c_squared : broadcasts against (..., m) [rad^2/s^2]; complex for damped cables

    Returns
    -------
    (..., m, 3, 3) array [N/m], world axes, symmetric.

    Eqs (2.31)-(2.35), rotated by (2.46) and (3.7).
    """
    k_xx, k_xz, k_yy, k_zz = cable_dsm.dynamic_stiffness(
        omega_c_squared,
        cables.chord,
        cables.tension,
        cables.axial_stiffness,
        cables.effective_length,
        cables.linear_density,
        cables.perpendicular_weight,
    )
    local = np.zeros((*k_xx.shape, 3, 3), dtype=k_xx.dtype)
    local[..., 0, 0], local[..., 1, 1], local[..., 2, 2] = k_xx, k_yy, k_zz
    local[..., 0, 2] = local[..., 2, 0] = k_xz
    return cables.frame @ local @ np.swapaxes(cables.frame, -1, -2)
