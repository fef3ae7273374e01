"""Cables between held ends that vibrate: taut strings, Irvine and Caughey's shallow cables, a vertical chain."""

from functools import cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import jv, yv

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.clamped_frequencies import MESHES, catenary_frequencies, pulled_cable
from cdpr_struct.generated import catenary
from cdpr_struct.statics.cable_state import CableStates
from tests.published.case import Case


def bars_in_hertz(cable: CableStates, density: float, gravity: float, count: int) -> np.ndarray:
    """Frequencies (count,) [Hz] of both planes together, of bars, extrapolated to infinitely many."""
    data = fem.CableData(float(cable.length[0]), float(cable.axial_stiffness[0]), density)
    held = [fem.solve_cable(data, np.zeros(3), cable.offset[0], n, (0.0, 0.0, -gravity)) for n in MESHES]
    return np.asarray(
        fem.extrapolate(MESHES, np.array([fem.cable_modes(each, count).frequencies_hz for each in held])).limit
    )


def string(tension: float, chord: float, density: float, stiffness: float) -> tuple[CableStates, float]:
    """A weightless string stretched to `chord` [m], `density` a stretched metre; and its mass an unstrained metre."""
    stretch = 1.0 + tension / stiffness
    return pulled_cable((tension, 0.0), (chord, 0.0), chord / stretch, stiffness, 0.0), density * stretch


def string_case(title: str, source: str, number: int, told: float, digits: float, *given: float) -> Case:
    """Frequency `number` of a string (tension, chord, density, axial stiffness), across one of its two planes."""
    cable, density = string(*given)
    return Case(
        title, source, f"frequency {number}", "Hz", told, digits, "digits printed",
        lambda: catenary_frequencies(cable, density, number)["out_of_plane"][-1],
        lambda: float(bars_in_hertz(cable, density, 0.0, 2 * number)[-1]),
    )  # fmt: skip


POUND, INCH = 4.4482216152605, 0.0254
VM53_DENSITY = 0.00073 * 0.00306796 * POUND / INCH**2  # lb s^2/in^4 times in^2, in kg/m
VM53 = (500.0 * POUND, 100.0 * INCH, VM53_DENSITY, 30e6 * 0.00306796 * POUND)
SDNL = (1.0, 7800.0 * 5.026e-5, 2.1e11 * 5.026e-5)

UNIT = "pi sqrt(T/mu)/L"
SHALLOW = 0.01
"""w L / T of the cables that stand for parabolas: smaller, and the FEM needs more bars for the same digits."""


@cache
def shallow_cable(lambda2: float) -> tuple[CableStates, float]:
    """A level cable with this lambda^2 (2.37) and hardly any sag, of 1 N/m, and its horizontal tension [N]."""
    tension = 1.0 / SHALLOW  # of a chord of 1 m and a weight of 1 N/m
    effective = 1.0 + SHALLOW**2 / 8.0
    stiffness = lambda2 * tension * effective / SHALLOW**2
    length = brentq(
        lambda x: float(catenary.end_point(tension, 0.5 * x, x, stiffness, 1.0)[0]) - 1.0, 0.5, 1.5, xtol=1e-15
    )
    return pulled_cable((tension, 0.5 * length), (1.0, 0.0), length, stiffness, 1.0), tension


def in_string_units(hertz: float, tension: float) -> float:
    """Frequency as omega L sqrt(mu / T) / pi, of the shallow cable, whose mu is 1 kg/m and gravity 1 m/s^2."""
    return float(2.0 * hertz / np.sqrt(tension))


def first_symmetric(lambda2: float) -> float:
    """First symmetric frequency in the plane by the exact catenary; antisymmetric ones lie at 2, 4, 6 ..."""
    cable, tension = shallow_cable(lambda2)
    in_plane = [in_string_units(hertz, tension) for hertz in catenary_frequencies(cable, 1.0, 4)["in_plane"]]
    return next(each for each in in_plane if abs(each - 2.0) > 1e-3)


def first_symmetric_of_bars(lambda2: float) -> float:
    """The same by the finite elements, whose strings across the plane lie at 1, 2, 3 ..."""
    cable, tension = shallow_cable(lambda2)
    both = [in_string_units(hertz, tension) for hertz in bars_in_hertz(cable, 1.0, 1.0, 8)]
    return next(each for each in both if abs(each - round(each)) > 1e-3)


