"""Prints cdpr_struct/generated/special_functions.py: evaluation without cancellation."""

from __future__ import annotations

from cdpr_struct.derivations.special_functions import SERIES, series_coefficients

_BODY = '''
def _series(coefficients: tuple[float, ...], square: Any) -> Any:
    """Horner sum of coefficients[k]*square**k."""
    total = coefficients[-1] * np.ones_like(square)
    for coefficient in coefficients[-2::-1]:
        total = total * square + coefficient
    return total


def atanhc(q: Any, complement: Any) -> Any:
    """atanh(q)/q for 0 <= q <= 1, with complement = 1 - q given to full relative precision [-].

    At q = 1 the value is infinite; the complement is floored, so the result stays finite there.
    """
    safe_q = np.where(q == 0.0, 1.0, q)
    return np.where(q == 0.0, 1.0, np.log1p(2.0 * safe_q / np.maximum(complement, _FLOOR)) / (2.0 * safe_q))


def atanhc_remainder(q: Any, complement: Any) -> Any:
    """(atanh(q)/q - 1)/q^2 for 0 <= q <= 1, with complement = 1 - q [-]."""
    small = q < ATANHC_REMAINDER_SMALL
    large_q = np.where(small, 1.0, q)
    series = _series(ATANHC_REMAINDER, np.where(small, q, 0.0) ** 2)
    return np.where(small, series, (atanhc(large_q, complement) - 1.0) / large_q**2)


def tanhc(u: Any) -> Any:
    """tanh(u)/u [-]."""
    safe_u = np.where(u == 0.0, 1.0, u)
    return np.where(u == 0.0, 1.0, np.tanh(safe_u) / safe_u)


def tanh_remainder(u: Any) -> Any:
    """(u - tanh u)/u^3 [-]."""
    small = np.abs(u) < TANH_REMAINDER_SMALL
    large_u = np.where(small, 1.0, u)
    series = _series(TANH_REMAINDER, np.where(small, u, 0.0) ** 2)
    return np.where(small, series, (large_u - np.tanh(large_u)) / large_u**3)


def asinhc(a: Any) -> Any:
    """asinh(a)/a [-]."""
    safe_a = np.where(a == 0.0, 1.0, a)
    return np.where(a == 0.0, 1.0, np.arcsinh(safe_a) / safe_a)


def cos_of_square(square: Any) -> Any:
    """cos(y) for y^2 = square; square may be complex, or real of either sign [-]."""
    if np.iscomplexobj(square):
        return np.cos(np.sqrt(square))
    positive, negative = np.sqrt(np.maximum(square, 0.0)), np.sqrt(np.maximum(-square, 0.0))
    return np.where(square >= 0.0, np.cos(positive), np.cosh(negative))


def sinc_of_square(square: Any) -> Any:
    """sin(y)/y for y^2 = square; square may be complex, or real of either sign [-]."""
    safe = np.where(square == 0.0, 1.0, square)
    if np.iscomplexobj(square):
        root = np.sqrt(safe)
        return np.where(square == 0.0, 1.0, np.sin(root) / root)
    root = np.sqrt(np.abs(safe))
    negative = np.where(safe < 0.0, root, 0.0)
    return np.where(square == 0.0, 1.0, np.where(safe > 0.0, np.sin(root), np.sinh(negative)) / root)


def sinc_cos_gap(square: Any) -> Any:
    """(sin(y)/y - cos(y))/y^2 for y^2 = square; square may be complex, or real of either sign [-]."""
    small = np.abs(square) < SINC_COS_GAP_SMALL
    large = np.where(small, 1.0, square)
    series = _series(SINC_COS_GAP, np.where(small, square, 0.0))
    return np.where(small, series, (sinc_of_square(large) - cos_of_square(large)) / large)
'''


def module_body() -> str:
    """Everything below the module docstring."""
    lines = ["from typing import Any", "", "import numpy as np", "", "_FLOOR = 1e-300"]
    for name, (_, _, _, threshold) in SERIES.items():
        lines.append(f"{name}_SMALL = {threshold!r}")
        lines.append(f"{name} = (")
        lines += [f"    {value!r}," for value in series_coefficients(name)]
        lines.append(")")
    return "\n".join(lines) + "\n\n" + _BODY
