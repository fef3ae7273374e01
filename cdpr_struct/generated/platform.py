"""GENERATED FILE - do not edit.

Regenerate : python -m cdpr_struct.derivations
Source     : derivations/platform.py, eqs (3.8)-(3.19)
Made with  : sympy 1.14.0; 76 operations after cse
"""

from typing import Any

import numpy as np


def rotation(rx: Any, ry: Any, rz: Any) -> Any:
    """(..., 3, 3) rotation Rz(rz) Ry(ry) Rx(rx), platform to world [-].

    rx : [rad] about x, applied first
    ry : [rad] about y, applied second
    rz : [rad] about z, applied last

    Product of three exponentials, derivations/platform.py.
    """
    t0 = np.cos(ry)
    t1 = np.cos(rz)
    t2 = np.sin(rz)
    t3 = np.cos(rx)
    t4 = np.sin(ry)
    t5 = np.sin(rx)
    t6 = t1*t5
    t7 = t2*t5
    t8 = t1*t3
    entries = np.broadcast_arrays(
        t0*t1, -t2*t3 + t4*t6, t4*t8 + t7,
        t0*t2, t4*t7 + t8, t2*t3*t4 - t6,
        -t4, t0*t5, t0*t3,
    )
    return np.stack(entries, axis=-1).reshape((*entries[0].shape, 3, 3))


def attachment(ax: Any, ay: Any, az: Any) -> Any:
    """(..., 3, 6) map from (delta, theta) to the attachment's displacement delta + theta x a.

    ax : [m] arm from the reference point to the attachment
    ay : [m]
    az : [m]

    Columns 0-2 [-], 3-5 [m], in the axes of the arm.
    Eq. (3.9) corrected, derivations/platform.py.
    """
    entries = np.broadcast_arrays(
        1.0, 0.0, 0.0, 0.0, az, -ay,
        0.0, 1.0, 0.0, -az, 0.0, ax,
        0.0, 0.0, 1.0, ay, -ax, 0.0,
    )
    return np.stack(entries, axis=-1).reshape((*entries[0].shape, 3, 6))


def attachment_printed(ax: Any, ay: Any, az: Any) -> Any:
    """(..., 3, 6) eq. (3.9) as printed: the rotation is counted the other way round.

    ax : [m] arm from the reference point to the attachment
    ay : [m]
    az : [m]

    Columns 0-2 [-], 3-5 [m], in the axes of the arm.
    Eq. (3.9) printed, derivations/platform.py.
    """
    entries = np.broadcast_arrays(
        1.0, 0.0, 0.0, 0.0, -az, ay,
        0.0, 1.0, 0.0, az, 0.0, -ax,
        0.0, 0.0, 1.0, -ay, ax, 0.0,
    )
    return np.stack(entries, axis=-1).reshape((*entries[0].shape, 3, 6))


def geometric_stiffness(fx: Any, fy: Any, fz: Any, ax: Any, ay: Any, az: Any) -> Any:
    """(..., 3, 3) symmetric stiffness [N m/rad] on theta from a constant force on a rotating arm.

    fx : [N] constant force on the platform at the end of the arm
    fy : [N]
    fz : [N]
    ax : [m] arm from the reference point to the attachment
    ay : [m]
    az : [m]

    Force and arm in the same axes. Adds to A^T K A.
    Missing in eq. (3.8), derivations/platform.py.
    """
    t0 = ay*fy
    t1 = az*fz
    t2 = (1/2)*ax
    t3 = (1/2)*fx
    t4 = -ay*t3 - fy*t2
    t5 = -az*t3 - fz*t2
    t6 = ax*fx
    t7 = -1/2*ay*fz - 1/2*az*fy
    entries = np.broadcast_arrays(
        t0 + t1, t4, t5,
        t4, t1 + t6, t7,
        t5, t7, t0 + t6,
    )
    return np.stack(entries, axis=-1).reshape((*entries[0].shape, 3, 3))


def mass_matrix(mass: Any, cx: Any, cy: Any, cz: Any, ixx: Any, iyy: Any, izz: Any, ixy: Any, ixz: Any, iyz: Any) -> Any:
    """(..., 6, 6) mass matrix about the reference point, for (delta, theta).

    mass : [kg]
    cx   : [m] centre of mass from the reference point
    cy   : [m]
    cz   : [m]
    ixx  : [kg m^2] inertia tensor about the centre of mass
    iyy  : [kg m^2]
    izz  : [kg m^2]
    ixy  : [kg m^2] tensor element, -int(x y dm)
    ixz  : [kg m^2] tensor element, -int(x z dm)
    iyz  : [kg m^2] tensor element, -int(y z dm)

    Centre of mass and inertia in the axes of the result.
    Eq. (3.12), derivations/platform.py.
    """
    t0 = cz*mass
    t1 = cy*mass
    t2 = -t1
    t3 = -t0
    t4 = cx*mass
    t5 = -t4
    t6 = cy**2*mass
    t7 = cz**2*mass
    t8 = -cx*t1 + ixy
    t9 = -cx*t0 + ixz
    t10 = cx**2*mass
    t11 = -cy*t0 + iyz
    entries = np.broadcast_arrays(
        mass, 0.0, 0.0, 0.0, t0, t2,
        0.0, mass, 0.0, t3, 0.0, t4,
        0.0, 0.0, mass, t1, t5, 0.0,
        0.0, t3, t1, ixx + t6 + t7, t8, t9,
        t0, 0.0, t5, t8, iyy + t10 + t7, t11,
        t2, t4, 0.0, t9, t11, izz + t10 + t6,
    )
    return np.stack(entries, axis=-1).reshape((*entries[0].shape, 6, 6))