def irvine_case(lambda2: float, told: float) -> Case:
    """First symmetric in-plane frequency at one lambda^2."""
    return Case(
        f"shallow cable with lambda^2 = {lambda2:g}", "Irvine and Caughey 1974", "first symmetric frequency", UNIT,
        told, 2e-4, "wL/T = 0.01 against a parabola, four digits printed",
        lambda: first_symmetric(lambda2), lambda: first_symmetric_of_bars(lambda2),
    )  # fmt: skip


# A vertical chain held at both ends, the lower end pulled with the weight of half of it.
CHAIN, PULL, GRAVITY = 10.0, 0.5, 9.81


def chain_frequency(number: int) -> float:
    """Frequency [Hz] of a chain without stretch: J0(a) Y0(b) = J0(b) Y0(a), a and b from the tensions at its ends."""
    low, high = PULL * CHAIN, (1.0 + PULL) * CHAIN

    def crossed(hertz: float) -> float:
        a, b = (4.0 * np.pi * hertz * np.sqrt(s / GRAVITY) for s in (low, high))
        return float(jv(0, a) * yv(0, b) - jv(0, b) * yv(0, a))

    grid = np.linspace(1e-3, 4.0, 4001)
    values = np.array([crossed(f) for f in grid])
    at = np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1]))[number - 1]
    return float(brentq(crossed, grid[at], grid[at + 1], xtol=1e-15))


def chain_case(number: int) -> Case:
    """Frequency `number` of the chain across."""
    stiffness, weight = 1e9, 2.0 * GRAVITY
    top = (1.0 + PULL) * CHAIN * weight
    end = float(catenary.end_point(1e-9, top, CHAIN, stiffness, weight)[1])
    cable = pulled_cable((1e-9, top), (1e-12, end), CHAIN, stiffness, weight)
    return Case(
        "vertical chain held at both ends", "Bessel functions", f"frequency {number}", "Hz", chain_frequency(number),
        1e-6, "EA of 1e9 N against no stretch",
        lambda: catenary_frequencies(cable, 2.0, number)["out_of_plane"][-1],
        lambda: float(bars_in_hertz(cable, 2.0, GRAVITY, 2 * number)[-1]),
    )  # fmt: skip


def in_plane_case(lambda2: float, number: int, of_both: int, told: float, quantity: str, because: str) -> Case:
    """In-plane frequency `number` of a shallow cable; it is `of_both` among those of both planes."""
    cable, tension = shallow_cable(lambda2)
    title = (
        "cable that does not stretch" if lambda2 > 1e6 else f"shallow cable with lambda^2 = {lambda2 / np.pi**2:g} pi^2"
    )
    return Case(
        title, "Irvine and Caughey 1974", quantity, UNIT, told, 1e-3 if lambda2 > 1e6 else 1e-4, because,
        lambda: in_string_units(catenary_frequencies(cable, 1.0, number)["in_plane"][-1], tension),
        lambda: in_string_units(float(bars_in_hertz(cable, 1.0, 1.0, of_both)[-1]), tension),
    )  # fmt: skip


CASES = (
    *(
        string_case("string in tension", "ANSYS VM53", n, told, 4e-5, *VM53)
        for n, told in ((1, 74.708), (2, 149.42), (3, 224.12))
    ),
    string_case("cable of a frame, 10th step", "Code_Aster SDNL138", 1, 62.73227096292042, 1e-9, 6171.050459855, *SDNL),
    string_case("cable of a frame, 20th step", "Code_Aster SDNL138", 1, 88.72830898253936, 1e-9, 12345.2954376, *SDNL),
    *(irvine_case(lambda2, told) for lambda2, told in ((4.0, 1.1518), (20.0, 1.6095), (60.0, 2.2910), (200.0, 2.7744))),
    in_plane_case(4.0 * np.pi**2, 2, 4, 2.0, "frequency 2, at the first crossover", "wL/T = 0.01 against a parabola"),
    in_plane_case(16.0 * np.pi**2, 4, 8, 4.0, "frequency 4, at the second crossover", "wL/T = 0.01 against a parabola"),
    in_plane_case(1e9, 2, 4, 2.86, "symmetric frequency 1", "three digits printed"),
    in_plane_case(1e9, 4, 8, 4.92, "symmetric frequency 2", "three digits printed"),
    in_plane_case(1e9, 6, 12, 6.94, "symmetric frequency 3", "three digits printed"),
    *(chain_case(number) for number in (1, 2, 3)),
)
