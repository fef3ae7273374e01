"""Profile and dynamic stiffness of one cable (thesis figs 2.4, 2.5)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cdpr_struct.generated import cable_dsm, catenary
from cdpr_struct.reports.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, VERMILLION, plain_ticks, quiet

PROFILE_SIZE = (9.6, 5.4)
TRACE_SIZE = (9.6, 4.3)
DAMPING_RATIO = 0.01
_PROFILE_POINTS = 201
_FREQUENCIES = 3000


@dataclass(frozen=True, slots=True, eq=False)
class CableProfile:
    """The hanging cable from B (frame end, at the origin) to C (free end), arrays (p,) [m].

    s            : unstrained coordinate;  x, z : place, z up
    along, below : coordinate on the chord, distance from it on the side on which the cable hangs
    """

    s: np.ndarray
    x: np.ndarray
    z: np.ndarray
    along: np.ndarray
    below: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class StiffnessTrace:
    """k_xx + k_zz of the cable at C, which no rotation in the cable's plane changes [N/m].

    hertz, dynamic : (f,);  static : number;  |dynamic| is damped
    """

    hertz: np.ndarray
    dynamic: np.ndarray
    static: float


def cable_profile(result: Mapping[str, Any]) -> CableProfile:
    """Profile of the cable that `describe_cable` described."""
    given = result["input"]
    force_x, force_z = given["force_N"]
    weight = given["linear_density_kg_m"] * given["gravity_m_s2"]
    s = np.linspace(0.0, given["length_m"], _PROFILE_POINTS)
    x, z = catenary.profile(s, force_x, force_z, given["length_m"], given["axial_stiffness_N"], weight)
    cos, sin = result["x_m"] / result["chord_m"], result["z_m"] / result["chord_m"]
    below = (x * sin - z * cos) * np.sign(cos)
    return CableProfile(s, x, z, x * cos + z * sin, below)


def stiffness_trace(result: Mapping[str, Any]) -> StiffnessTrace:
    """Trace of the closed-form dynamic stiffness over frequency, up to beyond the sixth in-plane frequency."""
    given, chord, tau = result["input"], result["chord_m"], result["tau_N"]
    density, ea = given["linear_density_kg_m"], given["axial_stiffness_N"]
    across = density * given["gravity_m_s2"] * abs(result["x_m"]) / chord
    hertz = np.linspace(0.0, 1.1 * result["frequencies_hz"]["in_plane"][-1], _FREQUENCIES)
    reference = np.pi * np.sqrt(tau / density) / chord
    squared = cable_dsm.damped_omega_squared(2.0 * np.pi * hertz, DAMPING_RATIO, reference)
    effective = cable_dsm.effective_length_integral(chord, result["epsilon"])
    k_xx, _, _, k_zz = cable_dsm.dynamic_stiffness(squared, chord, tau, ea, effective, density, across)
    (static_xx, _), (_, static_zz) = result["stiffness"]
    return StiffnessTrace(hertz, np.abs(k_xx + k_zz), static_xx + static_zz)


def draw_profile(figure: Figure, result: Mapping[str, Any]) -> None:
    """The cable to scale with its chord; below, its distance from the chord, enlarged."""
    profile = cable_profile(result)
    upper, lower = figure.subplots(2, 1, height_ratios=[1.5, 1.0])
    _to_scale(upper, profile, result)
    _distance(lower, profile, result)


def _to_scale(axes: Axes, profile: CableProfile, result: Mapping[str, Any]) -> None:
    x, z = result["x_m"], result["z_m"]
    axes.set_aspect("equal", adjustable="datalim")
    axes.plot(
        [0.0, x], [0.0, z], color=GREY, linewidth=1.0, linestyle=(0, (5, 3)), label=f"chord {result['chord_m']:.3f} m"
    )
    axes.plot(
        profile.x, profile.z, color=BLUE, linewidth=2.0, label=f"cable, unstrained {result['input']['length_m']:g} m"
    )
    deepest = int(np.argmax(profile.below))
    foot = profile.along[deepest] / result["chord_m"]
    axes.plot(
        [foot * x, profile.x[deepest]],
        [foot * z, profile.z[deepest]],
        color=VERMILLION,
        linewidth=1.4,
        label=_sag(result),
    )
    axes.plot([0.0, x], [0.0, z], "o", color=BLACK, markersize=4.5)
    side = 1.0 if x > 0.0 else -1.0
    axes.annotate("B", (0.0, 0.0), (-9 * side, 5), textcoords="offset points", ha="center")
    axes.annotate("C", (x, z), (9 * side, 5), textcoords="offset points", ha="center")
    axes.margins(0.08, 0.12)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("z, up [m]")
    axes.set_title(f"to scale; chord inclined by {result['inclination_deg']:.1f}°")
    axes.legend(loc="best")


def _distance(axes: Axes, profile: CableProfile, result: Mapping[str, Any]) -> None:
    deepest = int(np.argmax(profile.below))
    place, depth = profile.along[deepest], 1000.0 * result["sag_m"]
    axes.axhline(0.0, color=GREY, linewidth=1.0, linestyle=(0, (5, 3)))
    axes.plot(profile.along, 1000.0 * profile.below, color=BLUE, linewidth=2.0)
    axes.annotate(
        "",
        (place, 0.0),
        (place, depth),
        arrowprops={"arrowstyle": "<->", "color": VERMILLION, "shrinkA": 0, "shrinkB": 0},
    )
    axes.annotate(_sag(result), (place, 0.5 * depth), (6, 0), textcoords="offset points", va="center", color=VERMILLION)
    axes.invert_yaxis()
    axes.set_xlabel("along the chord, from B to C [m]")
    axes.set_ylabel("below the chord [mm]")
    axes.set_title("distance from the chord, enlarged")
    quiet(axes)


def _sag(result: Mapping[str, Any]) -> str:
    return f"sag d = {1000.0 * result['sag_m']:.4g} mm"


def profile_caption(result: Mapping[str, Any]) -> str:
    """What to see in the figure."""
    return (
        f"The cable is held at B and pulled at C with ({result['input']['force_N'][0]:g}, "
        f"{result['input']['force_N'][1]:g}) N. Its sag, the largest distance from the chord, is "
        f"{100.0 * result['validity']['sag_ratio']:.3g} % of the chord; there the tension is τ = "
        f"{result['tau_N']:.4g} N. The cable is {1000.0 * result['elongation_m']:.3g} mm longer than unstrained."
    )


def draw_trace(figure: Figure, result: Mapping[str, Any]) -> None:
    """Dynamic against static stiffness over frequency, with the frequencies of the cable held at both ends."""
    trace, axes = stiffness_trace(result), figure.subplots()
    axes.set_yscale("log")
    axes.plot(trace.hertz, trace.dynamic, color=BLUE, linewidth=1.4, label=f"dynamic, damping ratio {DAMPING_RATIO:g}")
    axes.axhline(trace.static, color=ORANGE, linewidth=1.4, linestyle=(0, (5, 3)), label="static")
    clamped = result["frequencies_hz"]["in_plane"]
    marks = axes.vlines(clamped, 0.0, 0.05, color=GREEN, linewidth=2.0, transform=axes.get_xaxis_transform())
    marks.set_label("in-plane frequency, both ends held")
    axes.set_xlim(0.0, trace.hertz[-1])
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("|k_xx + k_zz| at C [N/m]")
    plain_ticks(axes.yaxis)
    quiet(axes)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=3)


def trace_caption(result: Mapping[str, Any]) -> str:
    """What to see in the figure."""
    trace = stiffness_trace(result)
    ratio = trace.dynamic[0] / trace.static - 1.0
    first = result["frequencies_hz"]["in_plane"][0]
    return (
        "How stiffly the cable resists a harmonic motion of its end C in its own plane. At rest the dynamic "
        f"stiffness meets the static one (here {100.0 * ratio:+.2g} %, the closed form's small-sag error). It "
        f"departs from it well below the first frequency of the cable held at both ends, {first:.3g} Hz, and peaks "
        "at the symmetric ones: there a model of massless cables fails."
    )
