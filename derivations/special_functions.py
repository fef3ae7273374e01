"""Functions with a removable singularity, which the stable closed forms are made of.

Each is a sympy function that knows its definition; the numpy text in print_special_functions.py evaluates it
without cancellation. Series coefficients are derived here, never typed in.
"""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp


class SpecialFunction(sp.Function):
    """Unevaluated function with a closed-form definition."""

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        raise NotImplementedError


class atanhc(SpecialFunction):
    """atanh(q)/q; the second argument is 1 - q, handed in because q may be close to 1."""

    nargs = 2

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        q = arguments[0]
        return sp.atanh(q) / q


class atanhc_remainder(SpecialFunction):
    """(atanh(q)/q - 1)/q^2; the second argument is 1 - q."""

    nargs = 2

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        q = arguments[0]
        return (sp.atanh(q) / q - 1) / q**2


class tanhc(SpecialFunction):
    """tanh(u)/u."""

    nargs = 1

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        u = arguments[0]
        return sp.tanh(u) / u


class tanh_remainder(SpecialFunction):
    """(u - tanh u)/u^3."""

    nargs = 1

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        u = arguments[0]
        return (u - sp.tanh(u)) / u**3


class asinhc(SpecialFunction):
    """asinh(a)/a."""

    nargs = 1

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        a = arguments[0]
        return sp.asinh(a) / a


class cos_of_square(SpecialFunction):
    """cos(y) as a function of y^2."""

    nargs = 1

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        return sp.cos(sp.sqrt(arguments[0]))


class sinc_of_square(SpecialFunction):
    """sin(y)/y as a function of y^2."""

    nargs = 1

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        y = sp.sqrt(arguments[0])
        return sp.sin(y) / y


class sinc_cos_gap(SpecialFunction):
    """(sin(y)/y - cos(y))/y^2 as a function of y^2."""

    nargs = 1

    @staticmethod
    def definition(*arguments: sp.Expr) -> sp.Expr:
        y = sp.sqrt(arguments[0])
        return (sp.sin(y) / y - sp.cos(y)) / y**2


ALL = (atanhc, atanhc_remainder, tanhc, tanh_remainder, asinhc, cos_of_square, sinc_of_square, sinc_cos_gap)


def expand_definitions(expression: sp.Expr) -> sp.Expr:
    """Replace every special function by its definition."""
    for function in ALL:
        expression = expression.replace(function, function.definition)
    return expression


def tanh_coefficient(k: int) -> sp.Rational:
    """Coefficient of u^(2k-1) in tanh(u), from the Bernoulli numbers."""
    return 2 ** (2 * k) * (2 ** (2 * k) - 1) * sp.bernoulli(2 * k) / sp.factorial(2 * k)


def atanhc_remainder_coefficient(k: int) -> sp.Rational:
    """Coefficient of q^(2k): atanh(q) = sum q^(2k+1)/(2k+1), shifted by the first term."""
    return sp.Rational(1, 2 * k + 3)


def tanh_remainder_coefficient(k: int) -> sp.Rational:
    """Coefficient of u^(2k): minus the tanh series from its second term on."""
    return -tanh_coefficient(k + 2)


def sinc_cos_gap_coefficient(k: int) -> sp.Rational:
    """Coefficient of (y^2)^k in (sin(y)/y - cos(y))/y^2."""
    sign = sp.Integer(-1) ** (k + 1)
    return sign * (1 / sp.factorial(2 * k + 3) - 1 / sp.factorial(2 * k + 2))


SERIES: dict[str, tuple[type[SpecialFunction], Callable[[int], sp.Rational], int, float]] = {
    "ATANHC_REMAINDER": (atanhc_remainder, atanhc_remainder_coefficient, 20, 0.4),
    "TANH_REMAINDER": (tanh_remainder, tanh_remainder_coefficient, 16, 0.5),
    "SINC_COS_GAP": (sinc_cos_gap, sinc_cos_gap_coefficient, 11, 1.0),
}
"""Name of the table -> (function, coefficient, number of terms, argument below which the series is used)."""


def series_coefficients(name: str) -> list[float]:
    """Coefficients in ascending powers, rounded once to double."""
    _, coefficient, terms, _ = SERIES[name]
    return [float(coefficient(k)) for k in range(terms)]


def prove_series() -> None:
    """The first coefficients of every table equal the Taylor expansion of the definition."""
    u = sp.Symbol("u", positive=True)
    for function, coefficient, _, _ in SERIES.values():
        of_square = function is sinc_cos_gap
        arguments = (u**2, 1) if of_square else (u, 1)
        definition = function.definition(*arguments)
        expansion = sp.series(definition, u, 0, 6).removeO()
        for k in range(3):
            if sp.simplify(expansion.coeff(u, 2 * k) - coefficient(k)) != 0:
                raise ArithmeticError(f"series of {function.__name__}: coefficient {k} is not {coefficient(k)}")
