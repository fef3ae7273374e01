"""result.json of a force distribution along a trajectory, and its columns as a table."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.reports.trust import Check, Trust
from cdpr_struct.reports.trust_over_poses import largest_strain
from cdpr_struct.statics.slack_cables import DEEP, hangs_slack, sag_over_chord
from cdpr_struct.statics.strained_cables import strains
from cdpr_struct.statics.tension_distribution import TensionDistribution

_OPTIMAL = 1e-6  # KKT residual from which on forces do not count as optimal; the solver ends below 1e-9
ENERGY = "sum over the cables of the integral of |tension at the platform| |d unstrained length|"


def distribution_json(found: TrajectoryDistribution, beside: Sequence[TrajectoryDistribution] = ()) -> dict[str, Any]:
    """The result under the keys that scripts rely on; SI units, cables numbered from 1."""
    path = found.trajectory
    return {
        "trust": distribution_trust(found),
        "robot": found.robot.name,
        "platform_mass_kg": found.robot.platform.mass,
        "trajectory": {
            "instants": len(path),
            "duration_s": path.time[-1] - path.time[0],
            "max_speed_m_s": path.speed.max(),
            "max_acceleration_m_s2": path.acceleration_size.max(),
        },
        "b_rad_s": found.b,
        "model": found.model,
        "cost_function": found.cost.name,
        "energy_definition": ENERGY,
        **_rule_json(found),
        "beside": [_rule_json(other) for other in beside],
    }


def distribution_trust(found: TrajectoryDistribution) -> Trust:
    """Whether forces along a trajectory can be trusted: optimality and balance, slack and sag, strain."""
    shared, cables = found.distribution, found.distribution.cables
    kkt = float(shared.kkt_residual.max())
    slack = int(hangs_slack(cables).any(axis=-1).sum())
    sag = float(np.nan_to_num(sag_over_chord(cables)).max())
    least = f"the forces miss the least cost or the balance of the platform by {kkt:.2g}: the search was cut short."
    loose = f"Cables hang slack at {slack} instants (they pull with less than their own weight): raise the lower bound."
    deep = f"Deep sag: a cable sags by up to {sag:.2g} of its chord."
    return Trust(
        (
            Check.of("KKT residual", kkt, _OPTIMAL, least if kkt > _OPTIMAL else None),
            Check.of("instants with slack cables", slack, 0.0, loose if slack else None),
            Check.of("largest sag over chord", sag, DEEP, deep if sag >= DEEP else None),
            largest_strain(float(strains(cables).max()), "A cable is stretched, at most"),
        )
    )


def _rule_json(found: TrajectoryDistribution) -> dict[str, Any]:
    d, work = found.distribution, found.work
    frequency = found.frequency / (2.0 * np.pi)
    return {
        "bound": found.rule,
        "max_force_N": found.max_force,
        "energy_J": work.total,
        "lower_bound_N": {"min": d.lower.min(), "max": d.lower.max()},
        "lower_bound_set_by": [{"cable": i, "time_s": t} for i, t in found.bound_is_set_by],
        "raised_by_force_min": {"cable_instants": int(found.raised.sum()), "share": found.raised_share},
        "min_cable_frequency_hz": frequency.min(),
        "min_cable_frequency_by_cable_hz": frequency.min(axis=0),
        "wanted_frequency_hz": found.b / (2.0 * np.pi),
        "frequency_missed": missed_json(found),
        "at_lower_bound_share": d.at_lower.mean(axis=0),
        "at_force_limit": limit_stretches(found),
        "motor": {
            "max_force_N": d.cables.tension_at_frame.max(axis=0),
            "max_power_W": work.winch_power.max(axis=0),
            "max_braking_power_W": -work.winch_power.min(axis=0),
            "driving_energy_J": work.driving[-1],
            "braking_energy_J": work.braking[-1],
        },
        "cost": {"mean": d.cost.mean(), "max": d.cost.max()},
        "certificate": _certificate(d),
    }


def _certificate(d: TensionDistribution) -> dict[str, Any]:
    return {
        "max_kkt_residual": d.kkt_residual.max(),
        "max_unbalanced_N": np.abs(d.residual_wrench[:, :3]).max(),
        "max_unbalanced_Nm": np.abs(d.residual_wrench[:, 3:]).max(),
        "singular_instants": int((d.rank < 6).sum()),
    }


def missed_json(found: TrajectoryDistribution) -> dict[str, Any]:
    """Where and by how much cables stay below the wanted frequency."""
    missed, time = found.missed, found.trajectory.time
    pose, cable = np.unravel_index(int(found.frequency.argmin()), found.frequency.shape)
    any_ = missed.any(axis=1)
    return {
        "instants": int(any_.sum()),
        "share_of_cable_instants": missed.mean(),
        "from_s": time[any_][0] if any_.any() else None,
        "to_s": time[any_][-1] if any_.any() else None,
        "cables": (np.flatnonzero(missed.any(axis=0)) + 1).tolist(),
        "worst": {
            "cable": int(cable) + 1,
            "time_s": time[pose],
            "frequency_over_wanted": found.frequency[pose, cable] / found.b,
            "length_m": found.distribution.lengths[pose, cable],
        },
    }


def limit_stretches(found: TrajectoryDistribution) -> list[dict[str, Any]]:
    """When each cable lies at its force limit: one entry per cable that does."""
    at, time = found.distribution.at_upper, found.trajectory.time
    return [
        {
            "cable": int(i) + 1,
            "limit_N": found.distribution.upper[at[:, i], i].min(),
            "instants": int(at[:, i].sum()),
            "first_s": time[at[:, i]][0],
            "last_s": time[at[:, i]][-1],
        }
        for i in np.flatnonzero(at.any(axis=0))
    ]


def force_columns(found: TrajectoryDistribution) -> dict[str, np.ndarray]:
    """Columns of the CSV file of one lower bound, one row an instant."""
    d, path = found.distribution, found.trajectory
    columns: dict[str, np.ndarray] = {"time_s": path.time}
    columns |= dict(zip(("x_m", "y_m", "z_m"), path.position.T, strict=True))
    for name, values in (
        ("force_{}_N", d.tensions), ("lower_bound_{}_N", d.lower), ("length_{}_m", d.lengths),
        ("frequency_{}_hz", found.frequency / (2.0 * np.pi)), ("winch_power_{}_W", found.work.winch_power),
    ):  # fmt: skip
        columns |= {name.format(i + 1): values[:, i] for i in range(values.shape[1])}
    columns |= {"energy_J": found.work.spent, "cost": d.cost, "kkt_residual": d.kkt_residual}
    return columns
