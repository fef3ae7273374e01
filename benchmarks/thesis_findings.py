"""Tables of docs/thesis_measurements.md beside the verdicts: where the error sits, and what numbers would remove it.

Each function returns a table in Markdown. Run them with `python -m benchmarks.thesis_campaigns`.
"""

from dataclasses import fields, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import chi2

from benchmarks.markdown_page import table
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.dynamics.natural_frequencies import static_frequencies
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.observation.rest import at_states, static_residuals
from cdpr_struct.reports.diagnose.result import result_json
from cdpr_struct.reports.diagnose.tables import hypotheses
from cdpr_struct.residuals.commanded_lengths import null_space
from cdpr_struct.residuals.linearised import Local, Point, tolerance_term
from cdpr_struct.residuals.recorded import Recorded, recorded
from cdpr_struct.robot.tolerances import Tolerances
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.thesis import cable_tables, cogiro_vibration
from cdpr_struct.thesis.reproduction import printed_table

EXAMPLES = Path(__file__).parents[1] / "examples"
FACTORS = (0.5, 1.0, 2.0)


def example(name: str) -> Campaign:
    """A campaign of examples/, without .toml."""
    return load_campaign(str(EXAMPLES / f"{name}.toml"))


def where_table_4_4_fails() -> str:
    """Per pose: what the measured and the thesis's simulated forces leave of the balance, and of the null space."""
    rows = []
    for column, label in (("measured_N", "measured"), ("thesis_simulation_N", "thesis's simulation")):
        data = recorded(_with_column(example("table-4-4/campaign"), column))
        local = Local.about(data, Point.entered(data))
        causes = np.concatenate([local.by_noise.static, local.columns(tolerance_term(data)).static], axis=-1)
        off = data.campaign.states.tension - _ours(data)
        for i, name in enumerate(data.campaign.states.names):
            left, spread, null = local.r.static[i], causes[i], 1e3 * _null(data, i).T
            balance, inner = left[:6], null @ left[6:]
            rows.append(
                [name, label, f"{np.sqrt((off[i] ** 2).mean()):.0f}", " ".join(f"{f:+.0f}" for f in balance[:3]),
                 f"{np.linalg.norm(balance[3:]) * data.radius:.0f}", " ".join(f"{n:+.1f}" for n in inner),
                 _chance(balance, spread[:6]), _chance(inner, null @ spread[6:])]
            )  # fmt: skip
    head = ["pose", "forces", "rms from ours [N]", "unbalanced x y z [N]", "moment [N m]", "null space [mm of cable]",
            "p of balance", "p of null space"]  # fmt: skip
    return table(head, rows)


def inclined_imbalance(column: str) -> list[tuple[float, float]]:
    """Sideways force [N] and moment [N m] left at the inclined pose, turned about x, y, z by +23 and -23 degrees."""
    campaign = _with_column(example("table-4-4/campaign"), column)
    states, left = campaign.states, []
    for axis, sign in product(range(3), (1.0, -1.0)):
        angles = states.angles.copy()
        angles[3] = sign * np.radians(23.0) * np.eye(3)[axis]
        data = recorded(replace(campaign, states=replace(states, angles=angles)))
        balance = static_residuals(data.arrays, data.readings, data.known, data.radius)[3, :6]
        left.append((float(np.hypot(*balance[:2])), float(np.linalg.norm(balance[3:]) * data.radius)))
    return left


def internal_force_share() -> str:
    """Per pose and pair of force columns: rms difference, and the share of its square in the null space."""
    campaign = example("table-4-4/campaign")
    data, measured = recorded(campaign), campaign.states.tension
    ours, thesis = _ours(data), _with_column(campaign, "thesis_simulation_N").states.tension
    rows = []
    for i, name in enumerate(campaign.states.names):
        cells = [name]
        for gap in (measured[i] - thesis[i], measured[i] - ours[i], thesis[i] - ours[i]):
            inner = _null(data, i).T @ gap
            cells.append(f"{np.sqrt((gap**2).mean()):.0f} N, {100.0 * (inner @ inner) / (gap @ gap):.0f} %")
        rows.append(cells)
    return table(["pose", "measured - thesis", "measured - ours", "thesis - ours"], rows)


