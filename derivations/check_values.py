"""Compares the numbers of generated modules with 50 digits of the raw derived closed forms at fixed points.

A limit (weight = 0, force_x = 0, omega = 0 ...) is reached in the raw form by a tiny positive number and
more digits: its 0/0 is then evaluated, not assumed.
"""

from __future__ import annotations

import importlib.util
import itertools
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from cdpr_struct.derivations.records import GeneratedFunction

RELATIVE_TOLERANCE = 1e-12
DIGITS = 320
TINY = mpmath.mpf(10) ** -60
POINTS: dict[str, tuple[float, ...]] = {
    "force_x": (100.0, -7.0, 0.5),
    "force_z": (-100.0, 3.0, 250.0),
    "s": (7.0, 0.5, 19.0),
    "length": (20.0, 9.0, 31.0),
    "axial_stiffness": (2.5e5, 4.0e6, 3.0e3),
    "weight": (0.65727, 2.46, 1.0e-6),
    "omega_c_squared": (900.0, 2.0, 3000.0),
    "omega": (30.0, 2.0, 55.0),
    "damping_ratio": (0.01, 0.2, 0.0),
    "reference_omega": (5.0, 9.0, 11.0),
    "chord": (20.0, 9.0, 31.0),
    "tension": (140.0, 2500.0, 60.0),
    "effective_length": (20.1, 9.0, 33.0),
    "linear_density": (0.067, 0.251, 0.12),
    "perpendicular_weight": (0.45, 2.0, 1.0),
    "epsilon": (0.06, 0.24, 1.0e-5),
    "lambda2": (6.4, 79.1, 1.0e-7),
    "frequency_parameter": (3.0, 0.01, 17.0),
}
OTHERWISE = (0.3, -1.7, 2.9)
LIMITS: dict[str, tuple[tuple[str, ...], ...]] = {
    "end_point": (("weight",), ("force_x",), ("weight", "force_x")),
    "profile": (("weight",), ("force_x",)),
    "elongation": (("weight",), ("force_x",)),
    "chord_tension": (("weight",), ("force_x",)),
    "chord_parallel_coordinate": (("weight",),),
    "sag": (("weight",),),
    "compliance": (("weight",),),
    "stiffness": (("weight",),),
    "dynamic_stiffness": (
        ("omega_c_squared",),
        ("perpendicular_weight",),
        ("omega_c_squared", "perpendicular_weight"),
    ),
    "effective_length_integral": (("epsilon",),),
    "clamped_frequency_function": (("frequency_parameter",), ("lambda2",)),
}


def load(path: Path) -> ModuleType:
    """Import a generated module from its file, past the import cache."""
    spec = importlib.util.spec_from_file_location(f"checked_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise ImportError(f"cannot import {path}")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def value_errors(functions: dict[str, tuple[GeneratedFunction, ...]], folder: Path) -> tuple[str, ...]:
    """One line per number that differs; empty when all agree."""
    errors: list[str] = []
    for name, items in functions.items():
        try:
            module = load(folder / f"{name}.py")
        except (OSError, ImportError, SyntaxError, NameError) as error:
            errors.append(f"{name}: not importable: {error}")
            continue
        for item in items:
            errors += _function_errors(name, item, module)
    return tuple(errors)


def _function_errors(sheet: str, item: GeneratedFunction, module: ModuleType) -> Iterator[str]:
    function = getattr(module, item.name, None)
    if function is None:
        yield f"{sheet}.{item.name}: missing"
        return
    exact = exact_function(item)
    for point in points(item):
        expected = exact(point)
        try:
            actual = np.ravel(np.asarray(function(**point), dtype=complex))
        except Exception as error:  # a damaged file may fail in any way; all of them are findings
            yield f"{sheet}.{item.name} at {point}: {type(error).__name__}: {error}"
            continue
        yield from _differences(f"{sheet}.{item.name} at {point}", actual, expected)


def _differences(where: str, actual: Any, expected: list[complex]) -> Iterator[str]:
    if len(actual) != len(expected):
        yield f"{where}: {len(actual)} numbers, expected {len(expected)}"
        return
    for position, (left, right) in enumerate(zip(actual, expected, strict=True)):
        if not abs(left - right) <= RELATIVE_TOLERANCE * abs(right) + 1e-50:
            yield f"{where}: output {position} is {left}, derivation {right}"


def exact_function(item: GeneratedFunction) -> Any:
    """The raw closed forms as a function of a point (name -> float), by mpmath, rounded to double."""
    evaluate = sp.lambdify(item.arguments, list(item.reference), modules="mpmath", cse=True)

    def exact(point: dict[str, float]) -> list[complex]:
        with mpmath.workdps(DIGITS):
            values = [mpmath.mpf(point[str(a)]) or TINY for a in item.arguments]
            return [complex(value) for value in evaluate(*values)]

    return exact


def points(item: GeneratedFunction) -> Iterator[dict[str, float]]:
    """Three general points, and each of them with the limits of this function."""
    names = [str(argument) for argument in item.arguments]
    generic = [
        {name: POINTS.get(name, OTHERWISE)[(k + shift) % 3] for shift, name in enumerate(names)} for k in range(3)
    ]
    yield from generic
    for zeros, point in itertools.product(LIMITS.get(item.name, ()), generic):
        limit = point | dict.fromkeys(zeros, 0.0)
        if "force_x" not in zeros or _stays_taut(limit):
            yield limit


def _stays_taut(point: dict[str, float]) -> bool:
    return point["force_z"] * (point["force_z"] - point["weight"] * point["length"]) > 0.0
