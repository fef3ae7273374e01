"""Rigid platform on its cables: rotation, attachment, geometric stiffness, mass matrix (section 3.3).

Axes: all vectors and the six coordinates q = (delta, theta) in one frame with the origin at the reference
point; theta is the rotation vector of a small rotation, right-handed. Arms run from the reference point
outwards.
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations.symbols import (
    ax,
    ay,
    az,
    cx,
    cy,
    cz,
    fx,
    fy,
    fz,
    ixx,
    ixy,
    ixz,
    iyy,
    iyz,
    izz,
    mass,
    rx,
    ry,
    rz,
)

ARM = sp.Matrix([ax, ay, az])
FORCE = sp.Matrix([fx, fy, fz])
CENTRE = sp.Matrix([cx, cy, cz])
INERTIA = sp.Matrix([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
THETA = sp.Matrix(sp.symbols("theta_x theta_y theta_z", real=True))
DELTA = sp.Matrix(sp.symbols("delta_x delta_y delta_z", real=True))
COORDINATES = sp.Matrix([*DELTA, *THETA])


def cross_matrix(v: Any) -> Any:
    """[v]x with [v]x u = v x u."""
    return sp.Matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def rotation_about(axis: int, angle: Any) -> Any:
    """Right-handed rotation about one coordinate axis, as the exponential of the cross matrix of its axis."""
    unit = sp.Matrix([1 if i == axis else 0 for i in range(3)])
    K = cross_matrix(unit)
    return sp.eye(3) + sp.sin(angle) * K + (1 - sp.cos(angle)) * K * K


def rotation() -> Any:
    """R = Rz(rz) Ry(ry) Rx(rx)."""
    return rotation_about(2, rz) * rotation_about(1, ry) * rotation_about(0, rx)


def finite_rotation_second_order(theta: Any, arm: Any) -> Any:
    """exp([theta]x) arm up to second order in theta, from the exponential series."""
    K = cross_matrix(theta)
    return arm + K * arm + K * K * arm / 2


def attachment() -> Any:
    """A with delta_A = A q: linear part of delta + exp(theta) a - a."""
    displacement = DELTA + finite_rotation_second_order(THETA, ARM) - ARM
    jacobian = displacement.jacobian(COORDINATES)
    return jacobian.subs(dict.fromkeys(COORDINATES, 0))


def attachment_printed() -> Any:
    """A as printed in eq. (3.9)."""
    return sp.eye(3).row_join(sp.Matrix([[0, -az, ay], [az, 0, -ax], [-ay, ax, 0]]))


def geometric_stiffness() -> Any:
    """Hessian in theta of the potential -f . (exp(theta) a) of a constant force f at the arm a."""
    potential = -FORCE.dot(finite_rotation_second_order(THETA, ARM))
    return sp.hessian(potential, list(THETA)).applyfunc(sp.expand)


def mass_matrix() -> Any:
    """Hessian in q dot of T = m/2 |v_c|^2 + 1/2 w . I w with v_c = v + w x c."""
    velocity = DELTA + THETA.cross(CENTRE)
    kinetic = mass * velocity.dot(velocity) / 2 + THETA.dot(INERTIA * THETA) / 2
    return sp.hessian(kinetic, list(COORDINATES)).applyfunc(sp.expand)