def _with_column(campaign: Campaign, column: str) -> Campaign:
    """Table 4.4 with the printed numbers of another line."""
    printed = np.array([float(row[column]) for row in printed_table("table_4_4")])
    return replace(campaign, states=replace(campaign.states, tension=printed.reshape(campaign.states.tension.shape)))


def _ours(data: Recorded) -> np.ndarray:
    """(S, m) tensions of the simulation's distribution at the measured poses [N]."""
    there, readings = at_states(data.arrays, data.known), data.readings
    bound = data.campaign.lower_bound
    held = inverse(there, readings.position, readings.rotation, data.known.model, lower_bound=bound, allow_unheld=True)
    return held.tensions


def _null(data: Recorded, state: int) -> np.ndarray:
    """(m, m - 6) internal forces at a state."""
    return null_space(data.campaign.robot, data.readings.position[state], data.readings.rotation[state])


def _chance(left: np.ndarray, causes: np.ndarray) -> str:
    """p-value of residuals (n,) under noise and tolerances, a column a standard normal number each (n, k)."""
    z = np.linalg.solve(np.linalg.cholesky(causes @ causes.T), left)
    return f"{chi2.sf(float(z @ z), len(z)):.1g}"


def sensitivity(name: str) -> str:
    """Verdict of a campaign for assumed sigmas and tolerances times 0.5, 1, 2."""
    rows = []
    for sigma in FACTORS:
        for tolerance in FACTORS:
            result = result_json(diagnosed(scaled(example(name), sigma, tolerance)))
            place = result["verdict"]["location"].rpartition("case ")[2] or "-"
            rows.append([f"x{sigma:g}", f"x{tolerance:g}", *verdict_cells(result), place])
    return table(["sigmas", "tolerances", *VERDICT_HEAD, "worst state"], rows)


VERDICT_HEAD = ["p", "status", "cause", "nats", "next", "nats", "left out, ratio"]


def verdict_cells(result: dict[str, Any]) -> list[str]:
    """p-value, status, best causes and the runner-up with their evidence on the data as mended, held-out ratio."""
    said, ratio = result["verdict"], result["gain"]["ratio"]
    tried = hypotheses(result["candidates"])
    fits = [h for h in tried if not h.words] or tried
    first, second = [(h.name, f"{h.gain:.1f}") for h in fits[:2]] + [("-", "-")] * (2 - len(fits[:2]))
    name = " + ".join(said["causes"]) or (f"({first[0]})" if fits else "-")
    best = (name, first[1])
    held = "-" if ratio is None else f"{ratio:.2f}"
    return [f"{result['p_value']:.1g}", said["status"], *best, *second, held]


def scaled(campaign: Campaign, sigma: float, tolerance: float) -> Campaign:
    """The campaign with all sensor sigmas and all tolerances multiplied."""
    states, cable, robot = campaign.states, campaign.cable_frequencies, campaign.robot_frequencies
    named = ("sigma_position", "sigma_rotation", "tension_sigma", "length_sigma")
    return replace(
        campaign,
        tolerances=Tolerances(**{f.name: tolerance * getattr(campaign.tolerances, f.name) for f in fields(Tolerances)}),
        states=replace(states, **{name: sigma * getattr(states, name) for name in named}),
        cable_frequencies=replace(cable, sigma=sigma * cable.sigma),
        robot_frequencies=replace(robot, sigma=sigma * robot.sigma),
    )


