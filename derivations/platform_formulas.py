"""Verdicts on eqs (3.8)-(3.19) and the functions of cdpr_struct/generated/platform.py."""

from __future__ import annotations

from typing import Any

import sympy as sp

from cdpr_struct.derivations import platform
from cdpr_struct.derivations.platform import ARM, CENTRE, COORDINATES, FORCE, THETA, cross_matrix
from cdpr_struct.derivations.proof import require_same, tex, verdict
from cdpr_struct.derivations.records import FormulaRecord, GeneratedFunction
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

SOURCE = "derivations/platform.py, eqs (3.8)-(3.19)"
_T = sp.Symbol("t", real=True)


def closed_geometric_stiffness() -> Any:
    """(f.a) I - (f a^T + a f^T)/2."""
    return FORCE.dot(ARM) * sp.eye(3) - (FORCE * ARM.T + ARM * FORCE.T) / 2


def check_geometry() -> None:
    """Rotation is a rotation; the closed geometric stiffness is the Hessian; a pendulum has m g h."""
    for axis, angle in enumerate((rx, ry, rz)):
        R = platform.rotation_about(axis, angle)
        require_same("R^T R = I, so of the product too", (R.T * R).applyfunc(sp.trigsimp), sp.eye(3))
        require_same("det R = 1, so of the product too", sp.trigsimp(R.det()), 1)
    require_same("geometric stiffness", platform.geometric_stiffness(), closed_geometric_stiffness())
    require_same("A = [I, -[a]x]", platform.attachment(), sp.eye(3).row_join(-cross_matrix(ARM)))
    h, weight = sp.symbols("h weight", positive=True)
    hanging = {ax: 0, ay: 0, az: -h, fx: 0, fy: 0, fz: -weight}
    pendulum = platform.geometric_stiffness().subs(hanging)
    require_same("a hanging pendulum is pushed back by m g h", pendulum, sp.diag(weight * h, weight * h, 0))


def tangent_stiffness() -> tuple[Any, Any]:
    """A^T K A alone, and the Hessian of the second-order potential of one cable (stiffness K, force f)."""
    K = sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"k_{min(i, j)}{max(i, j)}", real=True))
    moved = platform.DELTA + platform.finite_rotation_second_order(THETA, ARM) - ARM
    potential = -FORCE.dot(moved) + (moved.T * K * moved)[0] / 2
    hessian = sp.hessian(potential, list(COORDINATES)).subs(dict.fromkeys(COORDINATES, 0))
    A = platform.attachment()
    derived = A.T * K * A + sp.diag(sp.zeros(3), closed_geometric_stiffness())
    require_same("tangent stiffness", hessian.applyfunc(sp.expand), derived.applyfunc(sp.expand))
    return A.T * K * A, derived


def assembly() -> FormulaRecord:
    """Eq. (3.8): the print lacks the geometric term."""
    printed, derived = tangent_stiffness()
    status = "verified" if sp.expand(printed - derived) == sp.zeros(6) else "corrected"
    note = (
        "The second-order expansion of the finite rotation in the potential -f.exp(theta)a of the "
        "static cable "
        "force f on the platform adds G_i = (f.a) I - (f a^T + a f^T)/2 on the rotations. The "
        "weight at an offset "
        "centre of mass adds the same term with f = m g and a = c. Check: a pendulum hanging by h "
        "gets + m g h "
        "about both horizontal axes."
    )
    without = r"K_E = \sum_i A_i^T K_i A_i"
    term = r" + \begin{bmatrix}0&0\\0&G_i\end{bmatrix},\quad G = "
    complete = without + term + tex(closed_geometric_stiffness())
    return FormulaRecord("platform.assembly", "3.8", status, note, without, complete)


def attachment() -> FormulaRecord:
    """Eq. (3.9): the print has the transposed cross matrix."""
    note = (
        "The linear part of delta + exp(theta) a - a is delta + theta x a. The print is delta + a x theta, a "
        "rotation counted the other way round: eigenfrequencies stay (a change of sign of three "
        "coordinates), "
        "moments and phases of rotations do not."
    )
    return verdict("platform.attachment", "3.9", platform.attachment_printed(), platform.attachment(), note, left="A")


def frame_change() -> FormulaRecord:
    """Eq. (3.10): six coordinates need the rotation twice on the diagonal."""
    R = sp.MatrixSymbol("R", 3, 3)
    Q = sp.diag(platform.rotation(), platform.rotation())
    local = sp.Matrix(sp.symbols("u0:6", real=True))
    world = Q * local
    halves = sp.Matrix([*(platform.rotation() * local[:3, :]), *(platform.rotation() * local[3:, :])])
    require_same("both halves of q rotate alike", world, halves)
    derived = r"^eK_E = Q^T\, {}^GK_E\, Q,\quad Q = \begin{bmatrix}R&0\\0&R\end{bmatrix}"
    note = (
        "A 3x3 rotation cannot multiply a 6x6 matrix: translations and rotations of q are rotated "
        "separately, "
        "Q = blockdiag(R, R)."
    )
    conformable = R.shape[0] == len(COORDINATES)
    return FormulaRecord(
        "platform.frame_change",
        "3.10",
        "verified" if conformable else "corrected",
        note,
        r"^eK_E = {}^GT_e^{-1}\, {}^GK_E\, {}^GT_e",
        derived,
    )


