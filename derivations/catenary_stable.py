"""The catenary formulas rewritten so that no two nearly equal numbers are subtracted.

With V1 = force_z, V0 = V1 - weight*length, T = sqrt(force_x^2 + V^2), the whole cable is described by

    delta = (1/w) [asinh(V1/fx) - asinh(V0/fx)] = 2 L/(T0 + T1) * atanh(q)/q,   q = w L/(T0 + T1),

which is finite for w -> 0 and needs 1 - q without subtraction (`complement`). That each formula below
equals the raw closed form is proved in catenary.py and cable_compliance.py, which evaluate them once more
in the exponential parameters of `exponential_state`, where everything is rational.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from cdpr_struct.derivations.special_functions import atanhc, atanhc_remainder, tanh_remainder, tanhc
from cdpr_struct.derivations.symbols import axial_stiffness, force_x, force_z, length, weight


@dataclass(frozen=True, slots=True)
class Segment:
    """A piece of hanging cable between two points, lower index 0, upper index 1.

    fx, w, L, EA       : horizontal force [N], weight [N/m], unstrained length [m], axial stiffness [N]
    V0, V1, T0, T1     : vertical force and tension at both ends [N]
    q, p               : w L/(T0 + T1) and 1 - q
    """

    fx: Any
    w: Any
    L: Any
    EA: Any
    V0: Any
    V1: Any
    T0: Any
    T1: Any
    q: Any
    p: Any

    @property
    def S(self) -> Any:
        return self.T0 + self.T1

    @property
    def delta(self) -> Any:
        """x/fx without the elastic part [m/N]."""
        return 2 * self.L / self.S * atanhc(self.q, self.p)


def complement(fx: Any, Va: Any, Vb: Any, Ta: Any, Tb: Any) -> Any:
    """1 - w L/(Ta + Tb) for the piece between Va and Vb, as a sum of positive terms (both signs of Va Vb)."""
    overlap = 2 * sp.Max(0, sp.Min(Va, Vb), -sp.Max(Va, Vb))
    return (fx**2 / (Ta + sp.Abs(Va)) + fx**2 / (Tb + sp.Abs(Vb)) + overlap) / (Ta + Tb)


def segment(fx: Any, w: Any, L: Any, EA: Any, V0: Any, V1: Any) -> Segment:
    """A piece of cable in forces."""
    T0, T1 = sp.sqrt(fx**2 + V0**2), sp.sqrt(fx**2 + V1**2)
    return Segment(fx, w, L, EA, V0, V1, T0, T1, w * L / (T0 + T1), complement(fx, V0, V1, T0, T1))


def whole_cable() -> Segment:
    """The cable from B to C in the arguments of the generated functions."""
    return segment(force_x, weight, length, axial_stiffness, force_z - weight * length, force_z)


def end_point(c: Segment) -> tuple[Any, Any]:
    """x, z of the upper end from the lower one [m]."""
    x = c.fx * (c.L / c.EA + c.delta)
    z = c.L * (c.V0 + c.V1) * (1 / (2 * c.EA) + 1 / c.S)
    return x, z


def elongation(c: Segment) -> Any:
    """Strained minus unstrained length [m]."""
    bracket = (c.V0 + c.V1) ** 2 / c.S + c.S
    return c.L / (4 * c.EA) * bracket + c.fx**2 * c.delta / (2 * c.EA)


def chord_tension(c: Segment) -> Any:
    """Tension where the cable is parallel to its chord [N]."""
    x, z = end_point(c)
    return sp.sqrt(x**2 + z**2) / (c.L / c.EA + c.delta)


def distance_to_parallel_point(c: Segment, mean_force: Any) -> Any:
    """Unstrained distance from B to the point Q parallel to the chord, for mean_force = (V0 + V1)/2 [m]."""
    ratio = 2 * c.L / c.S * c.q * c.L / c.S * atanhc_remainder(c.q, c.p)
    return c.L / 2 - mean_force * ratio / (c.L / c.EA + c.delta)


def chord_parallel_coordinate(c: Segment) -> Any:
    """s_Q [m]."""
    return distance_to_parallel_point(c, (c.V0 + c.V1) / 2)


def sag_of_side(fx: Any, w: Any, EA: Any, side: Any, tau: Any, Tend: Any, VQ: Any, p: Any) -> Any:
    """Distance of Q from the chord, from the piece of unstrained length `side` between one end and Q [m].

    VQ >= 0 is the vertical force at Q counted so that the tension falls towards that end.
    """
    q = w * side / (Tend + tau)
    bracket = w * side / (2 * EA) + (w * side + 2 * VQ * q**2 * atanhc_remainder(q, p)) / (Tend + tau)
    return sp.Abs(fx) / tau * side * bracket


def sag(c: Segment) -> Any:
    """Sag perpendicular to the chord [m], from the end with the lower tension."""
    upward = c.V0 + c.V1 >= 0
    Vend = sp.Piecewise((c.V0, upward), (-c.V1, True))
    Tend = sp.sqrt(c.fx**2 + Vend**2)
    tau = chord_tension(c)
    VQ = sp.Abs(end_point(c)[1]) / (c.L / c.EA + c.delta)
    side = distance_to_parallel_point(c, sp.Abs(c.V0 + c.V1) / 2)
    return sag_of_side(c.fx, c.w, c.EA, side, tau, Tend, VQ, complement(c.fx, Vend, VQ, Tend, tau))


def sag_compliance(c: Segment) -> tuple[Any, Any, Any]:
    """c_xx, c_xz, c_zz of the sag alone [m/N], free of cancellation for any sign of V0 V1."""
    D, product = c.w * c.delta, c.T0 * c.T1
    xx = c.delta * (D**2 * tanh_remainder(D) + tanhc(D) * c.V0 * c.V1 / product)
    xz = -c.fx * c.L * (c.V0 + c.V1) / (c.S * product)
    return xx, xz, c.L / product * transverse_factor(c)


def transverse_factor(c: Segment) -> Any:
    """c_zz T0 T1/L: (fx^2 + T0 T1 - V0 V1)/(T0 + T1), written for either sign of V0 V1."""
    positive_sum = c.T0 * c.T1 + c.fx**2 + sp.Abs(c.V0 * c.V1)
    return sp.Piecewise((c.fx**2 * c.S / positive_sum, c.V0 * c.V1 > 0), (positive_sum / c.S, True))


def sag_determinant(c: Segment) -> Any:
    """c_xx c_zz - c_xz^2 of the sag alone as one product of positive terms [m^2/N^2]."""
    D = c.w * c.delta
    return sag_compliance(c)[2] * c.delta * D**2 * tanh_remainder(D / 2) / 4


def stiffness(c: Segment) -> tuple[Any, Any, Any]:
    """k_xx, k_xz, k_zz [N/m]: inverse of axial plus sag compliance."""
    axial = c.L / c.EA
    xx, xz, zz = sag_compliance(c)
    determinant = axial**2 + axial * (xx + zz) + sag_determinant(c)
    return (axial + zz) / determinant, -xz / determinant, (axial + xx) / determinant