def tensions_that_frequencies_mean() -> str:
    """Tension of cable 5 by each printed frequency (a taut string), beside what was read and what is computed."""
    rows = []
    for name, place, measured in (
        ("table_4_5", cogiro_vibration.CENTRE, 307),
        ("table_4_6", cogiro_vibration.EDGE, 383),
    ):
        robot = example("tables-4-5-4-6/campaign").robot
        cables = inverse(robot, place, np.eye(3)).cables
        loaded = inverse(robot.with_load(15.0), place, np.eye(3)).cables
        printed = printed_table(name)
        for column, label in (("experiment_Hz", "experiment"), ("dsm_Hz", "thesis's simulation")):
            first = np.array([float(row[column]) / int(row["mode"]) for row in printed])
            means = robot.linear_density[4] * (2.0 * cables.chord[4] * first) ** 2
            rows.append(
                [name.replace("table_", "").replace("_", "."), label, ", ".join(f"{t:.0f}" for t in means),
                 f"{np.median(means):.0f}", f"{measured}", f"{cables.tension[4]:.0f}", f"{loaded.tension[4]:.0f}"]
            )  # fmt: skip
    head = ["table", "line", "tension by mode 1, 2, ... [N]", "median", "read in Table 4.4", "ours, 118.5 kg",
            "ours, 133.5 kg"]  # fmt: skip
    return table(head, rows)


def platform_modes() -> str:
    """Section 4.3.3, the stated modes taken for five of the platform's six in their order: which EA do they need?"""
    rows = []
    for name in ("campaign", "simulated"):
        stated = example(f"section-4-3-3/{name}").robot_frequencies.hertz
        entered = min(np.sqrt(np.mean((np.delete(_stiff_modes(0.0), i) - stated) ** 2)) for i in range(6))
        cells = [f"{entered:.2f}"]
        for free in (0, 3):
            found = min((_stiffness(stated, free, i) for i in range(6)), key=lambda fit: fit.cost)
            rms = float(np.sqrt(2.0 * found.cost / len(stated)))
            cells.append(f"x {np.exp(found.x[-1]):.2f}, {rms:.2f} Hz")
        rows.append([name, _hertz(stated), _hertz(_stiff_modes(0.0)), *cells])
    head = ["data", "stated [Hz]", "ours [Hz]", "rms as entered [Hz]", "EA alone free", "EA and inertia free"]
    return table(head, rows)


def _stiffness(stated: np.ndarray, free: int, left_out: int) -> Any:
    """Least squares on ln of a factor on EA, after `free` (0 or 3) numbers for the inertia."""

    def misses(x: np.ndarray) -> np.ndarray:
        modes = cogiro_vibration._modes(118.5, x) if free else _stiff_modes(float(x[0]))
        return np.delete(modes, left_out) - stated

    start = np.array([0.2, 0.1, 0.0, 0.4] if free else [0.4])
    return least_squares(misses, start, bounds=(-2.0, 2.0))


def _stiff_modes(log_factor: float) -> np.ndarray:
    """Six modes on massless cables of EA times a factor, inertia as assumed [Hz]."""
    return static_frequencies(cogiro_vibration._stiffened(118.5, float(np.exp(log_factor))))


def _hertz(values: np.ndarray) -> str:
    return " ".join(f"{v:.1f}" for v in values)


def weight_of_tables_2() -> str:
    """Cells of Tables 2.2-2.4 that round to the print, by weight per metre."""
    rows = []
    for weight in (0.6573, 0.6540, 0.6520, 0.6512, 0.6505, 0.6480):
        density, keep = weight / cable_tables.GRAVITY, cable_tables.DENSITY
        cable_tables.DENSITY = density
        try:
            items = [cable_tables.table_2_2(), cable_tables.table_2_3(), cable_tables.table_2_4()]
        finally:
            cable_tables.DENSITY = keep
        cells = [cell for item in items for cell in item.cells]
        far = max(abs(cell.deviation / float(cell.printed)) for cell in cells)
        inside = sum(cell.within_print for cell in cells)
        rows.append([f"{weight:.4f}", f"{inside} of {len(cells)}", f"{100 * far:.2f} %"])
    return table(["weight [N/m]", "cells that round to the print", "largest deviation"], rows)
