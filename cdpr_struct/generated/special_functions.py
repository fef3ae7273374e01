"""GENERATED FILE - do not edit.

Regenerate : python -m cdpr_struct.derivations
Source     : derivations/special_functions.py, derivations/print_special_functions.py
Made with  : sympy 1.14.0
"""

from typing import Any

import numpy as np

_FLOOR = 1e-300
ATANHC_REMAINDER_SMALL = 0.4
ATANHC_REMAINDER = (
    0.3333333333333333,
    0.2,
    0.14285714285714285,
    0.1111111111111111,
    0.09090909090909091,
    0.07692307692307693,
    0.06666666666666667,
    0.058823529411764705,
    0.05263157894736842,
    0.047619047619047616,
    0.043478260869565216,
    0.04,
    0.037037037037037035,
    0.034482758620689655,
    0.03225806451612903,
    0.030303030303030304,
    0.02857142857142857,
    0.02702702702702703,
    0.02564102564102564,
    0.024390243902439025,
)
TANH_REMAINDER_SMALL = 0.5
TANH_REMAINDER = (
    0.3333333333333333,
    -0.13333333333333333,
    0.05396825396825397,
    -0.021869488536155203,
    0.008863235529902197,
    -0.003592128036572481,
    0.0014558343870513183,
    -0.000590027440945586,
    0.00023912911424355248,
    -9.691537956929451e-05,
    3.927832388331683e-05,
    -1.5918905069328964e-05,
    6.451689215655431e-06,
    -2.6147711512907546e-06,
    1.0597268320104654e-06,
    -4.294911078273806e-07,
)
SINC_COS_GAP_SMALL = 1.0
SINC_COS_GAP = (
    0.3333333333333333,
    -0.03333333333333333,
    0.0011904761904761906,
    -2.2045855379188714e-05,
    2.505210838544172e-07,
    -1.9270852604185937e-09,
    1.0706029224547743e-11,
    -4.498331606952833e-14,
    1.4797143443923793e-16,
    -3.9145882126782523e-19,
    8.509974375387505e-22,
)


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
