"""Generated functions against the raw printed or derived closed forms in mpmath, limits included.

The bound is 1e-12 relative, plus what one rounding of the inputs does to the exact value (its condition number
times 8 units of rounding): a number that the inputs themselves do not determine cannot be met by any formula.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from cdpr_struct.generated import cable_compliance, cable_dsm, catenary, special_functions

TOLERANCE = 1e-12
ROUNDING = 2.0**-53
DIGITS = 260
TINY = mp.mpf(10) ** -60
Values = dict[str, Any]


def _raw_cable(force_x: Any, force_z: Any, length: Any, stiffness: Any, weight: Any) -> Values:
    """Eqs (2.9)-(2.29), as printed except for the inverse (2.29)."""
    f, v, w = (x or TINY for x in (force_x, force_z, weight))
    v0 = v - w * length
    t0, t1, size = mp.hypot(f, v0), mp.hypot(f, v), abs(f)

    def profile(s: Any) -> tuple[Any, Any]:
        here = v - w * (length - s)
        x = f * s / stiffness + size / w * (mp.asinh(here / f) - mp.asinh(v0 / f))
        z = v * s / stiffness + w / stiffness * (s**2 / 2 - length * s) + (mp.hypot(f, here) - t0) / w
        return x, z

    x, z = profile(length)
    chord = mp.hypot(x, z)
    s_q = (f * z - v * x) / (w * x) + length
    x_q, z_q = profile(s_q)
    rise = mp.asinh(v / size) - mp.asinh(v0 / size)
    axial, xz, zz = length / stiffness, (f / t1 - f / t0) / w, (v / t1 - v0 / t0) / w
    xx = (rise - v / t1 + v0 / t0) / w
    det = (axial + xx) * (axial + zz) - xz**2
    return {
        "x": x, "z": z, "x_half": profile(length / 2)[0], "z_half": profile(length / 2)[1],
        "elongation": (v * t1 - v0 * t0 + f**2 * rise) / (2 * w * stiffness),
        "tau": f * chord / x, "s_q": s_q, "sag": abs(z * x_q - x * z_q) / chord,
        "axial": axial, "xx": xx, "xz": xz, "zz": zz,
        "k_xx": (axial + zz) / det, "k_xz": -xz / det, "k_zz": (axial + xx) / det,
    }  # fmt: skip


def _generated_cable(*arguments: np.ndarray) -> Values:
    names = ("x", "z", "x_half", "z_half", "elongation", "tau", "s_q", "sag", "axial", "xx", "xz", "zz")
    values = (
        *catenary.end_point(*arguments),
        *catenary.profile(arguments[2] / 2, *arguments),
        catenary.elongation(*arguments),
        catenary.chord_tension(*arguments),
        catenary.chord_parallel_coordinate(*arguments),
        catenary.sag(*arguments),
        *cable_compliance.compliance(*arguments),
        *cable_compliance.stiffness(*arguments),
    )
    return dict(zip((*names, "k_xx", "k_xz", "k_zz"), values, strict=True))


def _raw_dsm(omega2: Any, chord: Any, tau: Any, stiffness: Any, effective: Any, mu: Any, w: Any) -> Values:
    """Eqs (2.32)-(2.35) with kappa, k_xz with its corrected sign."""
    omega2, w = omega2 or TINY, w or TINY
    big = mp.sqrt(omega2 * mu / tau) * chord
    kappa, eps = mp.tan(big / 2) / (big / 2), w * chord / tau
    lam = eps**2 * stiffness * chord / (tau * effective)
    axial, bracket = stiffness / effective, 1 + lam / big**2 * (kappa - 1)
    second = eps**2 / lam * big**2 / 4 * (kappa + lam / big**2 * (kappa - 1)) / bracket
    return {
        "k_xx": axial / bracket,
        "k_xz": -axial * eps / 2 * (kappa - 1) / bracket,
        "k_yy": tau * (4 - kappa**2 * big**2) / (4 * kappa * chord),
        "k_zz": axial * eps**2 / lam / kappa - axial * second,
    }


def _generated_dsm(*arguments: np.ndarray) -> Values:
    return dict(zip(("k_xx", "k_xz", "k_yy", "k_zz"), cable_dsm.dynamic_stiffness(*arguments), strict=True))


def _condition(raw: Callable[..., Values], exact: Values, point: list[Any]) -> Values:
    """Sum over the inputs of |change of the value for a relative change of one input|, per unit."""
    step = mp.mpf(10) ** -30
    total = dict.fromkeys(exact, mp.mpf(0))
    for i, value in enumerate(point):
        moved = raw(*[value * (1 + step) if i == j else other for j, other in enumerate(point)])
        for name in exact:
            total[name] += abs(moved[name] - exact[name]) / step
    return total


def _excess(actual: Values, raw: Callable[..., Values], columns: list[np.ndarray]) -> Iterator[tuple[float, str]]:
    """Relative error beyond the conditioning, one per value and point."""
    with mp.workdps(DIGITS):
        for n in range(len(columns[0])):
            point = [mp.mpmathify(complex(c[n]) if np.iscomplexobj(c) else float(c[n])) for c in columns]
            exact = raw(*point)
            condition = _condition(raw, exact, point)
            for name, value in exact.items():
                error = abs(mp.mpmathify(actual[name][n]) - value) - 8 * ROUNDING * condition[name]
                yield float(max(0, error - TINY**0.5) / (abs(value) or 1)), f"{name} at {point}"


def _worst(actual: Values, raw: Callable[..., Values], columns: list[np.ndarray]) -> tuple[float, str]:
    assert all(np.all(np.isfinite(value)) for value in actual.values())
    return max(_excess(actual, raw, columns))


def _log(rng: np.random.Generator, low: float, high: float, size: int) -> np.ndarray:
    return 10.0 ** rng.uniform(low, high, size)


def cables(kind: str, size: int = 60) -> list[np.ndarray]:
    """force_x, force_z, length, axial_stiffness, weight of one kind of cable."""
    rng = np.random.default_rng(len(kind))
    signs = rng.choice([-1.0, 1.0], (2, size))
    length, stiffness, weight = _log(rng, -1, 2.5, size), _log(rng, 3, 7, size), _log(rng, -3, 2, size)
    force_x, force_z = signs[0] * _log(rng, -2, 4, size), signs[1] * _log(rng, -2, 4, size)
    if kind == "weightless":
        weight = np.zeros(size)
    elif kind == "nearly weightless":
        weight = _log(rng, -18, -8, size)
    elif kind == "vertical":
        force_x = np.zeros(size)
        force_z = np.where(signs[1] > 0, weight * length * (1 + _log(rng, -1, 2, size)), force_z)
    elif kind == "nearly vertical":
        force_x = signs[0] * _log(rng, -12, -6, size)
    elif kind == "lowest point inside":
        force_z = weight * length * rng.uniform(0.05, 0.95, size)
    elif kind == "vertical and weightless":
        force_x, weight = np.zeros(size), np.zeros(size)
    return [force_x, force_z, length, stiffness, weight]


KINDS = (
    "general",
    "weightless",
    "nearly weightless",
    "vertical",
    "nearly vertical",
    "lowest point inside",
    "vertical and weightless",
)


@pytest.mark.parametrize("kind", KINDS)
def test_cable_statics_match_the_raw_forms(kind: str) -> None:
    columns = cables(kind)
    worst, where = _worst(_generated_cable(*columns), _raw_cable, columns)
    assert worst < TOLERANCE, where


@pytest.mark.parametrize("kind", ["general", "omega 0", "low omega", "lambda 0", "taut", "both 0", "damped", "high"])
def test_dynamic_stiffness_matches_the_raw_forms(kind: str) -> None:
    rng, size = np.random.default_rng(len(kind)), 60
    omega2, chord, tau = _log(rng, -2, 4, size), _log(rng, -0.5, 2, size), _log(rng, 0, 4, size)
    stiffness, mu, weight = _log(rng, 3, 7, size), _log(rng, -2, 0, size), _log(rng, -2, 1, size)
    if kind in ("omega 0", "both 0"):
        omega2 = np.zeros(size)
    elif kind == "low omega":
        omega2 = _log(rng, -16, -4, size)
    elif kind == "damped":
        omega2 = omega2 * (1.0 - 0.2j * rng.uniform(size=size))
    elif kind == "high":
        omega2 = omega2 * 100.0
    if kind in ("lambda 0", "both 0"):
        weight = np.zeros(size)
    elif kind == "taut":
        weight = _log(rng, -14, -6, size)
    columns = [omega2, chord, tau, stiffness, chord * rng.uniform(1.0, 1.1, size), mu, weight]
    worst, where = _worst(_generated_dsm(*columns), _raw_dsm, columns)
    assert worst < TOLERANCE, where


def test_length_parameter_matches_its_integral() -> None:
    for ratio in (0.0, 1e-9, 1e-4, 0.06, 0.24, 1.0, 20.0):
        with mp.workdps(40):
            slope = mp.mpf(ratio)
            exact = mp.quad(lambda x, e=slope: (1 + (e * (x - mp.mpf(1) / 2)) ** 2) ** mp.mpf("1.5"), [0, 0.5, 1])
        assert cable_dsm.effective_length_integral(3.0, ratio) == pytest.approx(float(3 * exact), rel=TOLERANCE)
    second = cable_dsm.effective_length_approximation(3.0, 0.06)
    assert cable_dsm.effective_length_integral(3.0, 0.06) == pytest.approx(second, rel=0.06**4)


DEFINITIONS: dict[str, tuple[Callable[..., Any], bool]] = {
    "tanhc": (lambda u: mp.tanh(u) / u, False),
    "tanh_remainder": (lambda u: (u - mp.tanh(u)) / u**3, False),
    "asinhc": (lambda u: mp.asinh(u) / u, False),
    "atanhc": (lambda q: mp.atanh(q) / q, True),
    "atanhc_remainder": (lambda q: (mp.atanh(q) / q - 1) / q**2, True),
    "sinc_of_square": (lambda r: mp.sin(mp.sqrt(r)) / mp.sqrt(r), False),
    "sinc_cos_gap": (lambda r: (mp.sin(mp.sqrt(r)) / mp.sqrt(r) - mp.cos(mp.sqrt(r))) / r, False),
}


@pytest.mark.parametrize("name", DEFINITIONS)
def test_special_functions_match_their_definitions(name: str) -> None:
    """Through zero, through the switch from series to closed form, and up to the end of the range."""
    definition, bounded = DEFINITIONS[name]
    arguments = [0.0, 1e-200, 1e-12, 1e-5, 0.01, 0.3, 0.399999, 0.4, 0.499999, 0.5, 0.7, 0.9999999]
    arguments += [] if bounded else [0.999999999, 1.0, 2.0, 4.4]
    for u in arguments:
        rest = (1.0 - u,) if bounded else ()
        with mp.workdps(700):
            exact = float(mp.re(definition(mp.mpf(u) or mp.mpf(10) ** -200)))
        assert getattr(special_functions, name)(u, *rest) == pytest.approx(exact, rel=TOLERANCE), u


@pytest.mark.parametrize("square", [-30.0, -0.3, 0.2 + 0.1j, -4.0 + 3.0j])
def test_cosine_family_takes_negative_and_complex_squares(square: complex) -> None:
    root = mp.sqrt(mp.mpmathify(square))
    sinc, cosine = mp.sin(root) / root, mp.cos(root)
    for name, exact in (
        ("cos_of_square", cosine),
        ("sinc_of_square", sinc),
        ("sinc_cos_gap", (sinc - cosine) / mp.mpmathify(square)),
    ):
        value = getattr(special_functions, name)(square)
        assert complex(value) == pytest.approx(complex(exact), rel=1e-11), name
        assert np.iscomplexobj(value) == isinstance(square, complex)
