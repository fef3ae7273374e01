"""A force distribution along a trajectory in words."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.reports.distribution_result import limit_stretches, missed_json
from cdpr_struct.reports.text import paragraphs, plain_table

BOUND_NAMES = {
    "fixed": "fixed bound (5.16)",
    "pose-dependent": "pose-dependent bound (5.15)",
    "frequency": "frequency bound",
}


def distribution_text(found: Sequence[TrajectoryDistribution]) -> str:
    """Tables and sentences for a terminal; the first entry is the one that was asked for."""
    first = found[0]
    path = first.trajectory
    title = (
        f"{first.robot.name}: {len(path)} instants over {path.time[-1] - path.time[0]:.4g} s, speed up to "
        f"{path.speed.max():.3g} m/s, acceleration up to {path.acceleration_size.max():.3g} m/s^2, {first.model} cables"
    )
    columns = ["largest force [N]", *(f"cable {i + 1}" for i in range(len(first.max_force))), "mean"]
    rows = [[BOUND_NAMES[f.rule], *(f"{v:.0f}" for v in f.max_force), f"{f.max_force.mean():.0f}"] for f in found]
    return paragraphs(plain_table(title, columns, rows), *(_sentences(f) for f in found), *_savings(found))


def _sentences(found: TrajectoryDistribution) -> str:
    return " ".join(sentences(found))


def sentences(found: TrajectoryDistribution) -> list[str]:
    """What one lower bound led to."""
    d = found.distribution
    setters = " or ".join(f"cable {i} at {t:.2f} s" for i, t in found.bound_is_set_by)
    low, high = d.lower.min(), d.lower.max()
    size = f"{high:.1f} N" if high - low < 1e-6 * high else f"{low:.1f} to {high:.1f} N"
    lines = [
        f"{BOUND_NAMES[found.rule].capitalize()}: {size}, largest demand by {setters}.",
        f"Energy {found.work.total:.4g} J (work of the cable forces, both directions).",
        frequency_sentence(found),
    ]
    if found.raised.any():
        lines.append(
            f"The robot's force_min is larger than this bound and stands instead of it at "
            f"{100.0 * found.raised_share:.3g} % of all cables and instants."
        )
    for stretch in limit_stretches(found):
        lines.append(
            f"Cable {stretch['cable']} is at its force limit {stretch['limit_N']:.4g} N at {stretch['instants']} "
            f"instants from {stretch['first_s']:.4g} s to {stretch['last_s']:.4g} s."
        )
    singular = int((d.rank < 6).sum())
    if singular:
        lines.append(f"The wrench matrix is singular at {singular} instants: there the platform is free to move.")
    lines.append(f"Optimality is certified: largest KKT residual {d.kkt_residual.max():.1g}.")
    return lines


def frequency_sentence(found: TrajectoryDistribution) -> str:
    """Whether the bound keeps its promise."""
    wanted, missed = found.b / (2.0 * np.pi), missed_json(found)
    lowest = found.frequency.min() / (2.0 * np.pi)
    worst = missed["worst"]
    if not missed["instants"]:
        return f"The lowest cable frequency is {lowest:.4g} Hz, at or above the wanted {wanted:.4g} Hz everywhere."
    return (
        f"The lowest cable frequency falls to {lowest:.4g} Hz, {100.0 * (1.0 - worst['frequency_over_wanted']):.1f} % "
        f"below the wanted {wanted:.4g} Hz (cable {worst['cable']} at {worst['time_s']:.2f} s, "
        f"{worst['length_m']:.2f} m long); some cable misses it at {missed['instants']} of "
        f"{len(found.trajectory)} instants."
    )


def _savings(found: Sequence[TrajectoryDistribution]) -> list[str]:
    fixed = [f for f in found if f.rule == "fixed"]
    others = [f for f in found if f.rule != "fixed"]
    return [saving_sentence(other, fixed[0]) for other in others] if fixed else []


def saving_sentence(other: TrajectoryDistribution, fixed: TrajectoryDistribution) -> str:
    """What a bound saves against the fixed one."""
    saved = 100.0 * (1.0 - other.work.total / fixed.work.total)
    smaller = 100.0 * (1.0 - other.max_force / fixed.max_force)
    return (
        f"Against the fixed bound the {BOUND_NAMES[other.rule]} saves {saved:.1f} % of the energy and changes the "
        f"cables' largest forces by {-smaller.max():+.0f} to {-smaller.min():+.0f} %."
    )