def _generic_symmetric(name: str) -> Any:
    return sp.Matrix(6, 6, lambda i, j: sp.Symbol(f"{name}_{min(i, j)}{max(i, j)}", real=True))


def lagrange() -> tuple[FormulaRecord, ...]:
    """Eqs (3.12)-(3.19) by differentiating T and V of a generic symmetric M and K."""
    q = sp.Matrix([sp.Function(f"q_{i}")(_T) for i in range(6)])
    rate = q.diff(_T)
    M, K = _generic_symmetric("m"), _generic_symmetric("k")
    kinetic, potential = (rate.T * M * rate)[0] / 2, (q.T * K * q)[0] / 2
    momentum = sp.Matrix([kinetic.diff(v) for v in rate])
    force = sp.Matrix([potential.diff(v) for v in q])
    equation = momentum.diff(_T) - sp.Matrix([kinetic.diff(v) for v in q]) + force
    closed = M * q.diff(_T, 2) + K * q
    note_q = "The derivative of V = q^T K q/2 is K q; the print has q dot in all three places."
    same_force = sp.expand(K * rate - force) == sp.zeros(6, 1)
    require_same("dV/dq", force, K * q)
    momentum_ok = sp.expand(momentum - M * rate) == sp.zeros(6, 1)
    equation_ok = sp.expand(equation - closed) == sp.zeros(6, 1)
    momenta, motion = r"\partial T/\partial\dot q_i = m_i^T\dot q", r"M\ddot q + K_E q = w"
    row = r"\partial V/\partial q_i = {}^eK_{Ei}^T\,"
    return (
        FormulaRecord("platform.momentum", "3.15-3.17", _status(momentum_ok), "", momenta, momenta),
        FormulaRecord("platform.restoring_force", "3.18", _status(same_force), note_q, row + r"\dot q", row + "q"),
        FormulaRecord("platform.equation_of_motion", "3.11, 3.19", _status(equation_ok), "", motion, motion),
    )


def _status(agrees: bool) -> str:
    return "verified" if agrees else "corrected"


def closed_mass_matrix() -> Any:
    """Parallel-axis form [[m I, -m [c]x], [m [c]x, I_c - m [c]x [c]x]]."""
    C = cross_matrix(CENTRE)
    top = (mass * sp.eye(3)).row_join(-mass * C)
    return top.col_join((mass * C).row_join(platform.INERTIA - mass * C * C)).applyfunc(sp.expand)


def mass_matrix() -> FormulaRecord:
    """Eq. (3.12): the mass matrix for an offset centre of mass."""
    note = "The thesis prints the symbol only; shown is the parallel-axis form about the reference point."
    return verdict("platform.mass_matrix", "3.12", closed_mass_matrix(), platform.mass_matrix(), note, left="M")


def formulas() -> tuple[FormulaRecord, ...]:
    """Eqs (3.8)-(3.19) against the derivation."""
    check_geometry()
    return (assembly(), attachment(), frame_change(), mass_matrix(), *lagrange())


def functions() -> tuple[GeneratedFunction, ...]:
    """What cdpr_struct/generated/platform.py holds."""
    arm, force, centre = (ax, ay, az), (fx, fy, fz), (cx, cy, cz)
    inertia = (ixx, iyy, izz, ixy, ixz, iyz)
    return (
        _matrix_function("rotation", (rx, ry, rz), platform.rotation(), _rotation_by_columns()),
        _matrix_function("attachment", arm, platform.attachment(), _identity_and(-cross_matrix(ARM))),
        _matrix_function("attachment_printed", arm, platform.attachment_printed(), _identity_and(cross_matrix(ARM))),
        _matrix_function(
            "geometric_stiffness",
            (*force, *arm),
            platform.geometric_stiffness(),
            closed_geometric_stiffness(),
        ),
        _matrix_function("mass_matrix", (mass, *centre, *inertia), platform.mass_matrix(), closed_mass_matrix()),
    )


def _identity_and(block: Any) -> Any:
    return sp.eye(3).row_join(block)


def _matrix_function(name: str, arguments: tuple[Any, ...], matrix: Any, reference: Any) -> GeneratedFunction:
    return GeneratedFunction(name, arguments, tuple(matrix), tuple(reference), tuple(matrix.shape))


def _rotation_by_columns() -> Any:
    """The same rotation, by turning the unit vectors one axis after the other."""

    def turn(v: Any, axis: int, angle: Any) -> Any:
        unit = sp.Matrix([1 if i == axis else 0 for i in range(3)])
        return v * sp.cos(angle) + unit.cross(v) * sp.sin(angle) + unit * unit.dot(v) * (1 - sp.cos(angle))

    columns = [turn(turn(turn(sp.eye(3)[:, i], 0, rx), 1, ry), 2, rz) for i in range(3)]
    return sp.Matrix.hstack(*columns)
